/// CRC-64/XZ (ECMA-182 polynomial, reflected): tells whether bytes changed by accident. No protection against intent.
/// Every error within any 64 bits in a row is found for certain (one bit, one byte, one number); of all other changes
/// one in 2^64 slips through.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace crc64_detail {

constexpr std::array<std::uint64_t, 16> table() noexcept {
  std::array<std::uint64_t, 16> out{};
  for (std::size_t nibble = 0; nibble < out.size(); ++nibble) {
    std::uint64_t rest = nibble;
    for (int bit = 0; bit < 4; ++bit) rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? 0xC96C5795D7870F42ULL : 0ULL);
    out[nibble] = rest;
  }
  return out;
}
inline constexpr std::array<std::uint64_t, 16> kTable = table();

}  // namespace crc64_detail

class Crc64 {
 public:
  void add(std::uint8_t byte) noexcept {
    // Four bits at a time: a table of 128 bytes, not one of 2 KiB.
    state_ = (state_ >> 4U) ^ crc64_detail::kTable[static_cast<std::size_t>((state_ ^ byte) & 15U)];
    state_ = (state_ >> 4U) ^ crc64_detail::kTable[static_cast<std::size_t>((state_ ^ (byte >> 4U)) & 15U)];
  }
  void add(const std::uint8_t* bytes, std::size_t count) noexcept {
    for (std::size_t k = 0; k < count; ++k) add(bytes[k]);
  }
  std::uint64_t value() const noexcept { return ~state_; }

 private:
  std::uint64_t state_ = ~std::uint64_t{0};
};

}  // namespace PLUMB_ABI
}  // namespace plumb
