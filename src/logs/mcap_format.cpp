#include "mcap_format.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

std::uint64_t mcap_whole(const unsigned char* bytes, std::size_t count) noexcept {
  std::uint64_t out = 0;
  for (std::size_t k = count; k > 0; --k) out = out << 8U | bytes[k - 1];
  return out;
}

std::uint64_t McapFields::whole(std::size_t count) noexcept {
  if (ended_ || count > size_ - at_) {
    ended_ = true;
    return 0;
  }
  at_ += count;
  return mcap_whole(bytes_ + at_ - count, count);
}

std::string_view McapFields::text() noexcept {
  const std::uint32_t count = u32();
  if (ended_ || count > size_ - at_) {
    ended_ = true;
    return {};
  }
  const char* begin = reinterpret_cast<const char*>(bytes_ + at_);  // NOLINT(*-reinterpret-cast): bytes as text
  at_ += count;
  return {begin, count};
}

std::optional<McapSchema> mcap_schema(const unsigned char* bytes, std::size_t size) noexcept {
  McapFields fields(bytes, size);
  McapSchema out;
  out.id = fields.u16();
  out.name = fields.text();
  (void)fields.text();  // the encoding and the definition: the name says what the message is
  (void)fields.text();
  if (fields.ended()) return std::nullopt;
  return out;
}

std::optional<McapChannel> mcap_channel(const unsigned char* bytes, std::size_t size) noexcept {
  McapFields fields(bytes, size);
  McapChannel out;
  out.id = fields.u16();
  out.schema = fields.u16();
  out.topic = fields.text();
  out.encoding = fields.text();
  if (fields.ended()) return std::nullopt;
  return out;
}

std::optional<McapMessage> mcap_message(const unsigned char* bytes, std::size_t size) noexcept {
  McapFields fields(bytes, size);
  McapMessage out;
  out.channel = fields.u16();
  (void)fields.u32();  // counted by the publisher
  out.log_time_ns = fields.u64();
  (void)fields.u64();  // when it was published
  if (fields.ended()) return std::nullopt;
  out.data = fields.rest();
  out.size = fields.rest_size();
  return out;
}

std::optional<McapChunk> mcap_chunk(const unsigned char* bytes, std::size_t size) noexcept {
  McapFields fields(bytes, size);
  McapChunk out;
  (void)fields.u64();  // the times of its messages
  (void)fields.u64();
  out.size = fields.u64();
  out.crc = fields.u32();
  out.compression = fields.text();
  out.packed = fields.u64();
  if (fields.ended()) return std::nullopt;
  out.head = size - fields.rest_size();
  return out;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
