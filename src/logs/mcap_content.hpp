/// What the records of MCAP hold: schemas, channels and messages, in chunks or not (private to src/logs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "mcap_format.hpp"
#include "plumb/core/config.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ros_notes.hpp"
#include "ros_topics.hpp"
#include "unpack.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

class McapContent {
 public:
  /// Bytes of a chunk, packed or not. Writers begin a new one at some megabytes, or behind one large message.
  static constexpr std::uint64_t kLargestChunk = 256U << 20U;

  McapContent(LogSink& sink, RosNotes& notes) : notes_(notes), topics_(sink, notes) {}

  /// A schema, a channel or a message. `offset` is that of the record, or of the chunk that it is in.
  void record(unsigned char op, const unsigned char* bytes, std::size_t size, std::uint64_t offset);
  /// `there` of its packed bytes; fewer than it has where the log ends within it.
  void chunk(const McapChunk& chunk, const unsigned char* packed, std::uint64_t there, std::uint64_t offset);
  bool is_read(std::uint16_t channel) const;
  void finish() { topics_.finish(); }
  std::uint64_t records() const noexcept { return topics_.records(); }
  /// Of all channels, read or not.
  std::uint64_t messages() const noexcept { return messages_; }

  /// A text that stays where it is: "", "zstd", "lz4", or "?" for any other.
  static std::string_view compression_of(std::string_view text) noexcept;

 private:
  struct Channel {
    std::uint16_t schema = 0;
    std::string topic;
    std::string encoding;
    std::size_t number = RosTopics::kNotRead;
  };

  void schema(const McapSchema& schema, std::uint64_t offset);
  void channel(const McapChannel& channel, std::uint64_t offset);
  void message(const McapMessage& message, std::uint64_t offset);
  void records_in(const unsigned char* bytes, std::size_t size, bool is_cut, std::uint64_t offset);
  void leave_out(std::uint64_t offset, const std::string& why);

  RosNotes& notes_;
  RosTopics topics_;
  Unpacker unpacker_;
  std::uint64_t messages_ = 0;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
