/// The rate of a tool from a group of redundant gyros, row by row, right whichever gyro fails: for a monitor of motion
/// in the place of `[input] rotation_radps`, whose one gyro is one more unit that may have failed.
#pragma once

#include <limits>
#include <vector>

#include "plumb/motion/median_rate.hpp"
#include "plumb/session/rate_group.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

struct ToolRate {
  bool given = false;  ///< enough triads deliver to outvote the faulty ones
  Vec3 rate_radps{};   ///< tool frame
  /// Of the length of the error, while no more units are faulty than `faults`: scale, axes, bias, g-sensitivity, noise
  /// and what calibration leaves in common. Lags are not in it: `GroupRates::lag_bound_s`.
  double bound_radps = std::numeric_limits<double>::infinity();
  int triads = 0;  ///< that deliver
};

/// Axes are made into triads: each chip of three axes or more that span space is one; axes of no chip are put together
/// three by three. A unit that fails spoils the triads that it is in, so 2 k + 1 triads outvote `faults` units that
/// spoil k at most (`median_rate`; docs/theory.md, T15).
class GroupRates {
 public:
  /// Of noise that a sample of a triad stays within.
  static constexpr double kNoiseSigmas = 5.0;

  /// Errors: too few triads, with how many there are and what to do.
  static io::FileExpected<GroupRates> make(const RateGroup& group, int faults = 1);

  /// A row, calibrated by `RateGroup::model` (`rate_sample`); axes that do not deliver, are at full scale or read no
  /// number take their triad out of the vote. `excluded`: axes known to have failed; they vote no more where enough
  /// triads are left without them.
  ToolRate step(const RateSample& sample, SensorSet excluded = {}) const noexcept;

  /// What the rate is late or early by at most, as a time: `MotionSetup::gyro.lag_s` in its place, beside what all
  /// gyros are late by against the accelerometers. A rate that changes by a [rad/s^2] is off by a times this.
  double lag_bound_s() const noexcept { return lag_s_; }
  int triads() const noexcept { return static_cast<int>(triad_.size()); }
  /// Axes that are in no triad.
  SensorSet left_out() const noexcept { return left_out_; }

 private:
  struct Triad {
    SensorSet axes;
    std::vector<int> axis;
    std::vector<Vec3> solve;  ///< by axis: what its reading adds to the rate
    GyroErrors errors;        ///< of a component: scale, bias without g-sensitivity, noise, lag
    double per_force = 0.0;   ///< of a component [(rad/s) / (m/s^2)]
  };
  explicit GroupRates(const RateGroup& group) : group_(group) {}
  void add(const std::vector<int>& axes);
  void put_together(std::vector<int> loose);
  int spoiled_by_one() const;
  TriadRates rates_of(const RateSample& sample, SensorSet without) const noexcept;

  RateGroup group_;
  std::vector<Triad> triad_;
  SensorSet left_out_;
  int outvoted_ = 0;
  double lag_s_ = 0.0;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
