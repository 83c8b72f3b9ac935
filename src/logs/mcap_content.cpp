#include "mcap_content.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

std::string kept(std::string_view text) { return std::string(text.substr(0, RosTopics::kLongestName)); }

std::string_view why_not(Unpacker::Outcome outcome) noexcept {
  switch (outcome) {
    case Unpacker::Outcome::too_long: return "a chunk unpacks to more bytes than it says";
    case Unpacker::Outcome::damaged: return "a chunk cannot be unpacked";
    case Unpacker::Outcome::unknown: return "a chunk is packed in a way that is not known here (zstd and lz4 are)";
    case Unpacker::Outcome::failed: return "there is no memory to unpack a chunk";
    case Unpacker::Outcome::whole:
    case Unpacker::Outcome::cut: break;
  }
  return "a chunk is cut short";
}

}  // namespace

std::string_view McapContent::compression_of(std::string_view text) noexcept {
  for (const std::string_view known : {std::string_view(), std::string_view("zstd"), std::string_view("lz4")}) {
    if (text == known) return known;
  }
  return "?";
}

void McapContent::leave_out(std::uint64_t offset, const std::string& why) {
  if (notes_.wanted(RosTrouble::chunk, offset)) notes_.say(offset, why + ", its messages are left out");
}

bool McapContent::is_read(std::uint16_t channel) const {
  const auto found = channels_.find(channel);
  return found != channels_.end() && found->second.number != RosTopics::kNotRead;
}

void McapContent::schema(const McapSchema& schema, std::uint64_t offset) {
  if (schema.id == 0) return;  // "invalid, and should be ignored"
  const auto entry = schemas_.emplace(schema.id, kept(schema.name));
  if (entry.second || entry.first->second == kept(schema.name) || !notes_.wanted(RosTrouble::channel, offset)) return;
  notes_.say(offset,
             "the schema " + std::to_string(schema.id) + " comes a second time with another name, the first one stays");
}

void McapContent::channel(const McapChannel& channel, std::uint64_t offset) {
  Channel made;
  made.schema = channel.schema;
  made.topic = kept(channel.topic);
  made.encoding = kept(channel.encoding);
  const auto entry = channels_.emplace(channel.id, made);
  Channel& known = entry.first->second;
  if (!entry.second) {
    const bool is_same = known.schema == made.schema && known.topic == made.topic && known.encoding == made.encoding;
    if (!is_same && notes_.wanted(RosTrouble::channel, offset))
      notes_.say(offset, "the channel " + std::to_string(channel.id) +
                             " comes a second time with other content, the first one stays");
    return;
  }
  const auto found = schemas_.find(channel.schema);
  const std::string_view type = found == schemas_.end() ? std::string_view() : found->second;
  known.number = topics_.define(known.topic, type, known.encoding, offset);
}

void McapContent::message(const McapMessage& message, std::uint64_t offset) {
  const auto found = channels_.find(message.channel);
  if (found == channels_.end()) {
    if (notes_.wanted(RosTrouble::unknown, offset))
      notes_.say(offset, "a message is of channel " + std::to_string(message.channel) +
                             ", which nothing before it describes, it is left out");
    return;
  }
  constexpr std::uint64_t kLatest = std::numeric_limits<std::int64_t>::max();
  topics_.take(found->second.number, static_cast<std::int64_t>(std::min(message.log_time_ns, kLatest)), message.data,
               message.size, offset);
}

void McapContent::record(unsigned char op, const unsigned char* bytes, std::size_t size, std::uint64_t offset) {
  bool is_whole = true;
  if (op == static_cast<unsigned char>(McapOp::message)) {
    ++messages_;
    const auto found = mcap_message(bytes, size);
    is_whole = found.has_value();
    if (found) message(*found, offset);
  } else if (op == static_cast<unsigned char>(McapOp::channel)) {
    const auto found = mcap_channel(bytes, size);
    is_whole = found.has_value();
    if (found) channel(*found, offset);
  } else if (op == static_cast<unsigned char>(McapOp::schema)) {
    const auto found = mcap_schema(bytes, size);
    is_whole = found.has_value();
    if (found) schema(*found, offset);
  }
  if (!is_whole && notes_.wanted(RosTrouble::record, offset))
    notes_.say(offset, "a record is shorter than its fields, it is left out");
}

void McapContent::records_in(const unsigned char* bytes, std::size_t size, bool is_cut, std::uint64_t offset) {
  std::size_t at = 0;
  while (size - at >= kMcapHead) {
    const std::uint64_t length = mcap_whole(bytes + at + 1, 8);
    if (length > size - at - kMcapHead) break;
    record(bytes[at], bytes + at + kMcapHead, static_cast<std::size_t>(length), offset);
    at += kMcapHead + static_cast<std::size_t>(length);
  }
  if (at == size || is_cut || !notes_.wanted(RosTrouble::chunk, offset)) return;
  notes_.say(offset, "a record in a chunk runs past its end, what follows byte " + std::to_string(at) +
                         " of the unpacked chunk is left out");
}

void McapContent::chunk(const McapChunk& chunk, const unsigned char* packed, std::uint64_t there,
                        std::uint64_t offset) {
  if (chunk.size > kLargestChunk || there > kLargestChunk)
    return leave_out(offset,
                     "a chunk has " + std::to_string(std::max(chunk.size, there)) + " bytes, more than 256 MiB");
  const bool is_cut = there < chunk.packed;
  const unsigned char* bytes = packed;
  auto size = static_cast<std::size_t>(there);
  if (!chunk.compression.empty()) {
    using Outcome = Unpacker::Outcome;
    const Outcome outcome = unpacker_.unpack(chunk.compression, packed, size, static_cast<std::size_t>(chunk.size));
    if (outcome != Outcome::whole && !(outcome == Outcome::cut && is_cut))
      return leave_out(offset, std::string(why_not(outcome)));
    bytes = unpacker_.data();
    size = unpacker_.size();
  }
  if (!is_cut && size != chunk.size)
    return leave_out(
        offset, "a chunk holds " + std::to_string(size) + " bytes, not " + std::to_string(chunk.size) + " as it says");
  if (!is_cut && chunk.crc != 0 && ::libdeflate_crc32(0, bytes, size) != chunk.crc)
    return leave_out(offset, "the check sum of a chunk of " + std::to_string(size) + " bytes is wrong");
  records_in(bytes, size, is_cut, offset);
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
