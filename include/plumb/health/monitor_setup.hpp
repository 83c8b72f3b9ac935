/// What a monitor is built from, and what is refused before it is built.
///
///   plumb::MonitorSetup setup;
///   setup.array = calibration.array;                         // axes with their uncertainty, from a calibration
///   setup.model = calibration.model;                         // scales and biases
///   setup.gravity = *plumb::normal_gravity({latitude_deg});  // where the tool works
///   setup.stability.fill({0.001, 0.0, 0.0, 0.0});            // drift since then, 1 sigma [m/s^2], from the datasheet
#pragma once

#include <array>

#include "plumb/calibration/calibration.hpp"
#include "plumb/health/monitor_config.hpp"
#include "plumb/health/stability.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Everything a monitor is built from.
struct MonitorSetup {
  SensorModel model;  ///< of an accepted calibration, common-frame form
  SensorArray array;  ///< calibrated axes with their uncertainty
  GravityReference gravity;
  MonitorConfig config;
  std::array<double, kCapacity> full_scale_raw{};  ///< 0 = unknown
  std::array<double, kCapacity> resolution_raw{};  ///< one code: within it a reading may repeat; 0 = unknown
  Mat3 output_frame{1, 0, 0, 0, 1, 0, 0, 0, 1};    ///< tool frame -> output frame, applied to published vectors only
  std::array<Vec3, kCapacity> lever_arm_m{};       ///< of each sensor from the axis of rotation, tool frame
  bool lever_arms_known = false;                   ///< else evidence is locked out while the tool turns
  /// False: there is no calibration yet, the monitor makes its own (`set_datasheet`). Model and axes are then the
  /// datasheet's, and the array's uncertainty is how far a sensor may be from it, 1 sigma.
  bool calibrated = true;
  std::array<Stability, kCapacity> stability{};  ///< how far each sensor may have drifted since the calibration
  /// Since the calibration was made. The monitor has no calendar: the host passes it at every power-on. A snapshot does
  /// not hold it.
  double days_since_calibration = 0.0;
};

/// A monitor that is to calibrate itself: fills in model, array, ranges and codes, and says `calibrated = false`.
/// Errors: those of `Datasheet::array`.
Expected<void> set_datasheet(const Datasheet& datasheet, MonitorSetup& setup) noexcept;

/// A length of gravity in feet, in g0 or from elsewhere would make every healthy sensor look off. Error:
/// implausible_gravity outside what `given_gravity` takes.
Expected<void> plausible(const GravityReference& gravity) noexcept;

/// Checks a setup but for its configuration. Errors: too_few_sensors; not_calibrated; range_too_small; out_of_range
/// (index = sensor whose sigma is too large beside the least, whose full scale or code is negative, or whose scale is
/// 0); not_finite (index = sensor of whose coefficients, range, code, lever arm or stability one is no number);
/// out_of_range of a stability (index = sensor) and of the days since the calibration (index -1), which must be 0 where
/// there is none; implausible_gravity; frame_not_orthogonal; implausible where the uncertainty of the rows is no
/// covariance, and where there is no calibration (index = sensor of whose bias, scale or axis the uncertainty is below
/// `Recalibration::kLeastOpen` or beyond `Recalibration::kMostOpen`: value, limit); may_accelerate where there is no
/// calibration and an acceleration is allowed for (value = the bound [m/s^2]).
Expected<void> checked(const MonitorSetup& setup) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
