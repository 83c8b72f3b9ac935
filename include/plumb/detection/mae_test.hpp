/// Limits of the mean absolute error of a triple: given (the paper's delta_F), or computed from noise, geometry and
/// what is systematic (docs/theory.md, section 2.3).
#pragma once

#include <limits>

#include "plumb/array/sensor_array.hpp"
#include "plumb/core/config.hpp"
#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// The triples that may raise an alarm.
int voting_triples(const SensorArray& array) noexcept;

/// What is asked of each monitored triple so that all of them together alarm at most at `false_alarm_rate` per block.
/// The triples of n sensors share n readings, so together they stay below it: at 70 to 84 % of it for the paper's four
/// sensors, 52 to 63 % for eight (1 to 32 samples, rates 1e-3 and 1e-4).
double triple_share(const SensorArray& array, double false_alarm_rate) noexcept;

/// Limit of the MAE of one triple at one block [m/s^2].
struct MaeLimit {
  double mean_mps2 = 0.0;        ///< what healthy noise shows on average; 0 against a given limit
  double noise_mps2 = 0.0;       ///< s_T q(N, rate), or delta_F
  double systematic_mps2 = 0.0;  ///< calibration, gravity, motion inside the block

  double limit_mps2() const noexcept { return noise_mps2 + systematic_mps2; }
  /// 1 at the limit, 0 at the healthy mean: else "0.7 of the limit" would be noise itself. Where there is no room
  /// between them, as by three sensors that read zero, anything is beyond.
  double ratio(double mae_mps2) const noexcept {
    const double room_mps2 = limit_mps2() - mean_mps2;
    if (room_mps2 == 0.0) return std::numeric_limits<double>::infinity();
    return (mae_mps2 - mean_mps2) / room_mps2;
  }
  /// Below this a MAE is clean: a part of the noise limit with the systematic part whole.
  double clear_mps2(double fraction) const noexcept {
    return mean_mps2 + fraction * (noise_mps2 - mean_mps2) + systematic_mps2;
  }
};

/// Computed limit over a window of `window` samples. `triple` is the test of the triple's three sensors at `block`,
/// `quantile` = half_normal_mean_quantile(window, rate of this triple).
MaeLimit computed_mae_limit(const SetTest& triple, const BlockEvidence& block, int window, double quantile) noexcept;
MaeLimit given_mae_limit(double delta_f_mps2) noexcept;

/// The computed limit without its systematic part: a MAE that is clean by it is clean by the whole limit, for a tenth
/// of the work. Not for a triple without rank 3.
MaeLimit least_mae_limit(const SensorArray& array, const Triple& triple, const BlockEvidence& block, int window,
                         double quantile) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
