/// `RateMonitor`: which of redundant gyro axes may be trusted, in motion and at rest, and the rate of those that may.
///
/// Single-axis gyros on one rigid body measure y = H w + e as accelerometers measure specific force, so the parity of
/// motion (docs/theory.md, T11) serves them as it stands: `MotionMonitor` with rates in the place of forces. No lever
/// arm and no other gyro enters. What differs is what is known of the vector: of a rate not even its length, but at
/// rest it is near zero (`RateSetup::at_rest_radps`, the Earth's). So n axes, each a unit of its own, isolate up to
/// n - 4 faults by parity. At rest each axis is held against zero too: that tells which of those it is that parity
/// suspects, where the axes are too few to tell. It holds while the tool does not turn at rest and fail at once.
///
/// Plain data, no heap, no clock; `step` is total over all bit patterns.
#pragma once

#include <array>
#include <limits>

#include "plumb/motion/motion_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What the Earth turns by [rad/s].
inline constexpr double kEarthRate_radps = 7.2921159e-5;

/// Bounds of one healthy gyro axis, in motion.
struct RateErrors {
  double scale = 0.0;     ///< relative
  double axis_rad = 0.0;  ///< turn of the axis
  double bias_radps = 0.0;
  double lag_s = 0.0;  ///< skew against the others, and what its bandwidth differs from theirs by, as a time
  double g_sensitivity_s_per_m = 0.0;  ///< shift of the reading per specific force [(rad/s) / (m/s^2)]
};

/// All that a `RateMonitor` is told beside the array, whose sigmas are the noise of a sample of each axis [rad/s] and
/// whose chips are what fails at once.
struct RateSetup {
  double sample_period_s = 0.001;
  std::array<RateErrors, kCapacity> errors{};
  double rate_bound_radps = 40.0;           ///< the fastest that the tool turns, averaged over two blocks; above 0
  double force_bound_mps2 = 160.0;          ///< the largest specific force, where a sample does not say it
  double at_rest_radps = kEarthRate_radps;  ///< the fastest that the tool turns while it is said to be at rest
  double false_alarms_per_hour = 1e-3;
  double dwell_s = 0.064;         ///< an axis is excluded once it has been isolated for so long
  double quiet_s = 5.0;           ///< rejected sets are forgotten after so long without a new one
  int max_faults = kMotionDepth;  ///< units at once; never more than the geometry allows
  BlockSamples block_samples = kMotionSamples;
};

/// One reading of all gyro axes at one instant.
struct RateSample {
  double time_s = 0.0;
  Readings rate_radps{};  ///< along each axis, calibrated
  SensorSet delivered;
  SensorSet clipped;         ///< those at full scale
  double force_mps2 = -1.0;  ///< length of the specific force, for g-sensitivity; below 0 or not finite: unknown
  bool at_rest = false;      ///< the host knows that the tool stands still, from its accelerometers above all
};

/// Tool frame, a triangle-weighted mean over two adjacent blocks, as `SpecificForce`.
struct AngularRate {
  ForceValidity validity = ForceValidity::none;
  double time_s = 0.0, span_s = 0.0;
  Vec3 rate_radps{};
  Mat3 covariance_rad2ps2{};                                     ///< of the noise alone
  double bound_radps = std::numeric_limits<double>::infinity();  ///< of the length of the error; infinite: none
  SensorSet used;
};

struct RateVerdict {
  AngularRate sample;  ///< of the last two samples
  AngularRate block;   ///< of the last two blocks of `block_samples[2]` samples
  bool block_ended = false;
  bool alarm = false;
  SensorSet suspects;  ///< in some of the smallest explanations
  SensorSet isolated;  ///< in every explanation, or off zero at rest; not excluded yet
  SensorSet excluded;  ///< provisionally, by parity
  /// Suspected by parity, and read a rate in the last block at rest that no healthy axis does; out of service until one
  /// in which they do not.
  SensorSet off_at_rest;
  /// Axes were off zero in the last block at rest, and parity suspects none of them: the tool turned, or a fault is too
  /// small for parity. Nobody is blamed.
  bool turned_at_rest = false;
  MotionCause cause = MotionCause::none;
};

class RateMonitor {
 public:
  /// Errors: those of `check` of plumb/motion/motion_setup.hpp, with the same indices; out_of_range and not_finite with
  /// index 120 at_rest_radps and 121 force_bound_mps2; and of an axis's g_sensitivity_s_per_m.
  Expected<void> configure(const SensorArray& array, const RateSetup& setup) noexcept;
  const RateVerdict& step(const RateSample& sample) noexcept;
  const RateVerdict& verdict() const noexcept { return verdict_; }
  /// Takes back exclusions and evidence.
  void forget() noexcept;

 private:
  void watch_rest(const RateSample& sample) noexcept;
  void judge_rest() noexcept;

  /// A block of samples at rest in a row.
  struct Rest {
    int samples = 0;
    SensorSet delivered;
    Readings sum_radps{};
    double largest_force_mps2 = 0.0;
    double last_s = 0.0;
  };

  MotionMonitor parity_;
  SensorArray array_;
  RateSetup setup_;
  RateVerdict verdict_;
  Rest rest_;
  double rest_quantile_ = 0.0;
  bool configured_ = false;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
