/// Logs of PX4 in memory, message by message, for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace ulog_bytes {

inline std::string little_endian(std::uint64_t value, std::size_t bytes) {
  std::string out;
  for (std::size_t k = 0; k < bytes; ++k) out += static_cast<char>(value >> (8 * k) & 0xFFU);
  return out;
}
inline std::string u8(std::uint64_t value) { return little_endian(value, 1); }
inline std::string u16(std::uint64_t value) { return little_endian(value, 2); }
inline std::string u32(std::uint64_t value) { return little_endian(value, 4); }
inline std::string u64(std::uint64_t value) { return little_endian(value, 8); }
inline std::string f32(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return u32(bits);
}
inline std::string f32(float x, float y, float z) { return f32(x) + f32(y) + f32(z); }

inline std::string message(char type, const std::string& payload) { return u16(payload.size()) + type + payload; }
inline std::string header(std::uint64_t zero_us = 1000000) {
  return std::string("ULog\x01\x12\x35\x01", 8) + u64(zero_us);
}
inline std::string flags(unsigned incompatible = 0, const std::vector<std::uint64_t>& appended = {0, 0, 0}) {
  std::string payload = u64(0) + u64(incompatible);
  for (const std::uint64_t offset : appended) payload += u64(offset);
  return message('B', payload);
}
inline std::string format(const std::string& text) { return message('F', text); }
inline std::string subscription(int instance, int id, const std::string& name) {
  return message('A', u8(static_cast<std::uint64_t>(instance)) + u16(static_cast<std::uint64_t>(id)) + name);
}
inline std::string removal(int id) { return message('R', u16(static_cast<std::uint64_t>(id))); }
inline std::string data(int id, const std::string& payload) {
  return message('D', u16(static_cast<std::uint64_t>(id)) + payload);
}
inline std::string dropout(int ms) { return message('O', u16(static_cast<std::uint64_t>(ms))); }
inline std::string sync_mark() { return message('S', "\x2F\x73\x13\x20\x25\x0C\xBB\x12"); }
inline std::string parameter(const std::string& key, const std::string& value) {
  return message('P', u8(key.size()) + key + value);
}

}  // namespace ulog_bytes
