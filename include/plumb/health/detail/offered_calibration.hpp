/// A calibration that the host brings: what is taken from it, biases and scales, and how sure it is of them. Axes and
/// temperature coefficients stay those in force.
#pragma once

#include <array>

#include "plumb/health/detail/drift_bounds.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class OfferedCalibration {
 public:
  /// The axes must be those in force but for so much: five sigmas of the commissioning calibration, or this where that
  /// claims to be better.
  static constexpr double kAxis_rad = 2e-4;
  static constexpr double kLife_s = 24.0 * 3600.0;  ///< on trial no longer than that

  void clear() noexcept { take(0, 0.0); }
  bool any() const noexcept { return sensors_ > 0; }
  /// Keeps the covariance of the offered biases and scales, and writes the change that they make of those in force;
  /// `take` keeps the rest. Errors: not_calibrated, implausible, as `Recalibration::offer` says.
  Error read(const SensorModel& now, const SensorArray& now_array, const SensorModel& model, const SensorArray& array,
             SensorSet sensors, const DriftBounds& bounds, CoefficientChange& change) noexcept;
  void take(int sensors, double time_s) noexcept {
    sensors_ = sensors;
    made_s_ = time_s;
  }
  bool lapsed(double time_s) const noexcept {
    const double waited_s = time_s - made_s_;
    return !(waited_s >= 0.0 && waited_s <= kLife_s);
  }
  /// Axes of `sensors` as sure as they were in `array`; biases and scales as sure as the offer says, whose tests have
  /// confirmed it. What the two share is not known here and omitted.
  void uncertainty(const SensorArray& array, SensorSet sensors, RowUncertainty& out) const noexcept;
  /// What was read back can only be what `read` has let pass.
  bool plausible(int configured, SensorSet sensors, const DriftBounds& bounds) const noexcept;

 private:
  static constexpr int kSize = kCapacity * (2 * kCapacity + 1);
  double variance(int parameter) const noexcept;
  Error check(const SensorArray& now_array, const SensorArray& array, int i, const DriftBounds& bounds) const noexcept;

  int sensors_ = 0;  ///< of the array whose calibration was offered; 0 = none was
  double made_s_ = 0.0;
  std::array<double, kSize> covariance_{};  ///< of scale and bias per sensor, lower triangle by rows

  friend struct FieldsOf;
  int size() const noexcept { return sensors_ * (2 * sensors_ + 1); }
  static constexpr auto fields() noexcept {
    using O = OfferedCalibration;
    return field_list(within(&O::sensors_, 0, kCapacity), plumb::any(&O::made_s_),
                      counted(plumb::any(&O::covariance_), &O::size));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
