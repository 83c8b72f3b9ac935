/// What a group of gyros is judged with: readings, axes and bounds by the datasheet in the array file, or by a
/// calibration.
#pragma once

#include "plumb/io/array_file.hpp"
#include "plumb/io/gyro_calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

struct RateGroup {
  SensorModel model;
  SensorArray array;
  RateSetup setup;
  /// What the rate of all axes together may be off by beside, relative to its length: the scale, shear and turn that
  /// gyros alone do not tell. 0 by the datasheet, whose bounds hold for each axis, and where gravity's turns told it;
  /// infinite where nothing bounds it.
  double common = 0.0;
  bool calibrated = false;
};

/// `calibration` null: by the datasheet. Else readings are corrected for scale and bias, axes are those found, bounds
/// those of the calibration and what `[group.rate] stability` allows the biases since. Delays and g-sensitivity are not
/// taken off: they are in the bounds. Errors: rows that make no array.
io::FileExpected<RateGroup> rate_group(const io::ArrayFile& group, const io::GyroCalibration* calibration = nullptr);

/// A bound of the length of the error of `rate_radps` with the common part of `group`.
double with_common_part(const RateGroup& group, double rate_radps, double bound_radps) noexcept;

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
