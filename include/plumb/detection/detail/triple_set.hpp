/// A set of triples, each by its number in the array (`SensorArray::triple`).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct TripleSet {
  static constexpr int kWords = (kTripleCapacity + 63) / 64;
  std::array<std::uint64_t, static_cast<std::size_t>(kWords)> bits{};  ///< triple k: bit k mod 64 of word k / 64

  void add(int triple) noexcept { bits[word(triple)] |= std::uint64_t{1} << (static_cast<unsigned>(triple) % 64U); }
  bool has(int triple) const noexcept {
    return (bits[word(triple)] >> (static_cast<unsigned>(triple) % 64U) & 1U) != 0;
  }
  bool empty() const noexcept {
    std::uint64_t any = 0;
    for (const std::uint64_t w : bits) any |= w;
    return any == 0;
  }
  static constexpr auto fields() noexcept { return field_list(&TripleSet::bits); }

 private:
  static constexpr std::size_t word(int triple) noexcept { return static_cast<std::size_t>(triple) / 64U; }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
