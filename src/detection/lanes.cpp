#include "plumb/detection/lanes.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "plumb/detection/combination_mae.hpp"

#if PLUMB_WIDE_LANES
#include <immintrin.h>
#endif

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// The sensors of all triples of as many sensors as fit, first, second and third, in lexicographic order. Those of
/// fewer sensors are the last ones of these, with as much taken off each as there are sensors fewer. They are not read
/// from the array: there they lie far apart, and damage to them might lead out of the readings.
struct Members {
  std::array<std::array<std::uint8_t, kTripleCapacity>, 3> sensor{};
  constexpr Members() noexcept {
    size_t next = 0;
    for (std::uint8_t i = 0; i < kCapacity; ++i) {
      for (auto j = static_cast<std::uint8_t>(i + 1); j < kCapacity; ++j) {
        for (auto k = static_cast<std::uint8_t>(j + 1); k < kCapacity; ++k) {
          sensor[0][next] = i;
          sensor[1][next] = j;
          sensor[2][next++] = k;
        }
      }
    }
  }
};
constexpr Members kMembers;

/// A double beyond this, a quarter of 2^32, has units as its last digit: an error that is added to it is rounded to the
/// nearest unit, ties to even, and stands as an integer in the low half. It is what `to_mae_units` does with a factor
/// of 2^22 on both sides, which no digit is lost by.
constexpr double kUnitsLast_mps2 = 0x1p30;
static_assert(kUnitsLast_mps2 == 0x1p52 * kMaeUnit_mps2);
constexpr double kMost_mps2 = kMaeClamp * kMaeUnit_mps2;

using Two = double __attribute__((vector_size(16)));
using TwoBits = std::uint64_t __attribute__((vector_size(16)));
constexpr std::uint64_t kLowHalf = 0xFFFF'FFFFU;
constexpr std::uint64_t kAbsent = 0x8000'0000'8000'0000U;  ///< the signs of two slots
constexpr std::uint64_t kNoSign = 0x7FFF'FFFF'FFFF'FFFFU;

/// The second where one of them is a NaN, and where they are equal: what the instruction of x86 does.
inline Two larger(Two a, Two b) noexcept {
#if PLUMB_WIDE_LANES
  return _mm_max_pd(a, b);
#else
  return a > b ? a : b;
#endif
}
inline Two smaller(Two a, Two b) noexcept {
#if PLUMB_WIDE_LANES
  return _mm_min_pd(a, b);
#else
  return a < b ? a : b;
#endif
}

constexpr size_t members_of(int triples) noexcept { return static_cast<size_t>(kTripleCapacity - triples); }

}  // namespace

/// `squared_length` and `to_mae_units` written out, here and below: a vector must not be handed to a function that is
/// compiled for narrower registers. The six coefficients are not read in a loop, for which the compiler would keep them
/// on the stack.
int replace_twos(const SensorArray& array, const double* y_mps2, double g_mps2, const MaeRow& row, int first) noexcept {
  const Two none = {0.0, 0.0};
  const Two most = {kMost_mps2, kMost_mps2};
  const double* const y = y_mps2;
  const size_t members = members_of(row.triples);
  std::int32_t* const row_slots = row.slots;
  std::int64_t* const row_sums = row.sums;
  const int last = row.triples;
  for (; first + 2 <= last; first += 2) {
    const auto k = static_cast<size_t>(first);
    std::uint64_t old = 0;
    std::memcpy(&old, row_slots + k, sizeof old);
    if ((old & kAbsent) != 0) return first;
    const std::uint8_t* const s = &kMembers.sensor[0][members + k];
    const std::uint8_t* const t = &kMembers.sensor[1][members + k];
    const std::uint8_t* const u = &kMembers.sensor[2][members + k];
    const Two a = {y[s[0]], y[s[1]]};
    const Two b = {y[t[0]], y[t[1]]};
    const Two c = {y[u[0]], y[u[1]]};
    Two q0, q1, q2, q3, q4, q5;
    std::memcpy(&q0, array.form_coefficients(0) + k, sizeof q0);
    std::memcpy(&q1, array.form_coefficients(1) + k, sizeof q1);
    std::memcpy(&q2, array.form_coefficients(2) + k, sizeof q2);
    std::memcpy(&q3, array.form_coefficients(3) + k, sizeof q3);
    std::memcpy(&q4, array.form_coefficients(4) + k, sizeof q4);
    std::memcpy(&q5, array.form_coefficients(5) + k, sizeof q5);
    const Two square = q0 * a * a + q1 * b * b + q2 * c * c + q3 * a * b + q4 * a * c + q5 * b * c;
    const Two kept = larger(none, square);
    const Two length = {std::sqrt(kept[0]), std::sqrt(kept[1])};
    const auto error = reinterpret_cast<Two>(reinterpret_cast<TwoBits>(length - g_mps2) & kNoSign);
    const Two held = smaller(error, most);
    const TwoBits now = reinterpret_cast<TwoBits>(held + kUnitsLast_mps2) & kLowHalf;
    const std::uint64_t both = now[0] | now[1] << 32U;
    std::memcpy(row_slots + k, &both, sizeof both);
    TwoBits sum;
    std::memcpy(&sum, row_sums + k, sizeof sum);
    sum += now - TwoBits{old & kLowHalf, old >> 32U};
    std::memcpy(row_sums + k, &sum, sizeof sum);
  }
  return first;
}

#if PLUMB_WIDE_LANES
__attribute__((target("avx2"))) int replace_fours(const SensorArray& array, const double* y_mps2, double g_mps2,
                                                  const MaeRow& row, int first) noexcept {
  const double* const y = y_mps2;
  const size_t members = members_of(row.triples);
  std::int32_t* const row_slots = row.slots;
  std::int64_t* const row_sums = row.sums;
  const int last = row.triples;
  const __m256d none = _mm256_setzero_pd();
  const __m256d most = _mm256_set1_pd(kMost_mps2), units_last = _mm256_set1_pd(kUnitsLast_mps2);
  const __m256d g = _mm256_set1_pd(g_mps2), sign = _mm256_set1_pd(-0.0);
  const __m256i evens = _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6);
  for (; first + 4 <= last; first += 4) {
    const auto k = static_cast<size_t>(first);
    auto* const slots = reinterpret_cast<__m128i*>(row_slots + k);
    auto* const sums = reinterpret_cast<__m256i*>(row_sums + k);
    const __m128i old = _mm_loadu_si128(slots);
    if (_mm_movemask_ps(_mm_castsi128_ps(old)) != 0) return first;
    // With four sensors at most, the four triples are always the same.
    const size_t m = kTripleCapacity == 4 ? 0 : members + k;
    const auto& s = kMembers.sensor;
    const __m256d a = _mm256_setr_pd(y[s[0][m]], y[s[0][m + 1]], y[s[0][m + 2]], y[s[0][m + 3]]);
    const __m256d b = _mm256_setr_pd(y[s[1][m]], y[s[1][m + 1]], y[s[1][m + 2]], y[s[1][m + 3]]);
    const __m256d c = _mm256_setr_pd(y[s[2][m]], y[s[2][m + 1]], y[s[2][m + 2]], y[s[2][m + 3]]);
    const __m256d q0 = _mm256_loadu_pd(array.form_coefficients(0) + k);
    const __m256d q1 = _mm256_loadu_pd(array.form_coefficients(1) + k);
    const __m256d q2 = _mm256_loadu_pd(array.form_coefficients(2) + k);
    const __m256d q3 = _mm256_loadu_pd(array.form_coefficients(3) + k);
    const __m256d q4 = _mm256_loadu_pd(array.form_coefficients(4) + k);
    const __m256d q5 = _mm256_loadu_pd(array.form_coefficients(5) + k);
    const __m256d square = q0 * a * a + q1 * b * b + q2 * c * c + q3 * a * b + q4 * a * c + q5 * b * c;
    const __m256d length = _mm256_sqrt_pd(_mm256_max_pd(none, square));
    const __m256d held = _mm256_min_pd(_mm256_andnot_pd(sign, length - g), most);
    const __m256i low = _mm256_permutevar8x32_epi32(_mm256_castpd_si256(held + units_last), evens);
    const __m128i now = _mm256_castsi256_si128(low);
    _mm_storeu_si128(slots, now);
    const __m256i more = _mm256_cvtepi32_epi64(_mm_sub_epi32(now, old));
    _mm256_storeu_si256(sums, _mm256_add_epi64(_mm256_loadu_si256(sums), more));
  }
  return first;
}

namespace {
constexpr __mmask8 kAll = 0xFF;

/// Eight readings in a register, from which eight triples take theirs in one instruction; an index has as many digits
/// as there are readings, whatever stands before them.
__attribute__((target("avx512f"), always_inline)) inline __m512d picked(__m512d y0, __m512d y1, __m512d y2,
                                                                        const std::uint8_t* sensors) noexcept {
  const __m512i at = _mm512_maskz_cvtepu8_epi64(kAll, _mm_loadl_epi64(reinterpret_cast<const __m128i*>(sensors)));
  if constexpr (kCapacity <= 8) return _mm512_maskz_permutexvar_pd(kAll, at, y0);
  const __m512d of_sixteen = _mm512_permutex2var_pd(y0, at, y1);
  if constexpr (kCapacity <= 16) return of_sixteen;
  return _mm512_mask_permutexvar_pd(of_sixteen, _mm512_test_epi64_mask(at, _mm512_set1_epi64(16)), at, y2);
}
}  // namespace

__attribute__((target("avx512f"))) int replace_eights(const SensorArray& array, const double* y_mps2, double g_mps2,
                                                      const MaeRow& row, int first) noexcept {
  const size_t members = members_of(row.triples);
  std::int32_t* const row_slots = row.slots;
  std::int64_t* const row_sums = row.sums;
  const int last = row.triples;
  const __m512d none = _mm512_setzero_pd();
  const __m512d most = _mm512_set1_pd(kMost_mps2), units_last = _mm512_set1_pd(kUnitsLast_mps2);
  const __m512d g = _mm512_set1_pd(g_mps2);
  constexpr size_t kSecond = kCapacity > 8 ? 8 : 0, kThird = kCapacity > 16 ? 16 : 0;
  const __m512d y0 = _mm512_loadu_pd(y_mps2), y1 = _mm512_loadu_pd(y_mps2 + kSecond),
                y2 = _mm512_loadu_pd(y_mps2 + kThird);
  for (; first + 8 <= last; first += 8) {
    const auto k = static_cast<size_t>(first);
    auto* const slots = reinterpret_cast<__m256i*>(row_slots + k);
    std::int64_t* const sums = row_sums + k;
    const __m256i old = _mm256_loadu_si256(slots);
    if (_mm256_movemask_ps(_mm256_castsi256_ps(old)) != 0) return first;
    const __m512d a = picked(y0, y1, y2, &kMembers.sensor[0][members + k]);
    const __m512d b = picked(y0, y1, y2, &kMembers.sensor[1][members + k]);
    const __m512d c = picked(y0, y1, y2, &kMembers.sensor[2][members + k]);
    const __m512d q0 = _mm512_loadu_pd(array.form_coefficients(0) + k);
    const __m512d q1 = _mm512_loadu_pd(array.form_coefficients(1) + k);
    const __m512d q2 = _mm512_loadu_pd(array.form_coefficients(2) + k);
    const __m512d q3 = _mm512_loadu_pd(array.form_coefficients(3) + k);
    const __m512d q4 = _mm512_loadu_pd(array.form_coefficients(4) + k);
    const __m512d q5 = _mm512_loadu_pd(array.form_coefficients(5) + k);
    const __m512d square = q0 * a * a + q1 * b * b + q2 * c * c + q3 * a * b + q4 * a * c + q5 * b * c;
    const __m512d length = _mm512_maskz_sqrt_pd(kAll, _mm512_maskz_max_pd(kAll, none, square));
    const __m512d held = _mm512_maskz_min_pd(kAll, _mm512_abs_pd(length - g), most);
    const __m256i now = _mm512_maskz_cvtepi64_epi32(kAll, _mm512_castpd_si512(held + units_last));
    _mm256_storeu_si256(slots, now);
    const __m512i more = _mm512_maskz_cvtepi32_epi64(kAll, _mm256_sub_epi32(now, old));
    _mm512_storeu_si512(sums, _mm512_add_epi64(_mm512_loadu_si512(sums), more));
  }
  return first;
}
#endif

}  // namespace PLUMB_ABI
}  // namespace plumb
