/// How many triples the kernel takes side by side. Every lane does what one triple alone does, in the same order, and
/// nothing is fused: the same bits, however many there are. The processor is asked at every sample, which costs less
/// than a nanosecond and needs no state.
#pragma once

#include <cstdint>

#include "plumb/array/geometry.hpp"
#include "plumb/core/config.hpp"

/// More than two at a time: on x86-64 under Linux, where GCC and Clang compile one function for another processor.
#if defined(__x86_64__) && defined(__gnu_linux__)
#define PLUMB_WIDE_LANES 1  // NOLINT(cppcoreguidelines-macro-usage): the preprocessor omits what does not compile
#else
#define PLUMB_WIDE_LANES 0  // NOLINT(cppcoreguidelines-macro-usage)
#endif

namespace plumb {
inline namespace PLUMB_ABI {

/// One: processors of 32 bits, which have no registers for more. Two: any other. Four: AVX2. Eight: AVX-512.
enum class Lanes : std::uint8_t { one, two, four, eight };

/// What every processor can that this is compiled for.
inline constexpr Lanes kPortableLanes = sizeof(void*) >= 8 ? Lanes::two : Lanes::one;

/// The most that this processor has, and that there can be triples for.
inline Lanes most_lanes() noexcept {
#if PLUMB_WIDE_LANES
  if (kTripleCapacity >= 8 && __builtin_cpu_supports("avx512f")) return Lanes::eight;
  if (__builtin_cpu_supports("avx2")) return Lanes::four;
#endif
  return kPortableLanes;
}

/// Triples `first` up to `end`, without `end`: one register, so that every parameter below goes in one.
struct TripleRange {
  int first;
  int end;
};

/// One row of the window is the errors of all triples in one slot of the ring, and the sums that they are part of. Puts
/// the errors of `range` in place of those in the row, as many at a time as `lanes` says and the rest by fewer, two at
/// least, as long as all that are taken at once had a value before. Returns the first triple that is not done.
/// `range.end` is how many triples the array has. Before the readings `y_mps2` stand so many zeros as there are sensors
/// fewer than fit.
int replace_side_by_side(const SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots,
                         std::int64_t* sums, TripleRange range, Lanes lanes) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
