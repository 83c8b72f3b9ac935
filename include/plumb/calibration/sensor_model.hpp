/// `SensorModel`: what channel i means in m/s^2, the paper's model complete.
#pragma once

#include <array>

#include "plumb/array/geometry.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Scale factor and bias of one sensor as cubics in (T_S - T_C), eqs (1) and (2).
struct SensorCoefficients {
  std::array<double, 4> scale{1.0, 0.0, 0.0, 0.0};  ///< SF, SFT1..3: raw unit per m/s^2 [per degC^k]; SF != 0
  std::array<double, 4> bias{};                     ///< B, BT1..3 [m/s^2 per degC^k]
  double reference_degc = 25.0;                     ///< T_C, the calibration temperature

  static constexpr auto fields() noexcept {
    return field_list(&SensorCoefficients::scale, &SensorCoefficients::bias,
                      not_stored(&SensorCoefficients::reference_degc));
  }
};

/// Which way the sensors count. Inside plumb the vector is gravity, positive down.
enum class Reads : signed char { gravity = 1, specific_force = -1 };

struct SensorModel {
  int size = 0;
  Reads reads = Reads::gravity;
  std::array<SensorCoefficients, kCapacity> sensor{};
  /// m_ik of `apply`, row-major [i * kCapacity + k]. Zero in the common-frame form that calibration
  /// yields (misalignment is then in the axes of the calibrated array), so that no reading depends on
  /// another channel and an excluded channel cannot leak.
  std::array<double, std::size_t{kCapacity} * kCapacity> misalignment{};

  double scale_at(int i, double temperature_degc) const noexcept;  ///< SF*_i
  double bias_at(int i, double temperature_degc) const noexcept;   ///< B*_i [m/s^2]

  /// Accelerations along the sensor axes in the gravity sense [m/s^2]: eq (3), then the sign of
  /// `reads`. Entries of sensors that are not in `delivered` are 0 and do not enter the cross terms; NaN where SF* is
  /// 0.
  Readings apply(const std::array<double, kCapacity>& raw, double temperature_degc, SensorSet delivered) const noexcept;

  /// `apply` for a model in the common-frame form; what stands in `misalignment` is not looked at.
  Readings without_misalignment(const std::array<double, kCapacity>& raw, double temperature_degc,
                                SensorSet delivered) const noexcept;

  /// The inverse of `apply`: raw values that a sensor with these coefficients shows for the given
  /// accelerations along its axes (gravity sense). Error: not_invertible if I - M is singular.
  Expected<std::array<double, kCapacity>> raw_from(const Readings& accel_mps2, double temperature_degc) const noexcept;

  /// Scale factors and biases alone change in flight.
  static constexpr auto fields() noexcept {
    return field_list(not_stored(&SensorModel::size), not_stored(&SensorModel::reads), per_sensor(&SensorModel::sensor),
                      not_stored(&SensorModel::misalignment));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
