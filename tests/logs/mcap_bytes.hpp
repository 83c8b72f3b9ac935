/// MCAP in memory, record by record, for tests. It shares no code with the reader: its own check sum among it.
#pragma once

#include <lz4frame.h>
#include <zstd.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "ros_bytes.hpp"

namespace mcap_bytes {

inline std::string whole(std::uint64_t value, std::size_t bytes) {
  std::string out;
  for (std::size_t k = 0; k < bytes; ++k) out += static_cast<char>(value >> (8 * k) & 0xFFU);
  return out;
}
inline std::string text(const std::string& value) { return whole(value.size(), 4) + value; }

/// CRC-32 as IEEE 802.3 has it, bit by bit.
inline std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

inline std::string zstd(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  return out;
}
inline std::string lz4(const std::string& bytes) {
  std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  return out;
}

inline const std::string kMagic = "\x89MCAP0\r\n";
inline std::string record(int op, const std::string& content) {
  return static_cast<char>(op) + whole(content.size(), 8) + content;
}
inline std::string header() { return kMagic + record(0x01, text("ros2") + text("plumb's tests")); }
inline std::string schema(unsigned id, const std::string& name, const std::string& encoding = "ros2msg") {
  return record(0x03, whole(id, 2) + text(name) + text(encoding) + text("std_msgs/Header header"));
}
inline std::string channel(unsigned id, unsigned schema_id, const std::string& topic,
                           const std::string& encoding = "cdr") {
  return record(0x04, whole(id, 2) + whole(schema_id, 2) + text(topic) + text(encoding) +
                          text(text("offered_qos_profiles") + text("- history: 3")));
}
constexpr std::uint64_t kLogTime_ns = 1700000000500000000U;
inline std::string message(unsigned channel_id, const std::string& data, std::uint64_t log_time_ns = kLogTime_ns) {
  return record(0x05, whole(channel_id, 2) + whole(0, 4) + whole(log_time_ns, 8) + whole(log_time_ns, 8) + data);
}
inline std::string imu_message(unsigned channel_id, const ros_bytes::Imu& imu) {
  return message(channel_id, ros_bytes::imu(imu));
}
/// Of packed records with whatever is said of them.
inline std::string raw_chunk(std::uint64_t size, std::uint32_t crc, const std::string& compression,
                             const std::string& packed) {
  return record(0x06, whole(0, 8) + whole(0, 8) + whole(size, 8) + whole(crc, 4) + text(compression) +
                          whole(packed.size(), 8) + packed);
}
inline std::string chunk(const std::string& records, const std::string& compression = "") {
  const std::string packed = compression == "zstd" ? zstd(records) : compression == "lz4" ? lz4(records) : records;
  return raw_chunk(records.size(), crc32(records), compression, packed);
}
inline std::string data_end() { return record(0x0F, whole(0, 4)); }
inline std::string footer() { return record(0x02, whole(0, 8) + whole(0, 8) + whole(0, 4)) + kMagic; }
inline std::string message_index(unsigned channel_id) {
  return record(0x07, whole(channel_id, 2) + whole(16, 4) + whole(1, 8) + whole(0, 8));
}

inline std::string described(unsigned id = 1, const std::string& topic = "/imu/data") {
  return schema(id, "sensor_msgs/msg/Imu") + channel(id, id, topic);
}

/// Two IMUs and a camera, three chunks packed in three ways, what stands before, between and behind them.
inline std::string small_bag() {
  std::string out = header() + record(0x0C, text("rosbag2") + text(""));
  const std::string both =
      described() + channel(2, 1, "/imu/spare") + schema(3, "sensor_msgs/msg/Image") + channel(3, 3, "/camera/image");
  int k = 0;
  for (const std::string& compression : {std::string(), std::string("zstd"), std::string("lz4")}) {
    std::string records = k == 0 ? both : std::string();
    for (int n = 0; n < 4; ++n, ++k) {
      records += imu_message(1, ros_bytes::imu_at(k)) + imu_message(2, ros_bytes::imu_at(k, 9.5)) +
                 message(3, std::string(40, 'i'));
    }
    out += chunk(records, compression) + message_index(1) + message_index(2);
  }
  out += imu_message(1, ros_bytes::imu_at(k));
  return out + data_end() + schema(1, "sensor_msgs/msg/Imu") + channel(1, 1, "/imu/data") + footer();
}

}  // namespace mcap_bytes
