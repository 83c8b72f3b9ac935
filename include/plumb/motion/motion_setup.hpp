/// What a moving tool's sensors may be off by while they are healthy. Every figure is a bound, not a standard
/// deviation, but for `noise`: limits in motion are sums of bounds (docs/motion.md, theorem T11).
#pragma once

#include <array>
#include <cstdint>

#include "plumb/array/geometry.hpp"
#include "plumb/array/sensor_array.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Most sensors that are judged in motion: sets of four are tested one by one.
inline constexpr int kMotionCapacity = kCapacity < 12 ? kCapacity : 12;
/// Most faults at once that are searched for.
inline constexpr int kMotionDepth = 4;
/// Gyro triads that can be compared with each other.
inline constexpr int kGyros = 2;

/// Bounds of one accelerometer.
struct MotionErrors {
  double lever_m = 0.0;        ///< of each component of its stated position
  double lag_s = 0.0;          ///< skew against the others, and what its bandwidth differs from theirs by, as a time
  double rectification = 0.0;  ///< shift of the mean per mean square of the reading [(m/s^2) / (m/s^2)^2]
  double scale = 0.0;          ///< relative
  double axis_rad = 0.0;       ///< turn of the axis
  double bias_mps2 = 0.0;
};

/// Bounds of a gyro triad.
struct GyroErrors {
  double scale = 0.0;     ///< relative
  double axis_rad = 0.0;  ///< turn of each axis
  double bias_radps = 0.0;
  double noise_radps = 0.0;  ///< 1 sigma of a sample
  double lag_s = 0.0;        ///< against the accelerometers
};

/// Ten times the largest `rate_bound_radps`: a rate beyond it is none, no gyro gives more.
inline constexpr double kMostRate_radps = 1e4;
/// Some 1000 g. Nothing that navigates reads more, and the square of more would widen a sensor's own limits beyond any
/// reading (REQ-202, T11: a limit that the fault itself raises).
inline constexpr double kMostReading_mps2 = 1e4;
/// What a healthy triad's rates may be off by in scale and axes, relative to their length as measured. Three axes that
/// turn by `axis_rad` each are off by up to sqrt(2) times that together.
double relative_error(const GyroErrors& bounds) noexcept;

/// Samples of the blocks of four scales: 1 first, then multiples of the one before, the last at most kLongestBlock. The
/// third is that of `MotionVerdict::block`.
inline constexpr int kMotionScales = 4;
using BlockSamples = std::array<int, kMotionScales>;
inline constexpr BlockSamples kMotionSamples{1, 4, 32, 256};
inline constexpr int kLongestBlock = 4096;

/// All that a `MotionMonitor` is told beside the array, whose sigmas are the noise of a sample and whose chips are what
/// fails at once.
struct MotionSetup {
  double sample_period_s = 0.001;
  std::array<Vec3, kCapacity> lever_arm_m{};  ///< from the reference point, tool frame
  std::array<MotionErrors, kCapacity> errors{};
  int gyros = 0;  ///< triads in `MotionSample`, 0 to 2
  /// The host knows by other means that the gyro is right, as an estimator does that compares several. Else a single
  /// gyro is one more unit that may have failed.
  bool gyro_corroborated = false;
  GyroErrors gyro;
  double rate_bound_radps = 0.0;    ///< the fastest that the tool turns, 0 = unknown
  double force_bound_mps2 = 160.0;  ///< the largest specific force that it feels, averaged over two blocks
  double false_alarms_per_hour = 1e-3;
  double dwell_s = 0.064;         ///< a sensor is excluded once it has been isolated for so long
  double quiet_s = 5.0;           ///< rejected sets are forgotten after so long without a new one
  int max_faults = kMotionDepth;  ///< units at once; never more than the geometry allows
  /// Blocks of fewer samples are not judged, and no force is published of them. More than 1 where chips have clocks of
  /// their own and are interpolated to a common one: of a few samples vibration makes what no lag accounts for.
  int shortest_block = 1;
  BlockSamples block_samples = kMotionSamples;
};

/// One reading of all accelerometers and gyros at one instant.
struct MotionSample {
  double time_s = 0.0;
  Readings reading_mps2{};  ///< specific force along each axis, calibrated
  SensorSet delivered;      ///< those with a reading
  /// Those at full scale: the true specific force is no less than the reading, or no more where that is below zero.
  SensorSet clipped;
  std::array<Vec3, kGyros> rate_radps{};
  std::array<bool, kGyros> rate_given{};
  // What interpolation to this instant adds at most: `MotionClocks` states it. 0 where a reading is a sample.
  Readings interpolation_mps2{};
  std::array<double, kGyros> interpolation_radps{};  ///< of the length of the rate
};

/// Errors: too_few_sensors, too_many_sensors (limit kMotionCapacity); out_of_range and not_finite, with the value, the
/// bound that it broke, and index = the sensor, or 100 and more for what concerns no sensor: sample_period_s 100,
/// gyros, gyro.scale 102, axis_rad, bias_radps, noise_radps, lag_s 106, rate_bound_radps, force_bound_mps2 108,
/// false_alarms_per_hour, dwell_s 110, quiet_s, max_faults 112, shortest_block (1 to
/// block_samples[2]) 113, and 114 + k for block_samples[k], which is no multiple of the one before.
Expected<void> check(const SensorArray& array, const MotionSetup& setup) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
