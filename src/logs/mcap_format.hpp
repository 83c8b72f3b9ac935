/// The records of MCAP out of bytes, https://mcap.dev/spec (private to src/logs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::size_t kMcapHead = 9;  ///< of a record: its opcode and how many bytes follow

enum class McapOp : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  statistics = 0x0B,
  data_end = 0x0F,
};
/// Of the records that the format knows, and those that it leaves to others.
constexpr bool is_mcap_op(unsigned char op) noexcept { return (op >= 0x01 && op <= 0x0F) || op >= 0x80; }

/// One behind the other. A read past the end gives 0 or nothing, and is remembered.
class McapFields {
 public:
  McapFields(const unsigned char* bytes, std::size_t size) : bytes_(bytes), size_(size) {}

  std::uint16_t u16() noexcept { return static_cast<std::uint16_t>(whole(2)); }
  std::uint32_t u32() noexcept { return static_cast<std::uint32_t>(whole(4)); }
  std::uint64_t u64() noexcept { return whole(8); }
  std::string_view text() noexcept;
  const unsigned char* rest() const noexcept { return bytes_ + at_; }
  std::size_t rest_size() const noexcept { return size_ - at_; }
  bool ended() const noexcept { return ended_; }

 private:
  std::uint64_t whole(std::size_t count) noexcept;

  const unsigned char* bytes_;
  std::size_t size_;
  std::size_t at_ = 0;
  bool ended_ = false;
};

struct McapSchema {
  std::uint16_t id = 0;
  std::string_view name;
};
struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;
  std::string_view topic;
  std::string_view encoding;
};
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t log_time_ns = 0;
  const unsigned char* data = nullptr;
  std::size_t size = 0;
};
/// Its head; the packed records follow it.
struct McapChunk {
  std::uint64_t size = 0;  ///< unpacked
  std::uint32_t crc = 0;   ///< of the unpacked records; 0: there is none
  std::string_view compression;
  std::uint64_t packed = 0;  ///< bytes
  std::size_t head = 0;      ///< bytes before them
};

/// Empty where the record is shorter than its fields. What is longer has fields of a later version.
std::optional<McapSchema> mcap_schema(const unsigned char* bytes, std::size_t size) noexcept;
std::optional<McapChannel> mcap_channel(const unsigned char* bytes, std::size_t size) noexcept;
std::optional<McapMessage> mcap_message(const unsigned char* bytes, std::size_t size) noexcept;
/// `size` bytes of the record are there, which may be fewer than it has.
std::optional<McapChunk> mcap_chunk(const unsigned char* bytes, std::size_t size) noexcept;

/// Little-endian.
std::uint64_t mcap_whole(const unsigned char* bytes, std::size_t count) noexcept;

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
