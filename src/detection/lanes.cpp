#include "plumb/detection/detail/lanes.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "plumb/detection/combination_mae.hpp"

#if PLUMB_WIDE_LANES
#include <immintrin.h>
#endif

// The same bits as another vector, and places in memory as the instructions name them, have no other cast.
// NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast)

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

#if PLUMB_WIDE_LANES
#define PLUMB_AVX2 __attribute__((target("avx2")))
#define PLUMB_AVX512 __attribute__((target("avx512f")))
#define PLUMB_WITHIN __attribute__((always_inline)) inline
#else
#define PLUMB_WITHIN inline
#endif

namespace {

/// As wide as an index of a lane where the table stays small.
using Member = std::conditional_t<kCapacity <= 8, std::uint64_t, std::uint8_t>;

/// The sensors of all triples of as many sensors as fit, first, second and third, in lexicographic order. Those of
/// fewer sensors are the last ones of these, with as much taken off each as there are sensors fewer. They are not read
/// from the array: there they lie far apart, and damage to them might lead out of the readings.
struct Members {
  std::array<std::array<Member, kTripleCapacity>, 3> sensor{};
  constexpr Members() noexcept {
    size_t next = 0;
    for (Member i = 0; i < kCapacity; ++i) {
      for (auto j = static_cast<Member>(i + 1); j < kCapacity; ++j) {
        for (auto k = static_cast<Member>(j + 1); k < kCapacity; ++k) {
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
using TwoInts = std::uint32_t __attribute__((vector_size(8)));
constexpr int kUnitsLastHigh = 0x41D0'0000;  ///< the high half of `kUnitsLast_mps2`, whose low half is zero
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

/// Two slots of the ring, each as the low half of a `kUnitsLast_mps2` that it was added to; false where one is absent.
inline bool two_slots(const std::int32_t* slots, TwoBits& out) noexcept {
#if PLUMB_WIDE_LANES
  const __m128i both = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(slots));
  if (_mm_movemask_ps(_mm_castsi128_ps(both)) != 0) return false;
  out = reinterpret_cast<TwoBits>(_mm_unpacklo_epi32(both, _mm_set1_epi32(kUnitsLastHigh)));
#else
  if ((slots[0] | slots[1]) < 0) return false;
  out = TwoBits{static_cast<std::uint64_t>(slots[0]), static_cast<std::uint64_t>(slots[1])};
  out += std::uint64_t{kUnitsLastHigh} << 32U;
#endif
  return true;
}

constexpr size_t members_from(int triples) noexcept { return static_cast<size_t>(kTripleCapacity - triples); }

/// Two coefficients, as `wide` reads four or eight.
inline Two two_from(const double* q) noexcept {
  Two out;
  std::memcpy(&out, q, sizeof out);
  return out;
}

/// `squared_length` written out, here and below: a vector must not be handed to a function that is compiled for
/// narrower registers. The coefficients are not read in a loop, for which the compiler would keep them on the stack.
inline Two squares_of_two(const SensorArray& array, const double* y, size_t members, size_t k) noexcept {
  const Member* const s = &kMembers.sensor[0][members + k];
  const Member* const t = &kMembers.sensor[1][members + k];
  const Member* const u = &kMembers.sensor[2][members + k];
  const Two a = {y[s[0]], y[s[1]]};
  const Two b = {y[t[0]], y[t[1]]};
  const Two c = {y[u[0]], y[u[1]]};
  const Two q0 = two_from(array.form_coefficients(0) + k), q1 = two_from(array.form_coefficients(1) + k);
  const Two q2 = two_from(array.form_coefficients(2) + k), q3 = two_from(array.form_coefficients(3) + k);
  const Two q4 = two_from(array.form_coefficients(4) + k), q5 = two_from(array.form_coefficients(5) + k);
  return q0 * a * a + q1 * b * b + q2 * c * c + q3 * a * b + q4 * a * c + q5 * b * c;
}

/// What becomes of the squares, here and below: false, and nothing has changed, where a value was absent.
inline bool replace_two(Two square, double g_mps2, std::int32_t* slots, std::int64_t* sums) noexcept {
  const Two none = {0.0, 0.0};
  const Two most = {kMost_mps2, kMost_mps2};
  TwoBits old;
  if (!two_slots(slots, old)) return false;
  const Two kept = larger(none, square);
  const Two length = {std::sqrt(kept[0]), std::sqrt(kept[1])};
  const auto error = reinterpret_cast<Two>(reinterpret_cast<TwoBits>(length - g_mps2) & kNoSign);
  const auto now = reinterpret_cast<TwoBits>(smaller(error, most) + kUnitsLast_mps2);
  const TwoInts narrow = __builtin_convertvector(now, TwoInts);
  std::memcpy(slots, &narrow, sizeof narrow);
  TwoBits sum;
  std::memcpy(&sum, sums, sizeof sum);
  sum += now - old;
  std::memcpy(sums, &sum, sizeof sum);
  return true;
}

/// All of the rest that fill a vector, of which there is one at least, here and below: returns the first that is not
/// done. While the squares of some triples become errors, those of the next are already computed: one after the other
/// they are a long chain, of which a processor has too few at work at once.
PLUMB_WITHIN int replace_twos(const SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots,
                              std::int64_t* sums, TripleRange range) noexcept {
  const size_t members = members_from(range.end), end = static_cast<size_t>(range.end);
  auto k = static_cast<size_t>(range.first);
  Two square = squares_of_two(array, y_mps2, members, k);
  if (k + 4 <= end) {
    Two next = squares_of_two(array, y_mps2, members, k + 2);
    for (; k + 6 <= end; k += 2) {
      const Two after = squares_of_two(array, y_mps2, members, k + 4);
      if (!replace_two(square, g_mps2, slots + k, sums + k)) return static_cast<int>(k);
      square = next;
      next = after;
    }
    if (!replace_two(square, g_mps2, slots + k, sums + k)) return static_cast<int>(k);
    square = next;
    k += 2;
  }
  return static_cast<int>(replace_two(square, g_mps2, slots + k, sums + k) ? k + 2 : k);
}

int by_twos(const SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots, std::int64_t* sums,
            TripleRange range) noexcept {
  if (range.first + 2 <= range.end) range.first = replace_twos(array, y_mps2, g_mps2, slots, sums, range);
  return range.first;
}

#if PLUMB_WIDE_LANES
PLUMB_AVX2 PLUMB_WITHIN __m256d four_of(const double* y, const Member* sensors) noexcept {
  return _mm256_setr_pd(y[sensors[0]], y[sensors[1]], y[sensors[2]], y[sensors[3]]);
}

PLUMB_AVX2 PLUMB_WITHIN __m256d squares_of_four(const SensorArray& array, const double* y, size_t members,
                                                size_t k) noexcept {
  // With four sensors at most, the four triples are always the same.
  const size_t m = kTripleCapacity == 4 ? 0 : members + k;
  const __m256d a = four_of(y, &kMembers.sensor[0][m]);
  const __m256d b = four_of(y, &kMembers.sensor[1][m]);
  const __m256d c = four_of(y, &kMembers.sensor[2][m]);
  const __m256d q0 = _mm256_loadu_pd(array.form_coefficients(0) + k);
  const __m256d q1 = _mm256_loadu_pd(array.form_coefficients(1) + k);
  const __m256d q2 = _mm256_loadu_pd(array.form_coefficients(2) + k);
  const __m256d q3 = _mm256_loadu_pd(array.form_coefficients(3) + k);
  const __m256d q4 = _mm256_loadu_pd(array.form_coefficients(4) + k);
  const __m256d q5 = _mm256_loadu_pd(array.form_coefficients(5) + k);
  return q0 * a * a + q1 * b * b + q2 * c * c + q3 * a * b + q4 * a * c + q5 * b * c;
}

PLUMB_AVX2 PLUMB_WITHIN bool replace_four(__m256d square, double g_mps2, std::int32_t* slots,
                                          std::int64_t* sums) noexcept {
  const __m128i old = _mm_loadu_si128(reinterpret_cast<const __m128i*>(slots));
  if (_mm_movemask_ps(_mm_castsi128_ps(old)) != 0) return false;
  const __m256d length = _mm256_sqrt_pd(_mm256_max_pd(_mm256_setzero_pd(), square));
  const __m256d error = _mm256_andnot_pd(_mm256_set1_pd(-0.0), length - _mm256_set1_pd(g_mps2));
  const __m256d held = _mm256_min_pd(error, _mm256_set1_pd(kMost_mps2)) + _mm256_set1_pd(kUnitsLast_mps2);
  const __m256i low = _mm256_permutevar8x32_epi32(_mm256_castpd_si256(held), _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6));
  const __m128i now = _mm256_castsi256_si128(low);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(slots), now);
  auto* const sum = reinterpret_cast<__m256i*>(sums);
  const __m256i more = _mm256_cvtepi32_epi64(_mm_sub_epi32(now, old));
  _mm256_storeu_si256(sum, _mm256_add_epi64(_mm256_loadu_si256(sum), more));
  return true;
}

constexpr __mmask8 kAll = 0xFF;

/// Eight readings are a register, from which eight triples take theirs in one instruction; an index has as many digits
/// as there are readings, whatever stands before them.
struct Eights {
  __m512d y0, y1, y2;
};

PLUMB_AVX512 PLUMB_WITHIN __m512d eight_of(const Eights& y, const Member* sensors) noexcept {
  if constexpr (kCapacity <= 8) return _mm512_maskz_permutexvar_pd(kAll, _mm512_loadu_si512(sensors), y.y0);
  const __m512i at = _mm512_maskz_cvtepu8_epi64(kAll, _mm_loadl_epi64(reinterpret_cast<const __m128i*>(sensors)));
  const __m512d of_sixteen = _mm512_permutex2var_pd(y.y0, at, y.y1);
  if constexpr (kCapacity <= 16) return of_sixteen;
  return _mm512_mask_permutexvar_pd(of_sixteen, _mm512_test_epi64_mask(at, _mm512_set1_epi64(16)), at, y.y2);
}

PLUMB_AVX512 PLUMB_WITHIN __m512d squares_of_eight(const SensorArray& array, const Eights& y, size_t members,
                                                   size_t k) noexcept {
  const __m512d a = eight_of(y, &kMembers.sensor[0][members + k]);
  const __m512d b = eight_of(y, &kMembers.sensor[1][members + k]);
  const __m512d c = eight_of(y, &kMembers.sensor[2][members + k]);
  const __m512d q0 = _mm512_loadu_pd(array.form_coefficients(0) + k);
  const __m512d q1 = _mm512_loadu_pd(array.form_coefficients(1) + k);
  const __m512d q2 = _mm512_loadu_pd(array.form_coefficients(2) + k);
  const __m512d q3 = _mm512_loadu_pd(array.form_coefficients(3) + k);
  const __m512d q4 = _mm512_loadu_pd(array.form_coefficients(4) + k);
  const __m512d q5 = _mm512_loadu_pd(array.form_coefficients(5) + k);
  return q0 * a * a + q1 * b * b + q2 * c * c + q3 * a * b + q4 * a * c + q5 * b * c;
}

PLUMB_AVX512 PLUMB_WITHIN bool replace_eight(__m512d square, double g_mps2, std::int32_t* slots,
                                             std::int64_t* sums) noexcept {
  const __m256i old = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(slots));
  if (_mm256_movemask_ps(_mm256_castsi256_ps(old)) != 0) return false;
  const __m512d length = _mm512_maskz_sqrt_pd(kAll, _mm512_maskz_max_pd(kAll, _mm512_setzero_pd(), square));
  const __m512i error = _mm512_castpd_si512(_mm512_abs_pd(length - _mm512_set1_pd(g_mps2)));
  // Without a sign, doubles are ordered as their bits are, a NaN behind all: the other units do this.
  const __m512i most = _mm512_castpd_si512(_mm512_set1_pd(kMost_mps2));
  const __m512d held = _mm512_castsi512_pd(_mm512_maskz_min_epu64(kAll, error, most)) + _mm512_set1_pd(kUnitsLast_mps2);
  const __m256i now = _mm512_maskz_cvtepi64_epi32(kAll, _mm512_castpd_si512(held));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(slots), now);
  const __m512i more = _mm512_maskz_cvtepi32_epi64(kAll, _mm256_sub_epi32(now, old));
  _mm512_storeu_si512(sums, _mm512_add_epi64(_mm512_loadu_si512(sums), more));
  return true;
}

PLUMB_AVX2 PLUMB_WITHIN int replace_fours(const SensorArray& array, const double* y_mps2, double g_mps2,
                                          std::int32_t* slots, std::int64_t* sums, TripleRange range) noexcept {
  const size_t members = members_from(range.end), end = static_cast<size_t>(range.end);
  auto k = static_cast<size_t>(range.first);
  __m256d square = squares_of_four(array, y_mps2, members, k);
  if (kTripleCapacity >= 8 && k + 8 <= end) {
    __m256d next = squares_of_four(array, y_mps2, members, k + 4);
    for (; k + 12 <= end; k += 4) {
      const __m256d after = squares_of_four(array, y_mps2, members, k + 8);
      if (!replace_four(square, g_mps2, slots + k, sums + k)) return static_cast<int>(k);
      square = next;
      next = after;
    }
    if (!replace_four(square, g_mps2, slots + k, sums + k)) return static_cast<int>(k);
    square = next;
    k += 4;
  }
  return static_cast<int>(replace_four(square, g_mps2, slots + k, sums + k) ? k + 4 : k);
}

PLUMB_AVX2 int by_fours(const SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots,
                        std::int64_t* sums, TripleRange range) noexcept {
  if (range.first + 4 <= range.end) range.first = replace_fours(array, y_mps2, g_mps2, slots, sums, range);
  return by_twos(array, y_mps2, g_mps2, slots, sums, range);
}

PLUMB_AVX512 PLUMB_WITHIN int replace_eights(const SensorArray& array, const double* y_mps2, double g_mps2,
                                             std::int32_t* slots, std::int64_t* sums, TripleRange range) noexcept {
  const size_t members = members_from(range.end), end = static_cast<size_t>(range.end);
  auto k = static_cast<size_t>(range.first);
  constexpr size_t kSecond = kCapacity > 8 ? 8 : 0, kThird = kCapacity > 16 ? 16 : 0;
  const Eights y = {_mm512_loadu_pd(y_mps2), _mm512_loadu_pd(y_mps2 + kSecond), _mm512_loadu_pd(y_mps2 + kThird)};
  __m512d square = squares_of_eight(array, y, members, k);
  if (k + 16 <= end) {
    __m512d next = squares_of_eight(array, y, members, k + 8);
    for (; k + 24 <= end; k += 8) {
      const __m512d after = squares_of_eight(array, y, members, k + 16);
      if (!replace_eight(square, g_mps2, slots + k, sums + k)) return static_cast<int>(k);
      square = next;
      next = after;
    }
    if (!replace_eight(square, g_mps2, slots + k, sums + k)) return static_cast<int>(k);
    square = next;
    k += 8;
  }
  return static_cast<int>(replace_eight(square, g_mps2, slots + k, sums + k) ? k + 8 : k);
}

PLUMB_AVX512 int by_eights(const SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots,
                           std::int64_t* sums, TripleRange range) noexcept {
  if (range.first + 8 <= range.end) range.first = replace_eights(array, y_mps2, g_mps2, slots, sums, range);
  return by_fours(array, y_mps2, g_mps2, slots, sums, range);
}
#endif

}  // namespace

int replace_side_by_side(const SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots,
                         std::int64_t* sums, TripleRange range, Lanes lanes) noexcept {
#if PLUMB_WIDE_LANES
  if (kTripleCapacity >= 8 && lanes == Lanes::eight) return by_eights(array, y_mps2, g_mps2, slots, sums, range);
  if (lanes >= Lanes::four) return by_fours(array, y_mps2, g_mps2, slots, sums, range);
#else
  (void)lanes;
#endif
  return by_twos(array, y_mps2, g_mps2, slots, sums, range);
}

}  // namespace PLUMB_ABI
}  // namespace plumb

// NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
