/// How far a sensor may have drifted since it was calibrated: one statement of the integrator behind the limits, the
/// isolation, the protection level and the bounds of a recalibration.
#pragma once

#include <array>
#include <cmath>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Of one sensor, 1 sigma of what its reading is off by anywhere within +-G, beyond what the calibration says it
/// may be. All four add up. All zero: not stated, nothing is allowed for, and the verdict says so
/// (`Qualifier::stability_unstated`).
struct Stability {
  double mps2 = 0.0;                   ///< since the calibration, however long ago
  double per_day_mps2 = 0.0;           ///< more for every day since
  double per_degc_mps2 = 0.0;          ///< more for every degree away from the sensor's reference temperature
  double per_degc_per_min_mps2 = 0.0;  ///< more for every degree a minute: the sensor lags behind its thermometer

  bool stated() const noexcept {
    return mps2 > 0.0 || per_day_mps2 > 0.0 || per_degc_mps2 > 0.0 || per_degc_per_min_mps2 > 0.0;
  }
  static constexpr auto fields() noexcept {
    using S = Stability;
    return field_list(&S::mps2, &S::per_day_mps2, &S::per_degc_mps2, &S::per_degc_per_min_mps2);
  }
};

/// tau, the hard tolerance in limits and protection level, is so many sigmas of the stability: within it, whatever the
/// signs, no healthy set is rejected. Beyond it is one sensor in 16 000, and then the others are not at theirs.
inline constexpr double kStabilitySigmas = 4.0;
/// Largest figure of a `Stability`, as a rule a mistaken unit [m/s^2]; longest time since a calibration.
inline constexpr double kMostStability_mps2 = 10.0;
inline constexpr double kMostDaysSinceCalibration = 36525.0;

/// Checks one sensor's figures: not negative, finite, at most `kMostStability_mps2`. Error: not_finite or out_of_range
/// (index = sensor; value, limit).
Expected<void> checked(const Stability& stability, int sensor) noexcept;

/// The same with the days since the calibration taken in, and in single precision: what a monitor keeps.
struct StabilityNow {
  float mps2 = 0.0F, per_degc_mps2 = 0.0F, per_degc_per_min_mps2 = 0.0F;

  static StabilityNow of(const Stability& stability, double days) noexcept {
    return {static_cast<float>(stability.mps2 + days * stability.per_day_mps2),
            static_cast<float>(stability.per_degc_mps2), static_cast<float>(stability.per_degc_per_min_mps2)};
  }
  /// `away_degc` from the reference temperature, at `rate_degc_per_min`, both of either sign and finite.
  float tolerance_mps2(double away_degc, double rate_degc_per_min) const noexcept;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
