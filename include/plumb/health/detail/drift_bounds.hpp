/// How far a recalibration may move biases and scales: from those in force, from those of the commissioning
/// calibration, and per hour. Without the second, small accepted steps would add up without limit.
#pragma once

#include <array>

#include "plumb/array/sensor_array.hpp"
#include "plumb/calibration/sensor_model.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/error.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// How far a sensor may have drifted since it was calibrated, 1 sigma. The defaults are for sensors whose stability
/// no array file states: the yearly repeatability of a borehole servo accelerometer with margin. MEMS need more.
struct DriftSigmas {
  double bias_mps2 = 2e-3 * kG0_mps2;
  double scale = 5e-4;  ///< relative

  static constexpr auto fields() noexcept { return field_list(&DriftSigmas::bias_mps2, &DriftSigmas::scale); }
};

/// The same for every sensor.
inline std::array<DriftSigmas, kCapacity> alike(const DriftSigmas& drift) noexcept {
  std::array<DriftSigmas, kCapacity> out{};
  out.fill(drift);
  return out;
}

/// A change of W (= scale times axis) and b of every sensor, four numbers each.
struct RowChange {
  std::array<double, std::size_t{4} * kCapacity> of{};

  /// The change may be wrong, all of it together: it is one more uncertainty, of 1 sigma.
  void doubt(const SensorArray& array, RowUncertainty& uncertainty) const noexcept;
};

/// What a recalibration changes in a model: the length of a sensor's scale and its bias. The axes are held.
struct CoefficientChange {
  std::array<double, kCapacity> length{};      ///< new scale over the one in force
  std::array<double, kCapacity> shift_mps2{};  ///< what is added to the bias, before the new scale

  void write(SensorSet sensors, SensorModel& model) const noexcept;
  /// If the old coefficients were right after all, the new ones err by exactly this: scale along the axis, and bias.
  RowChange on_rows(SensorSet sensors, const SensorArray& array) const noexcept;

  static constexpr auto fields() noexcept {
    using C = CoefficientChange;
    return field_list(per_sensor(any(&C::length)), per_sensor(any(&C::shift_mps2)));
  }
};

class DriftBounds {
 public:
  /// In units of the drift sigma: against the calibration in force, against the commissioning one, and per hour since
  /// the last adoption, of which an adoption may always use a quarter.
  static constexpr double kLastSigmas = 3.0;
  static constexpr double kCommissioningSigmas = 5.0;
  static constexpr double kSigmasPerHour = 1.0;
  static constexpr double kLeastHours = 0.25;

  void begin(const SensorModel& commissioning, const std::array<DriftSigmas, kCapacity>& drift) noexcept;
  /// The coefficients of `model` become those of commissioning.
  void commission(const SensorModel& model) noexcept;
  void note_adoption(double time_s, bool in_flight) noexcept;

  const DriftSigmas& sigma(int i) const noexcept { return drift_[static_cast<std::size_t>(i)]; }
  bool adopted() const noexcept { return adopted_; }  ///< a fit in flight, since the commissioning calibration
  /// `implausible` (index = sensor) where the change is beyond a bound. A length that was read back is tried before it
  /// is divided by.
  Error check(const CoefficientChange& change, SensorSet sensors, const SensorModel& model,
              double time_s) const noexcept;
  /// Whether these coefficients can be in force: only what the bounds have let pass.
  bool allow(const SensorModel& model) const noexcept;

  /// A model with the coefficients of the commissioning calibration, temperature terms left alone.
  SensorModel commissioned(const SensorModel& like) const noexcept;
  bool commissioned_as(const SensorModel& model) const noexcept;

 private:
  /// Of two coefficients of sensor i, the larger difference in its drift sigma; not a number where either is none.
  double sigmas_off(int i, double scale_ratio, double bias_change_mps2) const noexcept;

  std::array<DriftSigmas, kCapacity> drift_{};
  std::array<double, kCapacity> scale_{}, bias_mps2_{};  ///< of the commissioning calibration
  double adopted_s_ = 0.0;
  bool adopted_ = false;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using B = DriftBounds;
    return field_list(not_stored(&B::drift_), per_sensor(any(&B::scale_)), per_sensor(any(&B::bias_mps2_)),
                      &B::adopted_s_, &B::adopted_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
