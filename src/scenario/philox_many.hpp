/// Philox4x32-10 for many counters in a row under one key (private to src/scenario): word for word what Random123
/// computes for each of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plumb/core/config.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

struct PhiloxKey {
  std::uint32_t low = 0, high = 0;
};

/// The two 64-bit words of every block.
template <std::size_t kCount>
struct PhiloxLanes {
  std::array<std::uint64_t, kCount> first, second;
};

namespace philox_detail {

constexpr std::uint64_t kMultiply0 = 0xD2511F53U, kMultiply1 = 0xCD9E8D57U;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9U, kWeyl1 = 0xBB67AE85U;
constexpr int kRounds = 10;

/// One counter after the other, in plain integers.
template <std::size_t kCount>
void plain(std::uint64_t index, std::uint32_t selector, std::uint32_t id, PhiloxKey key,
           PhiloxLanes<kCount>& out) noexcept {
  for (std::size_t k = 0; k < kCount; ++k, ++index) {
    auto c0 = static_cast<std::uint32_t>(index), c1 = static_cast<std::uint32_t>(index >> 32U);
    std::uint32_t c2 = selector, c3 = id;
    PhiloxKey round = key;
    for (int r = 0; r < kRounds; ++r) {
      const std::uint64_t a = kMultiply0 * c0, b = kMultiply1 * c2;
      c0 = static_cast<std::uint32_t>(b >> 32U) ^ c1 ^ round.low;
      c1 = static_cast<std::uint32_t>(b);
      c2 = static_cast<std::uint32_t>(a >> 32U) ^ c3 ^ round.high;
      c3 = static_cast<std::uint32_t>(a);
      round.low += kWeyl0;
      round.high += kWeyl1;
    }
    out.first[k] = std::uint64_t{c0} | std::uint64_t{c1} << 32U;
    out.second[k] = std::uint64_t{c2} | std::uint64_t{c3} << 32U;
  }
}

#if defined(__x86_64__)
/// Four counters side by side, each 32-bit word in the low half of a 64-bit lane; four such groups in flight hide the
/// latency of the multiplications.
template <std::size_t kCount>
__attribute__((target("avx2"))) void avx2(std::uint64_t index, std::uint32_t selector, std::uint32_t id, PhiloxKey key,
                                          PhiloxLanes<kCount>& out) noexcept {
  constexpr std::size_t kGroups = 4, kLane = 4;
  static_assert(kCount % (kGroups * kLane) == 0, "whole groups");
  const __m256i multiply0 = _mm256_set1_epi64x(static_cast<long long>(kMultiply0));
  const __m256i multiply1 = _mm256_set1_epi64x(static_cast<long long>(kMultiply1));
  const __m256i low = _mm256_set1_epi64x(0xFFFFFFFFLL);
  for (std::size_t k = 0; k < kCount; k += kGroups * kLane) {
    __m256i c0[kGroups], c1[kGroups], c2[kGroups], c3[kGroups];
    for (std::size_t g = 0; g < kGroups; ++g) {
      const auto from = static_cast<long long>(index + k + kLane * g);
      const __m256i at = _mm256_add_epi64(_mm256_set1_epi64x(from), _mm256_set_epi64x(3, 2, 1, 0));
      c0[g] = at;  // the multiplication looks at the low half alone
      c1[g] = _mm256_srli_epi64(at, 32);
      c2[g] = _mm256_set1_epi64x(selector);
      c3[g] = _mm256_set1_epi64x(id);
    }
    PhiloxKey round = key;
    for (int r = 0; r < kRounds; ++r) {
      const __m256i key0 = _mm256_set1_epi64x(round.low), key1 = _mm256_set1_epi64x(round.high);
      for (std::size_t g = 0; g < kGroups; ++g) {
        const __m256i a = _mm256_mul_epu32(c0[g], multiply0), b = _mm256_mul_epu32(c2[g], multiply1);
        // The upper halves of c1 and c3 may hold anything: only their low halves are ever used.
        c0[g] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(b, 32), c1[g]), key0);
        c2[g] = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(a, 32), c3[g]), key1);
        c1[g] = b;
        c3[g] = a;
      }
      round.low += kWeyl0;
      round.high += kWeyl1;
    }
    for (std::size_t g = 0; g < kGroups; ++g) {
      const __m256i one = _mm256_or_si256(_mm256_and_si256(c0[g], low), _mm256_slli_epi64(c1[g], 32));
      const __m256i two = _mm256_or_si256(_mm256_and_si256(c2[g], low), _mm256_slli_epi64(c3[g], 32));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(&out.first[k + kLane * g]), one);
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(&out.second[k + kLane * g]), two);
    }
  }
}
#endif

}  // namespace philox_detail

/// The blocks of the counters (index .. index + kCount - 1, selector, id).
template <std::size_t kCount>
void philox_many(std::uint64_t index, std::uint32_t selector, std::uint32_t id, PhiloxKey key,
                 PhiloxLanes<kCount>& out) noexcept {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) {
    philox_detail::avx2(index, selector, id, key, out);
    return;
  }
#endif
  philox_detail::plain(index, selector, id, key, out);
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
