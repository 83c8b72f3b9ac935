/// What is known of the sensors before gravity has spoken: nominal axes, nominal coefficients, noise,
/// and how far the truth may lie from them (the prior of the fit).
#pragma once

#include <array>

#include "plumb/calibration/sensor_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// A sensor must reach gravity times (1 + this) beside its bias, else it clips when it points along it.
inline constexpr double kFullScaleMargin = 0.05;

/// 1-sigma of the datasheet values, per sensor.
struct Prior {
  double bias_mps2 = 0.02 * 9.80665;
  double scale = 0.02;      ///< relative
  double axis_rad = 0.035;  ///< about each of the two directions across the axis (2 deg)
  /// Of the coefficients of (T_S - T_C)^k, k = 1..3 [m/s^2 per degC^k]: `temperature_fit.hpp` alone estimates them.
  std::array<double, 3> bias_t_mps2{1e-4 * 9.80665, 1e-6 * 9.80665, 2e-8 * 9.80665};
  std::array<double, 3> scale_t{2e-4, 2e-6, 3e-8};  ///< the same, relative to the scale [per degC^k]

  static constexpr auto fields() noexcept {
    using P = Prior;
    return field_list(&P::bias_mps2, &P::scale, &P::axis_rad, &P::bias_t_mps2, &P::scale_t);
  }
};

struct DatasheetSensor {
  SensorRow row;                    ///< id, nominal axis, noise of one sample
  SensorCoefficients coefficients;  ///< nominal
  Prior prior;
  double full_scale_raw = 0.0;  ///< |raw| at and beyond which the channel is clipped; 0 = unknown
  double resolution_raw = 0.0;  ///< one code; 0 = unknown

  static constexpr auto fields() noexcept {
    using D = DatasheetSensor;
    return field_list(&D::row, &D::coefficients, &D::prior, &D::full_scale_raw, &D::resolution_raw);
  }
};

struct Datasheet {
  int size = 0;
  Reads reads = Reads::gravity;
  std::array<DatasheetSensor, kCapacity> sensor{};

  SensorModel model() const noexcept;            ///< nominal coefficients, no misalignment
  Expected<SensorArray> array() const noexcept;  ///< nominal axes, checked
  /// What the priors leave in every reading, stated as if a calibration had left it: the sensors apart from each other.
  RowUncertainty uncertainty() const noexcept;

  static constexpr auto fields() noexcept {
    using D = Datasheet;
    return field_list(within(&D::size, 0, kCapacity), not_stored(&D::reads), &D::sensor);
  }
};

/// The other way round: of sensor i of an array with such an uncertainty. Temperature terms are not in it.
Prior prior_in(const SensorArray& array, int i) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
