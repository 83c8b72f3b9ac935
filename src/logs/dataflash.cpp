// ArduPilot's DataFlash log: where its messages begin and end. What they mean is in dataflash_content.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "dataflash_content.hpp"
#include "dataflash_format.hpp"
#include "dataflash_notes.hpp"
#include "log_magic.hpp"
#include "plumb/io/mapped_file.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::size_t kChunk = 1U << 22U;
constexpr std::size_t kLookAhead = 255 + 2;  // the longest message, and the head of the next one

tl::unexpected<io::FileError> refuse(const std::string& path, std::string what, std::string remedy) {
  return tl::unexpected<io::FileError>(io::FileError{path, 0, "", std::move(what), std::move(remedy)});
}

constexpr const char* kGiveBin = "give the .bin file that ArduPilot writes";

class DataflashReader {
 public:
  DataflashReader(io::MappedFile& file, LogSink& sink) : file_(file), notes_(sink), content_(sink, notes_) {}

  /// False where the file has no FMT that could be read.
  bool read();
  LogExtent extent() const noexcept { return {size_, sound_end_, content_.records(), 0.0}; }

 private:
  enum class Verdict : std::uint8_t { sound, none, torn };

  /// Of `count` bytes from the offset `begin` on; returns how many it is done with.
  std::size_t read_chunk(const unsigned char* bytes, std::size_t count, std::uint64_t begin, bool is_last);
  Verdict judge(const unsigned char* message, std::size_t rest) const noexcept;
  void open_gap(const unsigned char* bytes, std::size_t rest, std::uint64_t offset);
  void close_gap(std::uint64_t end);
  void note_torn(const unsigned char* message, std::size_t rest, std::uint64_t offset);

  io::MappedFile& file_;
  DataflashNotes notes_;
  DataflashContent content_;
  std::uint64_t size_ = 0;
  std::uint64_t sound_end_ = 0;
  bool in_gap_ = false;
  bool torn_ = false;
  std::uint64_t gap_ = 0;
  int gap_type_ = -1;  ///< of the message without FMT that the gap begins with
};

/// A message counts when another one follows it, or the end of the file: one that was cut short in the middle of a log
/// has swallowed the beginning of what came behind it, and its numbers would be those of other columns.
DataflashReader::Verdict DataflashReader::judge(const unsigned char* message, std::size_t rest) const noexcept {
  if (message[0] != kHead1) return Verdict::none;
  if (rest == 1) return Verdict::torn;
  if (message[1] != kHead2) return Verdict::none;
  if (rest < kHeadBytes) return Verdict::torn;
  const std::size_t length = content_.formats().of(message[2]).length;
  if (length == 0) return Verdict::none;
  if (length > rest) return Verdict::torn;
  if (rest > length && message[length] != kHead1) return Verdict::none;
  if (rest > length + 1 && message[length + 1] != kHead2) return Verdict::none;
  return Verdict::sound;
}

bool DataflashReader::read() {
  size_ = file_.size();
  std::uint64_t offset = 0;
  while (offset < size_ && !torn_) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kChunk, size_ - offset));
    const unsigned char* bytes = file_.at(offset, count);
    if (bytes == nullptr) {
      if (in_gap_ && content_.has_format()) close_gap(offset);
      in_gap_ = false;
      torn_ = true;
      if (content_.has_format()) notes_.say(offset, "the file cannot be read from here on");
    }
    offset += read_chunk(bytes, count, offset, offset + count == size_);
  }
  if (!content_.has_format()) return false;
  if (in_gap_) close_gap(size_);
  if (content_.records() == 0)
    notes_.say(0, "the log has no message of an accelerometer (IMU, ACC) that could be read");
  content_.finish();
  return true;
}

std::size_t DataflashReader::read_chunk(const unsigned char* bytes, std::size_t count, std::uint64_t begin,
                                        bool is_last) {
  std::size_t at = 0;
  while (is_last ? at < count : count - at >= kLookAhead) {
    const unsigned char* message = bytes + at;
    const std::size_t rest = count - at;
    const Verdict verdict = judge(message, rest);
    if (verdict == Verdict::sound) {
      if (in_gap_) close_gap(begin + at);
      const std::size_t length = content_.formats().of(message[2]).length;
      content_.take(message, begin + at);
      at += length;
      sound_end_ = begin + at;
      continue;
    }
    if (verdict == Verdict::torn) {
      // What is left may look like messages of its own, in the numbers of this one: it is not looked into.
      torn_ = true;
      if (content_.has_format()) note_torn(message, rest, begin + at);
      return at;
    }
    if (!in_gap_) open_gap(message, rest, begin + at);
    const void* next = std::memchr(message + 1, kHead1, rest - 1);
    at = next == nullptr ? count : static_cast<std::size_t>(static_cast<const unsigned char*>(next) - bytes);
  }
  return at;
}

void DataflashReader::open_gap(const unsigned char* bytes, std::size_t rest, std::uint64_t offset) {
  in_gap_ = true;
  gap_ = offset;
  const bool has_head = rest >= kHeadBytes && bytes[0] == kHead1 && bytes[1] == kHead2;
  gap_type_ = has_head && content_.formats().of(bytes[2]).length == 0 ? bytes[2] : -1;
}

void DataflashReader::close_gap(std::uint64_t end) {
  in_gap_ = false;
  const bool is_unknown = gap_type_ >= 0;
  if (!notes_.wanted(is_unknown ? DataflashTrouble::unknown_type : DataflashTrouble::passed_over, gap_)) return;
  const std::string bytes = std::to_string(end - gap_) + " bytes were passed over";
  notes_.say(gap_, is_unknown ? "no FMT describes messages of type " + std::to_string(gap_type_) + ": " + bytes
                              : "no whole message begins here: " + bytes);
}

void DataflashReader::note_torn(const unsigned char* message, std::size_t rest, std::uint64_t offset) {
  if (in_gap_) close_gap(offset);
  if (rest < kHeadBytes) {
    notes_.say(offset, "the log ends within the head of a message");
    return;
  }
  const Layout& layout = content_.formats().of(message[2]);
  notes_.say(offset, "the log ends within a message" + (layout.name[0] == 0 ? "" : " " + layout.name_text()) +
                         ": it has " + std::to_string(rest) + " of its " + std::to_string(layout.length) + " bytes");
}

/// Why a file cannot be opened, or is none that can be read; empty where nothing speaks against it.
io::FileExpected<void> looked_at(const std::string& path, io::MappedFile& file) {
  if (auto opened = open_log(path, kGiveBin, file); !opened) return opened;
  const std::string_view begin = first_bytes(file, kMagicBytes);
  constexpr std::string_view kAsText = "FMT,";
  if (begin.substr(0, kAsText.size()) == kAsText)
    return refuse(path, "is a DataFlash log turned into text, no DataFlash log (.bin)", "read it as CSV");
  const KnownFile* known = known_file(begin);
  if (known == nullptr || known->kind == FileKind::dataflash) return {};
  return refuse(path, std::string(known->what) + ", no DataFlash log (.bin)", known->remedy);
}

}  // namespace

io::FileExpected<LogExtent> read_dataflash(const std::string& path, LogSink& sink) {
  io::MappedFile file;
  const auto sound = looked_at(path, file);
  if (!sound) return tl::unexpected<io::FileError>(sound.error());
  const auto reader = std::make_unique<DataflashReader>(file, sink);  // large for a stack
  if (reader->read()) return reader->extent();
  return refuse(path, "is no DataFlash log: from offset 0 on no FMT message (A3 95 80) could be read", kGiveBin);
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
