#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "log_magic.hpp"
#include "plumb/io/mapped_file.hpp"
#include "plumb/io/ulog_format.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ulog_messages.hpp"
#include "ulog_notes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

/// Where it is not known where the next message begins, this many in a row are taken for messages.
constexpr int kUlogChain = 4;
constexpr std::uint64_t kUlogScanned = 1U << 19U;  ///< bytes at a time
constexpr std::uint64_t kUlogLongestChain = kUlogChain * (io::kUlogMessageHeader + 65535U) + kUlogNeeded;

/// Of types whose sizes are known: one that runs past the end was cut short, its size is not what is damaged.
bool has_known_size(unsigned char type) noexcept { return type == 'D' || type == 'S' || type == 'O' || type == 'R'; }

class UlogReader {
 public:
  UlogReader(std::string path, LogSink& sink) : path_(std::move(path)), notes_(sink), messages_(sink, notes_) {}

  io::FileExpected<LogExtent> read();

 private:
  using Judgement = UlogMessages::Judgement;

  io::FileError error(std::string what, std::string remedy) const {
    return {path_, 0, "", std::move(what), std::move(remedy), io::ExitCode::invalid_input};
  }
  io::FileExpected<void> open();
  io::FileExpected<void> read_header();
  io::FileExpected<void> read_flags();
  void read_appended(const unsigned char* offsets);
  void read_until(std::uint64_t end);
  void mend(const UlogMessage& message, Judgement judgement, std::uint64_t end);
  std::uint64_t next_message(std::uint64_t from, std::uint64_t end);
  enum class Trust : std::uint8_t { data_of_known_format, any_data };
  /// Whether `wanted` messages follow one another from `bytes` on, or two end where the log does; `rest` bytes are
  /// left, of which `count` are there.
  bool chain(const unsigned char* bytes, std::uint64_t count, std::uint64_t rest, int wanted, Trust trust) const;
  bool follows(std::uint64_t next, std::uint64_t end);

  std::string path_;
  UlogNotes notes_;
  UlogMessages messages_;
  io::MappedFile file_;
  std::uint64_t size_ = 0;
  std::uint64_t at_ = 0;
  std::uint64_t read_ = 0;
  std::vector<std::uint64_t> appended_;
};

io::FileExpected<void> UlogReader::open() {
  if (auto opened = open_log(path_, "name a ULog file (.ulg)", file_); !opened) return opened;
  size_ = file_.size();
  return {};
}

io::FileExpected<void> UlogReader::read_header() {
  const std::size_t there = static_cast<std::size_t>(std::min<std::uint64_t>(size_, io::kUlogMagic.size()));
  const unsigned char* bytes = file_.at(0, there);
  if (bytes == nullptr) return tl::make_unexpected(error("cannot be read at byte 0", "copy the log again"));
  if (!std::equal(bytes, bytes + there, io::kUlogMagic.begin())) {
    const KnownFile* known = known_file(first_bytes(file_, kMagicBytes));
    if (known != nullptr) return tl::make_unexpected(error(std::string(known->what) + ", no ULog", known->remedy));
    return tl::make_unexpected(
        error("is no ULog: it does not begin with \"ULog\" 01 12 35 at byte 0", "give a log of PX4 (.ulg)"));
  }
  bytes = file_.at(0, io::kUlogHeader);
  if (bytes == nullptr) {
    return tl::make_unexpected(error("ends at byte " + std::to_string(size_) + ", inside its header of 16 bytes",
                                     "copy the log from the flight controller again"));
  }
  if (bytes[7] > io::kNewestUlog && notes_.wanted(UlogTrouble::header, 7)) {
    notes_.say(7, "version " + std::to_string(static_cast<int>(bytes[7])) +
                      " of the format is newer than 1, the log is read as that one");
  }
  messages_.set_zero(io::ulog_unsigned(bytes + 8, 8));
  at_ = read_ = io::kUlogHeader;
  return {};
}

// The one message with a place of its own: behind the header.
io::FileExpected<void> UlogReader::read_flags() {
  const unsigned char* bytes = file_.at(at_, io::kUlogMessageHeader + io::kUlogFlagBytes);
  if (bytes == nullptr || bytes[2] != 'B') return {};  // the first version has none
  const std::uint64_t size = io::ulog_unsigned(bytes, 2);
  if (size < io::kUlogFlagBytes || size > size_ - at_ - io::kUlogMessageHeader) return {};  // read_until says so
  const unsigned char* incompatible = bytes + io::kUlogMessageHeader + 8;
  for (std::uint64_t k = 0; k < 8; ++k) {
    const unsigned unknown = k == 0 ? incompatible[k] & ~1U : incompatible[k];
    if (unknown == 0) continue;
    return tl::make_unexpected(
        error("says at byte " + std::to_string(at_ + io::kUlogMessageHeader + 8 + k) +
                  " that it uses a part of the format that is not known here (incompatible flag)",
              "convert the log with a tool of the PX4 version that wrote it"));
  }
  const bool has_appended = (incompatible[0] & 1U) != 0;
  at_ += io::kUlogMessageHeader + size;
  read_ = at_;
  if (has_appended) read_appended(bytes + io::kUlogMessageHeader + 16);
  return {};
}

void UlogReader::read_appended(const unsigned char* offsets) {
  std::uint64_t last = at_;
  for (std::uint64_t k = 0; k < 3; ++k) {
    const std::uint64_t offset = io::ulog_unsigned(offsets + 8 * k, 8);
    if (offset == 0) continue;
    if (offset >= last && offset < size_) {
      appended_.push_back(offset);
      last = offset;
      continue;
    }
    const std::uint64_t place = io::kUlogHeader + io::kUlogMessageHeader + 16 + 8 * k;
    if (!notes_.wanted(UlogTrouble::appended, place)) continue;
    notes_.say(place, "appended data at byte " + std::to_string(offset) +
                          (offset >= size_ ? ", behind the end of the file" : ", before what they are appended to") +
                          "; this is left out and the log read on without a break");
  }
}

bool UlogReader::chain(const unsigned char* bytes, std::uint64_t count, std::uint64_t rest, int wanted,
                       Trust trust) const {
  std::uint64_t at = 0;
  for (int k = 0; k < wanted; ++k) {
    if (at == rest) return k >= 2;
    if (at + io::kUlogMessageHeader > count) return false;
    UlogMessage message;
    message.size = static_cast<std::size_t>(io::ulog_unsigned(bytes + at, 2));
    message.type = bytes[at + 2];
    message.payload = bytes + at + io::kUlogMessageHeader;
    if (message.size > rest - at - io::kUlogMessageHeader) return false;
    const std::uint64_t there = std::min<std::uint64_t>(count - at - io::kUlogMessageHeader, message.size);
    const Judgement judgement = messages_.judge(message, static_cast<std::size_t>(there));
    const bool of_data = judgement == Judgement::unknown_id || judgement == Judgement::data_size;
    const bool trusted =
        judgement == Judgement::good || judgement == Judgement::removed_id || (of_data && trust == Trust::any_data);
    if (!trusted) return false;
    if (k == 0 && message.type == 'S' && there == message.size) return true;  // its magic bytes are enough
    at += io::kUlogMessageHeader + message.size;
  }
  return true;
}

bool UlogReader::follows(std::uint64_t next, std::uint64_t end) {
  const std::uint64_t count = std::min(end - next, kUlogLongestChain);
  const unsigned char* bytes = file_.at(next, static_cast<std::size_t>(count));
  if (bytes == nullptr) return false;
  // One that fits is enough where a size leads to it; several where more than one of their kind may be no good.
  return chain(bytes, count, end - next, 1, Trust::data_of_known_format) ||
         chain(bytes, count, end - next, kUlogChain, Trust::any_data);
}

std::uint64_t UlogReader::next_message(std::uint64_t from, std::uint64_t end) {
  while (from < end) {
    const std::uint64_t rest = end - from;
    const std::uint64_t count = std::min(rest, kUlogScanned + kUlogLongestChain);
    const unsigned char* bytes = file_.at(from, static_cast<std::size_t>(count));
    if (bytes == nullptr) return end;
    const std::uint64_t places = std::min(rest, kUlogScanned);
    for (std::uint64_t k = 0; k < places; ++k) {
      if (chain(bytes + k, count - k, rest - k, kUlogChain, Trust::data_of_known_format)) return from + k;
    }
    from += places;
  }
  return end;
}

// Where the size of a message that is no good leads to a message, that is the next one: data without a subscription and
// types of a later version are whole. Else the next one is looked for byte by byte.
void UlogReader::mend(const UlogMessage& message, Judgement judgement, std::uint64_t end) {
  const std::uint64_t rest = end - message.offset - io::kUlogMessageHeader;
  const bool too_long = message.size > rest;
  std::string consequence;
  if (too_long && judgement == Judgement::good && has_known_size(message.type)) {
    at_ = end;  // cut short: what follows its header is the rest of it
    consequence = "it is left out";
  } else {
    const std::uint64_t next = message.offset + io::kUlogMessageHeader + message.size;
    const bool whole = !too_long && message.size > 0 && (next == end || follows(next, end));
    at_ = whole ? next : next_message(message.offset + 1, end);
    consequence = at_ < end ? "what comes before byte " + std::to_string(at_) + " is left out"
                            : "nothing up to byte " + std::to_string(end) + " can be read";
  }
  messages_.say(message, judgement, end, consequence);
}

void UlogReader::read_until(std::uint64_t end) {
  while (at_ < end) {
    const std::uint64_t rest = end - at_;
    UlogMessage message;
    message.offset = at_;
    const unsigned char* bytes = nullptr;
    std::uint64_t there = 0;
    if (rest >= io::kUlogMessageHeader && (bytes = file_.at(at_, io::kUlogMessageHeader)) != nullptr) {
      message.size = static_cast<std::size_t>(io::ulog_unsigned(bytes, 2));
      message.type = bytes[2];
      there = std::min<std::uint64_t>(message.size, rest - io::kUlogMessageHeader);
      bytes = file_.at(at_, static_cast<std::size_t>(io::kUlogMessageHeader + there));
    }
    if (bytes == nullptr) {
      if (notes_.wanted(UlogTrouble::message, at_))
        notes_.say(at_, rest < io::kUlogMessageHeader
                            ? "the header of a message is cut short, it is left out"
                            : "the file became shorter while it was read, the rest is left out");
      at_ = rest < io::kUlogMessageHeader ? end : size_;
      return;
    }
    message.payload = bytes + io::kUlogMessageHeader;
    const Judgement judgement = messages_.judge(message, static_cast<std::size_t>(there));
    if (judgement == Judgement::good && there == message.size) {
      messages_.take(message);
      at_ += io::kUlogMessageHeader + message.size;
      read_ = at_;
      continue;
    }
    // The window moves on while the next message is looked for: what is said of this one comes from a copy.
    std::array<unsigned char, kUlogNeeded> beginning{};
    std::copy_n(message.payload, std::min<std::uint64_t>(there, beginning.size()), beginning.begin());
    message.payload = beginning.data();
    mend(message, judgement, end);
  }
}

io::FileExpected<LogExtent> UlogReader::read() {
  if (const auto opened = open(); !opened) return tl::make_unexpected(opened.error());
  if (const auto header = read_header(); !header) return tl::make_unexpected(header.error());
  if (const auto flags = read_flags(); !flags) return tl::make_unexpected(flags.error());
  // A logger that broke off leaves half a message before what was appended: each part is read to its own end.
  for (const std::uint64_t offset : appended_) read_until(offset);
  read_until(size_);
  notes_.sum_up();
  LogExtent out;
  out.bytes = size_;
  out.read_bytes = read_;
  out.records = messages_.records();
  out.dropped_s = messages_.dropped_s();
  return out;
}

}  // namespace

io::FileExpected<LogExtent> read_ulog(const std::string& path, LogSink& sink) { return UlogReader(path, sink).read(); }

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
