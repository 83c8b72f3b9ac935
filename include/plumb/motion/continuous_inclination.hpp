/// Inclination while the tool moves: of an axis of the tool, from the specific force that `MotionMonitor` publishes,
/// over a window in which the tool may rotate (theorem T13 of docs/theory.md). It is an interval, and as wide as the
/// stated bounds make it; where they allow none it says why.
#pragma once

#include <cstdint>
#include <limits>

#include "plumb/core/units.hpp"
#include "plumb/motion/motion_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What is stated beside the `MotionSetup`. Two bounds have no default, for nothing shows them: state 0 where it is
/// true.
struct InclinationSetup {
  Vec3 axis{0.0, 0.0, 1.0};  ///< unit length, tool frame; along the hole and downwards for a drilling tool
  /// How far the axis that is meant may be from `axis`. Gravity does not show how the axes of the sensors sit in the
  /// housing (docs/theory.md, section 1.6).
  double axis_bound_rad = std::numeric_limits<double>::quiet_NaN();
  /// Within a window the velocity of the reference point differs from some constant velocity by no more: vibration,
  /// whirl, changes of the rate of penetration. Vibration beyond half the sample rate must not reach the samples.
  double velocity_bound_mps = std::numeric_limits<double>::quiet_NaN();
  double window_s = 10.0;
  double gravity_mps2 = kG0_mps2;
  double gravity_bound_mps2 = 0.05;  ///< of what is stated as gravity; 0.05 covers all of the Earth's surface
};

enum class InclinationStatus : std::uint8_t {
  filling,              ///< the first window is not full
  known,                ///< the interval holds
  no_force,             ///< a block came without a bounded force: the window begins anew
  rate_unknown,         ///< no gyro delivered at some sample: likewise
  irregular_time,       ///< a block is missing: likewise
  contradicts_gravity,  ///< the force is larger than gravity and the bounds allow: one of the stated bounds is wrong
};
const char* to_string(InclinationStatus status) noexcept;

/// What makes the interval wide.
enum class InclinationTerm : std::uint8_t {
  force,     ///< the bound of the specific force
  velocity,  ///< what the velocity may have changed by over the window
  turn,      ///< the velocity, where the axis turns
  gravity,
  alignment  ///< the axis in the tool
};
const char* to_string(InclinationTerm term) noexcept;

/// Of the last full window. The angle is that whose cosine is the mean cosine of the inclination over the window, so at
/// some instant of it the axis stood so.
struct InclinationInterval {
  InclinationStatus status = InclinationStatus::filling;  ///< the figures below count with `known` alone
  double time_s = 0.0;                                    ///< the middle of the window
  double span_s = 0.0;                                    ///< its length
  double inclination_rad = 0.0;                           ///< 0 to pi, against gravity
  double low_rad = 0.0;                                   ///< it lies between this
  double high_rad = 0.0;                                  ///< and this
  bool gyro_assumed = false;  ///< it holds while the only gyro is healthy: nothing corroborates that one
  InclinationTerm widest = InclinationTerm::force;  ///< the largest part of the interval
};

/// Plain data, no heap, no clock; `step` is total over all bit patterns.
class ContinuousInclination {
 public:
  /// Errors: those of `check` for the motion; out_of_range and not_finite with index 200 (axis, its length), 201
  /// (axis_bound_rad, 0 to pi), 202 (velocity_bound_mps, 0 to 100), 203 (window_s, 128 sample periods to 600 s), 204
  /// (gravity_mps2, 1 to 30), 205 (gravity_bound_mps2, 0 to 0.5).
  Expected<void> configure(const SensorArray& array, const MotionSetup& motion, const InclinationSetup& setup) noexcept;
  /// Once a sample, with what the monitor said of it. True where a window has ended: `interval` is new, or says why
  /// there is none.
  bool step(const MotionSample& sample, const MotionVerdict& verdict) noexcept;
  const InclinationInterval& interval() const noexcept { return interval_; }

 private:
  /// Of the window so far.
  struct Sums {
    int pairs = 0;            ///< of blocks
    double force_mps2 = 0.0;  ///< along the axis, summed over the pairs, as is the next
    double bound_mps2 = 0.0;
    double first_s = 0.0, last_s = 0.0;  ///< middles of the first and the last pair
    double across_radps = 0.0;           ///< the rate across the axis, summed over the samples
    double most_radps = 0.0;             ///< and the largest
    double samples = 0.0;
    bool gyro_assumed = false;
  };
  /// Of one block.
  struct Turning {
    double across_radps = 0.0;
    double most_radps = 0.0;
    double samples = 0.0;
    bool known = true;  ///< some gyro delivered at every sample
    bool gyro_assumed = false;
  };
  void turn(const MotionSample& sample) noexcept;
  bool begin_anew(InclinationStatus why) noexcept;
  bool take(const SpecificForce& pair) noexcept;
  void add(const SpecificForce& pair) noexcept;
  bool publish() noexcept;

  InclinationSetup setup_;
  GyroErrors gyro_;
  int gyros_ = 0;
  bool gyro_corroborated_ = false;
  double block_s_ = 0.0;        ///< of `MotionVerdict::block`
  double block_samples_ = 0.0;  ///< likewise
  InclinationInterval interval_;
  Sums window_;
  Turning filling_, last_;     ///< the block at hand, and the one before it
  double before_radps_ = 0.0;  ///< across the axis, in the sample before
  bool configured_ = false;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
