/// Numbers as bytes, the lowest first, on a machine of either byte order (private to src/io).
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline void put_u16(std::string& out, std::size_t value) {
  out += static_cast<char>(value & 0xFFU);
  out += static_cast<char>(value >> 8U & 0xFFU);
}
inline void put_u32(std::string& out, std::uint32_t value) {
  const std::uint32_t bytes = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? value : __builtin_bswap32(value);
  char text[sizeof bytes];
  std::memcpy(text, &bytes, sizeof bytes);
  out.append(text, sizeof text);
}
inline void put_u64(std::string& out, std::uint64_t value) {
  const std::uint64_t bytes = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? value : __builtin_bswap64(value);
  char text[sizeof bytes];
  std::memcpy(text, &bytes, sizeof bytes);
  out.append(text, sizeof text);
}
inline void put_double(std::string& out, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_u64(out, bits);
}

inline std::uint64_t u64_at(const unsigned char* at) noexcept {
  std::uint64_t value = 0;
  std::memcpy(&value, at, sizeof value);
  return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? value : __builtin_bswap64(value);
}
inline std::uint32_t u32_at(const unsigned char* at) noexcept {
  std::uint32_t value = 0;
  std::memcpy(&value, at, sizeof value);
  return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? value : __builtin_bswap32(value);
}
inline std::size_t u16_at(const unsigned char* at) noexcept {
  return static_cast<std::size_t>(at[0]) | static_cast<std::size_t>(at[1]) << 8U;
}
inline double double_at(const unsigned char* at) noexcept {
  const std::uint64_t bits = u64_at(at);
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
