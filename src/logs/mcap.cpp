// MCAP: where its records begin and end, and what of them is handed on. The messages are read in ros_topics.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "log_magic.hpp"
#include "mcap_content.hpp"
#include "mcap_format.hpp"
#include "plumb/io/mapped_file.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ros_notes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr const char* kGiveMcap = "give an MCAP file (.mcap)";
/// Schemas and channels are texts of some kilobytes.
constexpr std::uint64_t kLargestRecord = 16U << 20U;
/// Behind a damaged record, this many in a row are taken for records.
constexpr int kMcapChain = 3;
constexpr std::uint64_t kMcapScanned = 1U << 19U;  ///< bytes at a time
/// Places that are looked at more closely in one log: bytes that are made to look like records cost time, not more.
constexpr std::uint64_t kMostTries = 1U << 20U;

class McapReader {
 public:
  McapReader(std::string path, LogSink& sink) : path_(std::move(path)), notes_(sink), content_(sink, notes_) {}

  io::FileExpected<LogExtent> read();

 private:
  struct Head {
    unsigned char op = 0;
    std::uint64_t size = 0;  ///< of what follows it
  };

  tl::unexpected<io::FileError> error(std::string what, std::string remedy) const {
    return tl::unexpected<io::FileError>(io::FileError{path_, 0, "", std::move(what), std::move(remedy)});
  }
  bool head_at(std::uint64_t offset, Head& out);
  /// The head of a chunk and its packed bytes as far as they are there; null where it contradicts itself.
  const unsigned char* chunk_at(std::uint64_t offset, std::uint64_t size, McapChunk& out, std::uint64_t& there);
  void read_records();
  /// Whether a record may be what its head says it is: an end that is none would cost all that follows.
  bool is_sound(const Head& head) const noexcept;
  /// Where the next one begins.
  std::uint64_t take(const Head& head);
  void take_small(const Head& head);
  std::uint64_t take_chunk(const Head& head);
  void count(const Head& head);
  void mend(const Head& head);
  bool is_chain(std::uint64_t offset);
  std::uint64_t next_record(std::uint64_t from);
  void read_end();

  std::string path_;
  RosNotes notes_;
  McapContent content_;
  io::MappedFile file_;
  std::uint64_t size_ = 0;
  std::uint64_t at_ = 0;
  std::uint64_t read_ = 0;
  std::uint64_t tries_ = 0;
  bool in_summary_ = false;
  bool has_footer_ = false;
  bool is_cut_ = false;  ///< and that is said
};

bool McapReader::head_at(std::uint64_t offset, Head& out) {
  const unsigned char* bytes = file_.at(offset, kMcapHead);
  if (bytes == nullptr) return false;
  out.op = bytes[0];
  out.size = mcap_whole(bytes + 1, 8);
  return true;
}

const unsigned char* McapReader::chunk_at(std::uint64_t offset, std::uint64_t size, McapChunk& out,
                                          std::uint64_t& there) {
  constexpr std::uint64_t kLongestHead = 256;  // the name of the compression is the only text in it
  const std::uint64_t begin = offset + kMcapHead;
  const std::uint64_t rest = std::min(size, size_ - begin);
  const unsigned char* bytes = file_.at(begin, static_cast<std::size_t>(std::min(rest, kLongestHead)));
  if (bytes == nullptr) return nullptr;
  const auto chunk = mcap_chunk(bytes, static_cast<std::size_t>(std::min(rest, kLongestHead)));
  if (!chunk || chunk->packed > size - chunk->head) return nullptr;
  // The text lies in a window that moves on: one that stays stands for it.
  out = *chunk;
  out.compression = McapContent::compression_of(chunk->compression);
  there = std::min(chunk->packed, rest - chunk->head);
  if (there > McapContent::kLargestChunk) return bytes;  // it will not be looked at
  return file_.at(begin + chunk->head, static_cast<std::size_t>(there));
}

std::uint64_t McapReader::take_chunk(const Head& head) {
  const std::uint64_t end = at_ + kMcapHead + head.size;
  McapChunk chunk;
  std::uint64_t there = 0;
  const unsigned char* packed = chunk_at(at_, head.size, chunk, there);
  if (packed == nullptr) {
    if (notes_.wanted(RosTrouble::chunk, at_))
      notes_.say(at_, "the head of a chunk contradicts its size of " + std::to_string(head.size) +
                          " bytes, the chunk is left out");
    return end;
  }
  content_.chunk(chunk, packed, there, at_);
  const std::uint64_t own_end = at_ + kMcapHead + chunk.head + chunk.packed;
  if (own_end == end || !is_chain(own_end)) return end;
  if (notes_.wanted(RosTrouble::chunk, at_))
    notes_.say(at_, "a chunk of " + std::to_string(head.size) + " bytes ends at byte " + std::to_string(own_end) +
                        " by its content, the log is read on from there");
  return own_end;
}

/// Schemas, channels, and messages outside of chunks.
void McapReader::take_small(const Head& head) {
  const std::uint64_t begin = at_ + kMcapHead;
  if (head.size <= kLargestRecord) {
    const auto size = static_cast<std::size_t>(head.size);
    const unsigned char* bytes = file_.at(begin, size);
    if (bytes != nullptr) content_.record(head.op, bytes, size, at_);
    return;
  }
  const unsigned char* bytes = file_.at(begin, 2);
  const bool is_message = head.op == static_cast<unsigned char>(McapOp::message);
  if (bytes != nullptr && is_message && !content_.is_read(static_cast<std::uint16_t>(mcap_whole(bytes, 2)))) return;
  if (notes_.wanted(RosTrouble::record, at_))
    notes_.say(at_, "a record has " + std::to_string(head.size) + " bytes, more than 16 MiB, it is left out");
}

bool McapReader::is_sound(const Head& head) const noexcept {
  constexpr std::uint64_t kFooter = 20;
  constexpr std::uint64_t kLongestDataEnd = 64;  // 4, and fields of a later version
  if (!is_mcap_op(head.op) || head.size > size_ - at_ - kMcapHead) return false;
  if (head.op == static_cast<unsigned char>(McapOp::footer)) return head.size == kFooter;
  return head.op != static_cast<unsigned char>(McapOp::data_end) || head.size <= kLongestDataEnd;
}

/// The statistics say how many messages there are: what was lost without a trace is found out.
void McapReader::count(const Head& head) {
  const unsigned char* bytes = head.size < 8 ? nullptr : file_.at(at_ + kMcapHead, 8);
  if (bytes == nullptr) return;
  const std::uint64_t stated = mcap_whole(bytes, 8);
  if (stated != content_.messages() && notes_.wanted(RosTrouble::record, at_))
    notes_.say(at_, "the log says that it has " + std::to_string(stated) + " messages, " +
                        std::to_string(content_.messages()) + " were found");
}

std::uint64_t McapReader::take(const Head& head) {
  switch (static_cast<McapOp>(head.op)) {
    case McapOp::schema:
    case McapOp::channel:
    case McapOp::message:
      if (!in_summary_) take_small(head);
      break;
    case McapOp::chunk: return take_chunk(head);
    case McapOp::data_end: in_summary_ = true; break;
    case McapOp::statistics: count(head); break;
    case McapOp::footer: has_footer_ = true; break;
    case McapOp::header: break;
  }
  return at_ + kMcapHead + head.size;
}

/// Whether records follow one another from here on, or one ends where the log does.
bool McapReader::is_chain(std::uint64_t offset) {
  for (int k = 0; k < kMcapChain; ++k) {
    if (offset == size_ || (offset + kMcapMagic.size() == size_ && k > 0)) return k > 0;
    Head head;
    if (!head_at(offset, head) || head.op == 0 || head.op > static_cast<unsigned char>(McapOp::data_end)) return false;
    if (head.size > size_ - offset - kMcapHead) return false;
    McapChunk chunk;
    std::uint64_t there = 0;
    if (head.op == static_cast<unsigned char>(McapOp::chunk)) {
      return chunk_at(offset, head.size, chunk, there) != nullptr;  // two sizes that agree
    }
    offset += kMcapHead + head.size;
  }
  return true;
}

std::uint64_t McapReader::next_record(std::uint64_t from) {
  while (from + kMcapHead <= size_) {
    const std::uint64_t count = std::min(size_ - from, kMcapScanned + kMcapHead);
    const std::uint64_t places = count - kMcapHead + 1;
    const unsigned char* bytes = file_.at(from, static_cast<std::size_t>(count));
    for (std::uint64_t k = 0; k < places && bytes != nullptr; ++k) {
      if (bytes[k] == 0 || bytes[k] > static_cast<unsigned char>(McapOp::data_end)) continue;
      if (mcap_whole(bytes + k + 1, 8) > size_ - from - k - kMcapHead) continue;
      if (++tries_ > kMostTries) return size_;
      if (is_chain(from + k)) return from + k;
      bytes = file_.at(from, static_cast<std::size_t>(count));
    }
    if (bytes == nullptr) return size_;
    from += places;
  }
  return size_;
}

void McapReader::mend(const Head& head) {
  const std::uint64_t rest = size_ - at_ - kMcapHead;
  const std::uint64_t place = at_;
  McapChunk chunk;
  std::uint64_t there = 0;
  if (head.op == static_cast<unsigned char>(McapOp::chunk) && head.size > rest) {
    const unsigned char* packed = chunk_at(at_, head.size, chunk, there);
    if (packed != nullptr && chunk.head + chunk.packed == head.size) {
      at_ = size_;
      is_cut_ = true;
      notes_.say(place, "the log ends within a chunk: " + std::to_string(there) + " of its " +
                            std::to_string(chunk.packed) + " bytes are there, what they hold is read unchecked");
      return content_.chunk(chunk, packed, there, place);
    }
  }
  at_ = next_record(at_ + 1);
  is_cut_ = at_ == size_;
  if (!notes_.wanted(RosTrouble::record, place)) return;
  const std::string what = is_mcap_op(head.op) && head.size > rest
                               ? "a record of " + std::to_string(head.size) + " bytes has " + std::to_string(rest) +
                                     " before the end of the file"
                               : "no record begins here";
  notes_.say(place, what + (at_ < size_ ? ": what comes before byte " + std::to_string(at_) + " is left out"
                                        : ": it and what follows are left out"));
}

void McapReader::read_records() {
  while (at_ < size_ && !has_footer_) {
    const std::uint64_t rest = size_ - at_;
    Head head;
    if (rest < kMcapHead || !head_at(at_, head)) {
      is_cut_ = true;
      notes_.say(at_, rest < kMcapHead ? "the log ends within the head of a record"
                                       : "the file became shorter while it was read, the rest is left out");
      return;
    }
    if (!is_sound(head)) {
      mend(head);
      continue;
    }
    at_ = read_ = take(head);
  }
}

void McapReader::read_end() {
  if (!has_footer_) {
    if (!is_cut_) notes_.say(size_, "the log has no footer: its recording was broken off");
    return;
  }
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(size_ - at_, kMcapMagic.size()));
  const unsigned char* bytes = file_.at(at_, count);
  const bool is_sound = bytes != nullptr && count == kMcapMagic.size() &&
                        std::equal(bytes, bytes + count, kMcapMagic.begin(),
                                   [](unsigned char a, char b) { return a == static_cast<unsigned char>(b); });
  if (is_sound) read_ = at_ + count;
  if (!is_sound)
    notes_.say(at_, "the log ends without the bytes that end an MCAP file");
  else if (read_ < size_)
    notes_.say(read_, std::to_string(size_ - read_) + " bytes behind the end of the log are left out");
}

io::FileExpected<LogExtent> McapReader::read() {
  if (const auto opened = open_log(path_, kGiveMcap, file_); !opened) return tl::make_unexpected(opened.error());
  const std::string_view begin = first_bytes(file_, kMagicBytes);
  if (begin.substr(0, kMcapMagic.size()) != kMcapMagic) {
    if (kMcapMagic.substr(0, begin.size()) == begin)
      return error("ends at byte " + std::to_string(begin.size()) + ", inside the 8 bytes that MCAP begins with",
                   "copy the log again");
    const KnownFile* known = known_file(begin);
    if (known != nullptr) return error(std::string(known->what) + ", no MCAP file", known->remedy);
    return error("is no MCAP file: it does not begin with 89 \"MCAP0\" 0D 0A at byte 0", kGiveMcap);
  }
  size_ = file_.size();
  at_ = read_ = kMcapMagic.size();
  read_records();
  read_end();
  content_.finish();
  notes_.sum_up();
  LogExtent out;
  out.bytes = size_;
  out.read_bytes = read_;
  out.records = content_.records();
  return out;
}

}  // namespace

io::FileExpected<LogExtent> read_mcap(const std::string& path, LogSink& sink) { return McapReader(path, sink).read(); }

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
