#include "plumb/core/detail/storage_map.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using storage_detail::word_at;

namespace {

/// Two words side by side, in a register that every x86-64 and every ARMv8 has (vectors of GCC and Clang).
using Two = std::uint64_t __attribute__((vector_size(16)));
constexpr bool kVectors = sizeof(void*) >= 8;

Two two_at(const unsigned char* from) noexcept {
  Two out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

}  // namespace

std::uint64_t sum_of_bytes(const unsigned char* from, std::size_t size) noexcept {
  std::uint64_t sum = 0;
  if constexpr (kVectors) {
    Two a{}, b{};
    for (; size >= 64; size -= 64, from += 64) {
      a += two_at(from) + two_at(from + 16);
      b += two_at(from + 32) + two_at(from + 48);
    }
    a += b;
    sum = a[0] + a[1];
  }
  for (; size >= 32; size -= 32, from += 32) {
    sum += word_at<std::uint64_t>(from) + word_at<std::uint64_t>(from + 8) + word_at<std::uint64_t>(from + 16) +
           word_at<std::uint64_t>(from + 24);
  }
  for (; size >= 8; size -= 8, from += 8) sum += word_at<std::uint64_t>(from);
  if ((size & 4U) != 0) {
    sum += word_at<std::uint32_t>(from);
    from += 4;
  }
  if ((size & 2U) != 0) {
    sum += word_at<std::uint16_t>(from);
    from += 2;
  }
  return (size & 1U) != 0 ? sum + *from : sum;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
