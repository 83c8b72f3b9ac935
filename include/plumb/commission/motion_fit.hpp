/// Commissioning of units for `MotionMonitor` by what they read in motion: scale, axis and bias of every accelerometer,
/// lever arm and skew of every unit, against the first unit, by least squares on the parity of block pairs.
#pragma once

#include "plumb/commission/motion_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

/// Standard deviations of what is known beforehand, for every unit against the first; and the blocks that are fitted.
struct FitSettings {
  int scale = 2;       ///< index of kMotionSamples: blocks of 32 samples; shorter ones where gyros are rarely given
  double axis = 0.03;  ///< of each component of a row against the mounting by the gyros: scale and axis, relative
  double bias_mps2 = 2.0;
  double arm_m = 0.3;
  double lag_s = 0.01;  ///< of the accelerometers against the unit's own gyro
};

/// y = row . (f + Omega arm) + bias + lag dy/dt for each of the three accelerometers.
struct FittedUnit {
  Mat3 rows{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vec3 bias_mps2{};
  Vec3 arm_m{};  ///< from the first unit, its frame
  double lag_s = 0.0;
  // Standard deviations, scaled by what the fit leaves.
  Mat3 rows_sigma{};  ///< of scale on the unit's own axis, of turns across it
  Vec3 bias_sigma_mps2{};
  Vec3 arm_sigma_m{};
  double lag_sigma_s = 0.0;
  Vec3 model_sigma_mps2{};  ///< of rows and bias together, the largest among the forces that the fit has seen
};

struct MotionFit {
  std::vector<FittedUnit> unit;  ///< the first one is the reference: exact
  int block_pairs = 0;
  double residual_mps2 = 0.0;  ///< rms of a reading's parity residual in the fit's block pairs
};

/// Least squares on the block pairs of an aligned log in which gyros are given and no force is clipped. Refused where
/// the motion leaves something open: the text names it.
CommissionExpected<MotionFit> fit_motion(const MotionLog& aligned_log, const std::vector<UnitAlignment>& alignment,
                                         const FitSettings& settings = {});

/// The same with other logs: rms of a reading's parity residual in block pairs of `scale` (an index of
/// kMotionSamples).
double residual_of(const MotionLog& aligned_log, const MotionFit& fit, int scale, bool with_arms = true);

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
