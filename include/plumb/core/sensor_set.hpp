/// A set of sensors of one array, as bits: bit i stands for the i-th sensor of the array file.
#pragma once

#include <cstdint>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct SensorSet {
  std::uint32_t bits = 0;

  constexpr SensorSet() noexcept = default;
  constexpr explicit SensorSet(std::uint32_t b) noexcept : bits(b) {}

  /// The set {0 .. n-1}; n is clamped to 0 .. 32.
  static constexpr SensorSet first(int n) noexcept {
    return SensorSet(n <= 0 ? 0U : n >= 32 ? ~0U : (1U << static_cast<unsigned>(n)) - 1U);
  }
  static constexpr SensorSet of(int i) noexcept {
    return SensorSet(i >= 0 && i < 32 ? 1U << static_cast<unsigned>(i) : 0U);
  }

  constexpr bool has(int i) const noexcept { return i >= 0 && i < 32 && (bits >> static_cast<unsigned>(i) & 1U) != 0; }
  constexpr bool empty() const noexcept { return bits == 0; }
  constexpr int size() const noexcept {
    int count = 0;
    for (std::uint32_t b = bits; b != 0; b &= b - 1) ++count;
    return count;
  }
  /// Index of the lowest member, -1 for the empty set.
  constexpr int lowest() const noexcept { return bits == 0 ? -1 : __builtin_ctz(bits); }
  constexpr bool contains(SensorSet other) const noexcept { return (other.bits & ~bits) == 0; }

  constexpr SensorSet with(int i) const noexcept { return SensorSet(bits | of(i).bits); }
  constexpr SensorSet without(int i) const noexcept { return SensorSet(bits & ~of(i).bits); }

  friend constexpr SensorSet operator|(SensorSet a, SensorSet b) noexcept { return SensorSet(a.bits | b.bits); }
  friend constexpr SensorSet operator&(SensorSet a, SensorSet b) noexcept { return SensorSet(a.bits & b.bits); }
  /// Members of a that are not members of b.
  friend constexpr SensorSet operator-(SensorSet a, SensorSet b) noexcept { return SensorSet(a.bits & ~b.bits); }
  friend constexpr bool operator==(SensorSet a, SensorSet b) noexcept { return a.bits == b.bits; }
  friend constexpr bool operator!=(SensorSet a, SensorSet b) noexcept { return a.bits != b.bits; }
};

/// The next set with as many members as `s`, in increasing order of bits (Gosper); the caller stops
/// at its own universe. `s` must not be empty.
constexpr SensorSet next_of_same_size(SensorSet s) noexcept {
  const std::uint32_t low = s.bits & (~s.bits + 1U);
  const std::uint32_t ripple = s.bits + low;
  if (ripple == 0) return SensorSet(~0U);
  return SensorSet((((ripple ^ s.bits) >> 2U) / low) | ripple);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
