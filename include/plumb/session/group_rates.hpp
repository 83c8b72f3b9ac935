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
  /// Of the length of the error, while no more units are faulty than `faults`: scale, axes, bias, g-sensitivity, noise,
  /// what the gyros lag each other by, and what calibration leaves in common. What all of them lag the accelerometers
  /// by is not in it.
  double bound_radps = std::numeric_limits<double>::infinity();
  int triads = 0;       ///< that deliver
  bool begins = false;  ///< enough of them, but how the rate changes is not known yet: no rate is given
};

/// Axes are made into triads: each chip of three axes or more that span space is one; axes of no chip are put together
/// three by three. A unit that fails spoils the triads that it is in, so 2 k + 1 triads outvote `faults` units that
/// spoil k at most (`median_rate`; docs/theory.md, T15).
///
/// While fewer triads deliver but one of them at least is healthy, the rate is the middle between the extremes, and
/// half of what they differ by is in the bound.
///
/// A lag is no delay of the median, which may be a leading triad's at one sample and a lagging one's at the next: it is
/// in the bound of each sample by the angular acceleration, and that by what the triads change by from sample to
/// sample, judged as they are. It is taken to change in the next sample by no more than it did in the last one. So the
/// first two samples, and those after a gap, have no rate where a lag is stated.
class GroupRates {
 public:
  /// Of noise that a sample of a triad stays within.
  static constexpr double kNoiseSigmas = 5.0;

  /// Errors: too few triads, with how many there are and what to do.
  static io::FileExpected<GroupRates> make(const RateGroup& group, int faults = 1);

  /// A row, calibrated by `RateGroup::model` (`rate_sample`); axes that do not deliver, are at full scale or read no
  /// number take their triad out of the vote. `excluded`: axes known to have failed, which vote no more.
  ToolRate step(const RateSample& sample, SensorSet excluded = {}) noexcept;

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
  /// What triads say together, and what half of their differences adds where they cannot outvote each other.
  struct Together {
    bool given = false;
    Vec3 rate_radps{};
    double spread_radps = 0.0;
  };
  int spoiled_by_one() const;
  TriadRates rates_of(const RateSample& sample, SensorSet without) const noexcept;
  Together together(const TriadRates& rates) const noexcept;
  GyroErrors worst_errors(const RateSample& sample) const noexcept;
  double lag_error_radps(const TriadRates& rates, double time_s, const GyroErrors& worst) noexcept;

  RateGroup group_;
  std::vector<Triad> triad_;
  SensorSet left_out_;
  int outvoted_ = 0;
  double lag_s_ = 0.0;  ///< of the length of a rate
  TriadRates last_;     ///< of the sample before
  double last_s_ = std::numeric_limits<double>::quiet_NaN();
  double last_slope_radps2_ = std::numeric_limits<double>::infinity();
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
