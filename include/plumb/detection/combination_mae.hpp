/// The paper's statistic: mean absolute error of the length of gravity from every triple over a
/// sliding window, exact for ever. Errors are held as integers of 2^-22 m/s^2, so that a sum
/// updated a billion times equals a fresh sum bit for bit, and a NaN cannot enter it.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/array/geometry.hpp"
#include "plumb/core/config.hpp"
#include "plumb/detection/detail/lanes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// One unit of the fixed-point errors [m/s^2], 2.4e-7: a power of two, so that the conversion is exact but for the
/// rounding to a whole number, and a multiplication.
inline constexpr double kMaeUnit_mps2 = 0x1p-22;
inline constexpr double kMaeUnits_per_mps2 = 0x1p22;
/// Largest error that is kept; larger ones (and non-finite ones) count as this, about 52 g0.
inline constexpr std::int32_t kMaeClamp = 2140000000;

/// Squared length of the vector that three readings make, by the six coefficients of their triple:
/// q0 a a + q1 b b + q2 c c + q3 a b + q4 a c + q5 b c, evaluated left to right in double. Its rounding error is
/// proved (proofs/rounding, proofs/form.g) for exactly this order without fused multiply-add (-ffp-contract=off),
/// so it stays as it is; `T` is a double, or several side by side: the proof then holds lane by lane. May be negative
/// by that error. [(m/s^2)^2]
template <class T>
constexpr T squared_length(T q0, T q1, T q2, T q3, T q4, T q5, T a, T b, T c) noexcept {
  return q0 * a * a + q1 * b * b + q2 * c * c + q3 * a * b + q4 * a * c + q5 * b * c;
}
inline double squared_length(const TripleForm& q, double a_mps2, double b_mps2, double c_mps2) noexcept {
  return squared_length(q[0], q[1], q[2], q[3], q[4], q[5], a_mps2, b_mps2, c_mps2);
}

/// Absolute error as an integer number of units, to the nearest, ties to even; clamped; a NaN becomes the clamp.
std::int32_t to_mae_units(double error_mps2) noexcept;

#if PLUMB_SINGLE
class NearLengths;
#endif

class CombinationMae {
 public:
  /// Empties everything; `window` 1 .. kWindowCapacity.
  void configure(int triples, int window) noexcept;
  /// Empties the window (gap, motion, change of calibration).
  void clear() noexcept;
  /// Empties only the window of the sensors in service (their set changed).
  void clear_all_sensor() noexcept;

  /// Adds one sample. Triples with a member outside `usable` are marked absent in this slot.
  /// `in_service` is the estimate of the sensors in service (null: slot absent).
  void add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const Vec3* in_service,
           double g_mps2) noexcept;
  /// The same with no more lanes than given, which the processor must have: for tests and benchmarks.
  void add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const Vec3* in_service, double g_mps2,
           Lanes lanes) noexcept;
#if PLUMB_SINGLE
  /// The same in single precision, but for triples with a member outside `near`. `all_units`: what becomes of the
  /// estimate of the sensors in service (-1: slot absent).
  void add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const NearLengths& lengths,
           const Differences& d_mps2, std::int32_t all_units, double g_mps2) noexcept;
#endif

  /// Eqs (26)-(29): MAE of triple k over the samples present in the window [m/s^2]; 0 where there are none.
  double triple_mps2(int k) const noexcept {
    return mean(sum_[static_cast<std::size_t>(k)], count_[static_cast<std::size_t>(k)]);
  }
  int triple_samples(int k) const noexcept { return count_[static_cast<std::size_t>(k)]; }
  /// Exact window sum of triple k in units, for checks.
  std::int64_t triple_sum(int k) const noexcept { return sum_[static_cast<std::size_t>(k)]; }
  std::int64_t fresh_triple_sum(int k) const noexcept;
  /// MAE of the sensors in service (eq 14) [m/s^2].
  double all_mps2() const noexcept { return mean(all_sum_, all_count_); }
  int all_samples() const noexcept { return all_count_; }
  int window() const noexcept { return window_; }
  /// Mean square difference of successive values of triple k over twice their variance: near 1 for white noise, near 0
  /// where each value is nearly the one before. Less than 0 where a value is missing or all are the same.
  double smoothness(int k) const noexcept;
  /// Whether it is that of so many triples and samples: no index then leads out of it.
  bool fits(int triples, int window) const noexcept {
    return triples_ == triples && window_ == window && head_ >= 0 && head_ < window && triples <= kTripleCapacity &&
           window <= kWindowCapacity;
  }
  /// Whether the sums and counts are those of the ring.
  bool holds() const noexcept;

 private:
  static double mean(std::int64_t sum, int count) noexcept {
    return count > 0 ? whole(sum) / count * kMaeUnit_mps2 : 0.0;
  }
  /// A sum as a double. A processor of 32 bits converts its halves in one instruction each, and the whole only by a
  /// routine; sums stay below 2^53, so that either way is exact.
  static double whole(std::int64_t sum) noexcept {
    static_assert(static_cast<double>(kMaeClamp) * kWindowCapacity < 9007199254740992.0);
    if constexpr (sizeof(void*) >= 8) return static_cast<double>(sum);
    const auto bits = static_cast<std::uint64_t>(sum);  // never negative
    return static_cast<double>(static_cast<std::uint32_t>(bits >> 32U)) * 4294967296.0 +
           static_cast<double>(static_cast<std::uint32_t>(bits));
  }
  void add_from(int first, Lanes lanes, const SensorArray& array, const Readings& y_mps2, SensorSet usable,
                double g_mps2) noexcept;
  void add_by(Lanes lanes, const SensorArray& array, const Readings& y_mps2, SensorSet usable, const Vec3* in_service,
              double g_mps2) noexcept;
  std::size_t row(int slot) const noexcept {
    return static_cast<std::size_t>(slot) * static_cast<std::size_t>(triples_);
  }
  static void replace(std::int32_t& slot, std::int32_t value, std::int64_t& sum, std::uint16_t& count) noexcept;

  // Slot-major, so that one sample touches one contiguous row; -1 = absent.
  std::array<std::int32_t, static_cast<std::size_t>(kTripleCapacity) * kWindowCapacity> ring_{};
  std::array<std::int64_t, kTripleCapacity> sum_{};
  std::array<std::uint16_t, kTripleCapacity> count_{};
  std::array<std::int32_t, kWindowCapacity> all_ring_{};
  std::int64_t all_sum_ = 0;
  std::uint16_t all_count_ = 0;
  std::uint16_t triples_ = 0;
  std::uint16_t window_ = 1;
  int head_ = 0;

  friend struct FieldsOf;
  int used_slots() const noexcept { return triples_ * window_; }
  void rebuild() noexcept;  ///< the sums, from the ring
  bool plausible() const noexcept { return head_ < window_; }
  static constexpr auto fields() noexcept {
    using C = CombinationMae;
    return field_list(counted(within(&C::ring_, -1, kMaeClamp), &C::used_slots), not_stored(&C::sum_),
                      not_stored(&C::count_), counted(within(&C::all_ring_, -1, kMaeClamp), &C::window),
                      not_stored(&C::all_sum_), not_stored(&C::all_count_), not_stored(&C::triples_),
                      not_stored(&C::window_), within(&C::head_, 0, kWindowCapacity - 1));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
