/// What the monitor decides by, with a given calibration and configuration: its limits in units of a sensor's bias,
/// what longer blocks would bring, and what a given delta_F hides.
#pragma once

#include "plumb/gravity/gravity.hpp"
#include "plumb/health/monitor_config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Attitudes that are looked at, spread evenly.
inline constexpr int kSearchedAttitudes = 100;

/// A test at an attitude: what noise and what the systematic errors add to its limit, and the bias of one sensor that
/// stands at the limit. Medians over attitudes [m/s^2]; bias of the sensor that the test sees worst.
struct TestLimit {
  double noise_mps2 = 0.0, systematic_mps2 = 0.0, bias_mps2 = 0.0;
};

struct MonitorLimits {
  int sensors = 0, window = 0;
  TestLimit parity;  ///< all zero with three sensors
  TestLimit length;
  TestLimit triple;         ///< the triple with the widest limit, its `bias_mps2` zero
  double noise_mps2 = 0.0;  ///< of one sample of a sensor, rms over the sensors
  /// What calibration leaves, 1 sigma as parity sees it in its worst direction (three sensors: as the length does), rms
  /// over attitudes.
  double left_mps2 = 0.0;
  double tolerance_mps2 = 0.0;  ///< drift that the limits allow for, of the sensor for which most
  int untold = 0;               ///< sensors of which no drift is allowed for
  /// (noise / left)^2: blocks beyond it do not make a test of one attitude sharper. 0 where calibration leaves nothing.
  double useful_samples = 0.0;
  double delta_f_mps2 = 0.0;  ///< given limit of the triples, 0 = none
  /// Bias of one sensor that every triple passes at `delta_f_mps2` without noise: at half of the attitudes at least
  /// this much for some sensor, at the worst of them ...
  double blind_median_mps2 = 0.0, blind_worst_mps2 = 0.0;
  double blind_tilt_rad = 0.0;  ///< ... and the largest error of direction under such a bias, none excluded
};

/// `array` is the calibrated one, `tolerance_mps2` the drift of each sensor that is allowed for. Faults up to 2 g0.
MonitorLimits monitor_limits(const SensorArray& array, const GravityReference& gravity, const MonitorConfig& config,
                             const Readings& tolerance_mps2 = {});

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
