#include "plumb/core/detail/storage_map.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using storage_detail::word_at;

namespace {

/// TwoWords words side by side, in a register that every x86-64 and every ARMv8 has (vectors of GCC and Clang).
using TwoWords = std::uint64_t __attribute__((vector_size(16)));
constexpr bool kVectors = sizeof(void*) >= 8;

TwoWords two_at(const unsigned char* from) noexcept {
  TwoWords out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

}  // namespace

std::uint64_t sum_of_bytes(const unsigned char* from, std::size_t size) noexcept {
  std::uint64_t sum = 0;
  if constexpr (kVectors) {
    TwoWords a{}, b{};
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

namespace {

/// Of an address that is a multiple of eight. Storage that may change though no program writes to it is volatile; and
/// with that a processor of 32 bits takes a word in one instruction.
std::uint64_t aligned_word_at(const unsigned char* from) noexcept {
  using Word = const volatile std::uint64_t __attribute__((may_alias));
  return *static_cast<Word*>(static_cast<const void*>(from));
}

/// All bits of those of four bytes whose bit is set, as they lie in half a word whose lowest byte comes first.
constexpr std::uint32_t mask_of(std::uint32_t of_four) noexcept {
  return (of_four * 0x00204081U & 0x01010101U) * 0xFFU;
}

/// The halves of words, each added up by itself: no carry from one to the other, which would have to wait for it.
struct Halves {
  std::uint32_t low = 0, high = 0;
  void add(std::uint64_t word, std::uint32_t mask_low, std::uint32_t mask_high) noexcept {
    low += static_cast<std::uint32_t>(word) & mask_low;
    high += static_cast<std::uint32_t>(word >> 32U) & mask_high;
  }
  void add(std::uint64_t word) noexcept { add(word, ~0U, ~0U); }
  std::uint64_t word() const noexcept { return std::uint64_t{high} << 32U | low; }
};

/// TwoWords functions, or the processor has not registers enough for the first loop.
[[gnu::noinline]] std::uint64_t sum_of_stretches(const unsigned char* object, const StoragePlan& plan) noexcept {
  Halves sum;
  for (std::size_t k = 0; k < plan.stretches; ++k) {
    const unsigned char* from = object + std::size_t{8} * plan.stretch[k].first;
    std::size_t left = plan.stretch[k].count;
    for (; left >= 4; left -= 4, from += 32) {
      sum.add(aligned_word_at(from));
      sum.add(aligned_word_at(from + 8));
      sum.add(aligned_word_at(from + 16));
      sum.add(aligned_word_at(from + 24));
    }
    for (; left != 0; --left, from += 8) sum.add(aligned_word_at(from));
  }
  return sum.word();
}

}  // namespace

std::uint64_t sum_of_words(const unsigned char* object, const StoragePlan& plan) noexcept {
  Halves sum;
  sum.add(sum_of_stretches(object, plan));
  const std::uint16_t* word = plan.word;
  for (std::size_t k = 0; k < plan.groups; ++k) {
    const unsigned bytes = plan.group[k].bytes;
    const std::uint32_t low = mask_of(bytes & 0xFU), high = mask_of(bytes >> 4U);
    const std::uint16_t* const end = word + plan.group[k].count;
    for (; word != end; ++word) sum.add(aligned_word_at(object + std::size_t{8} * *word), low, high);
  }
  return sum.word();
}

}  // namespace PLUMB_ABI
}  // namespace plumb
