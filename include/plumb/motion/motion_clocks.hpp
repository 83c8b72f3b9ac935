/// Chips with clocks of their own: readings that each chip stamps by its own clock are brought to common instants, and
/// what clocks and interpolation may add is in the limits of a `MotionMonitor` (docs/motion.md, theorem T14).
#pragma once

#include "plumb/motion/motion_setup.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Clocks that can be told apart: every sensor may have its own.
inline constexpr int kMotionClocks = kMotionCapacity;
/// Samples of a chip that are kept.
inline constexpr int kClockSamples = 64;
/// Times beyond it are refused: a double no longer tells microseconds apart.
inline constexpr double kMostTime_s = 1e10;

/// One clock, and what is sampled by it. The common time of a sample stamped s is
///   s - offset_s - rate (s - since_s),
/// off by at most offset_bound_s + rate_bound |s - since_s|.
struct MotionClock {
  SensorSet sensors;
  std::array<bool, kGyros> gyro{};
  double sample_period_s = 0.001;  ///< of the chip; each step within a tenth of it
  double offset_s = 0.0;           ///< by which it is ahead of the common clock at `since_s`
  double rate = 0.0;               ///< which it gains beside, in seconds per second
  double since_s = 0.0;            ///< by this clock
  double valid_s = 3600.0;  ///< before and after `since_s` the bounds hold for so long; readings beyond it are refused
  double offset_bound_s = 0.0;
  double rate_bound = 0.0;
};

struct ClockSetup {
  int clocks = 0;
  std::array<MotionClock, static_cast<std::size_t>(kMotionClocks)> clock{};
  /// A chip that has not delivered so long after an instant is left out of it. From 5 to 40 sample periods of each
  /// chip: three samples beyond the instant must have come.
  double wait_s = 0.01;
};

/// Errors: out_of_range and not_finite with the value and the bound that it broke; index = the sensor that belongs to
/// no clock or to two, 100 and more as in `check` of a MotionSetup, 150 plus the gyro that belongs to none or to two,
/// 198 wait_s, 199 clocks, and 200 + 10 k + field for clock k: sample_period_s 0, offset_s, rate 2, since_s, valid_s 4,
/// offset_bound_s, rate_bound 6, and 7 for offset_bound_s + rate_bound valid_s, which may be one common period.
Expected<void> check(const SensorArray& array, const MotionSetup& setup, const ClockSetup& clocks) noexcept;

/// Makes array and set-up those of a monitor that `MotionClocks` feeds: lags grow by what the clocks may be off by, and
/// noise by what interpolation makes of it. Apply it once. Errors: those of both `check`, and nothing has changed.
Expected<void> with_clocks(const ClockSetup& clocks, SensorArray& array, MotionSetup& setup) noexcept;

/// What became of a sample.
enum class ClockPush : std::uint8_t {
  taken,
  began_anew,  ///< taken; the samples before it are forgotten: a sample is missing, or the clock has jumped
  not_configured,
  unknown_clock,
  not_finite,    ///< no time, or one beyond kMostTime_s
  out_of_order,  ///< too early after the last one, or its time again: nothing has changed
  not_valid      ///< further from `since_s` than `valid_s`: state the clock anew
};
const char* to_string(ClockPush push) noexcept;

///   plumb::with_clocks(clocks, array, setup);
///   monitor.configure(array, setup);  // and chips.configure(array, setup, clocks) with those before
///   ...
///   chips.push(k, sample);            // whenever chip k has delivered; sample.time_s by its clock
///   plumb::MotionSample common;
///   while (chips.next(now_s, common)) use(monitor.step(common));
///
/// Plain data, no heap, no clock; `push` and `next` are total over all bit patterns.
class MotionClocks {
 public:
  /// `setup.sample_period_s` is that of the common instants. Errors: those of `check`.
  Expected<void> configure(const SensorArray& array, const MotionSetup& setup, const ClockSetup& clocks) noexcept;
  /// A sample of one chip: of `sample` only what belongs to that clock counts.
  ClockPush push(int clock, const MotionSample& sample) noexcept;
  /// After the clock has been compared with the common one again. Errors: out_of_range and not_finite as `check`, and
  /// nothing has changed.
  Expected<void> set_clock(int clock, double offset_s, double rate, double since_s) noexcept;
  /// The next common instant, as soon as all chips have delivered around it or `wait_s` has passed since. `now_s`: the
  /// common time. Call it until it returns false. Sensors that cannot be interpolated are not in `delivered`.
  bool next(double now_s, MotionSample& out) noexcept;

 private:
  static constexpr auto kSlots = static_cast<std::size_t>(kClockSamples);
  static constexpr auto kSensors = static_cast<std::size_t>(kMotionCapacity);
  /// The samples of one clock; number k is in slot k modulo kSlots.
  struct Ring {
    std::uint64_t first = 0, end = 0;  ///< numbers that are kept
    std::array<double, kSlots> time_s{};
    std::array<SensorSet, kSlots> delivered{}, clipped{};
    std::array<std::uint8_t, kSlots> rates{};  ///< bits: gyros
  };
  /// Of one instant between two samples of a clock.
  struct Place {
    bool enclosed = false;
    std::uint64_t number = 0;  ///< of the last sample before it
    std::array<double, 4> weight{};
    double product_s4 = 0.0;  ///< of the distances to the four samples
  };
  void keep(std::size_t clock, double time_s, const MotionSample& sample) noexcept;
  void bend(std::size_t clock) noexcept;
  bool passed(const Ring& ring, double time_s) const noexcept;
  Place place(const Ring& ring, double time_s) const noexcept;
  void draw(std::size_t clock, double time_s, MotionSample& out) const noexcept;
  void draw_sensor(const Ring& ring, const Place& at, double lag_s, std::size_t sensor,
                   MotionSample& out) const noexcept;
  void draw_gyro(const Ring& ring, const Place& at, double lag_s, std::size_t gyro, MotionSample& out) const noexcept;
  double more(double fourth, double second, const Place& at, double lag_s) const noexcept;

  ClockSetup setup_;
  std::array<double, static_cast<std::size_t>(kMotionClocks)> lag_s_{};
  std::array<Ring, static_cast<std::size_t>(kMotionClocks)> ring_{};
  std::array<std::array<double, kSlots>, kSensors> reading_mps2_{};
  std::array<std::array<double, kSlots>, kSensors> fourth_mps6_{};  ///< divided differences of five samples about it
  std::array<std::array<Vec3, kSlots>, kGyros> rate_radps_{};
  std::array<std::array<double, kSlots>, kGyros> fourth_radps5_{};
  double period_s_ = 0.0;
  double origin_s_ = 0.0;
  std::uint64_t drawn_ = 0;  ///< instants since `origin_s_`
  bool begun_ = false;
  bool configured_ = false;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
