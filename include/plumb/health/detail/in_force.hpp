/// What the readings are judged by: the calibration that was accepted last, gravity, and what the sensors in service
/// make of both.
#pragma once

#include "plumb/array/geometry.hpp"
#include "plumb/calibration/sensor_model.hpp"
#include "plumb/gravity/gravity.hpp"
#include "plumb/health/transition_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct InForce {
  SensorModel model;
  SensorArray array;
  GravityReference gravity;
  double store_g_mps2 = 0.0;  ///< gravity when the store of stations was last empty
  /// Calibrated span: as configured, else that of the stations of the monitor's own calibration.
  double temperature_min_degc = 0.0, temperature_max_degc = 0.0;
  SensorSet calibrated;           ///< whose calibration has been accepted; no other serves
  bool three_sensor_fit = false;  ///< that calibration is one that no fourth sensor could check

  /// Before a first calibration has been accepted there is the datasheet alone.
  bool owes_calibration() const noexcept { return kCalibratesItself && calibrated.empty(); }

  static constexpr auto core() noexcept { return field_list(&InForce::calibrated, &InForce::three_sensor_fit); }
  static constexpr auto fields() noexcept {
    using I = InForce;
    return field_list(&I::model, &I::array, &I::gravity, &I::store_g_mps2, &I::temperature_min_degc,
                      &I::temperature_max_degc, &I::calibrated, &I::three_sensor_fit);
  }
};

/// What the sensors in service make up together: follows from their set and the axes in force.
struct Service {
  LeastSquares map;
  SizeClass size = SizeClass::rank_lost;

  static constexpr auto fields() noexcept { return field_list(not_stored(&Service::map), not_stored(&Service::size)); }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
