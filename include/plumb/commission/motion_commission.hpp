/// From a log in motion to what `MotionMonitor` is configured with: array, lever arms, and a bound for everything that
/// the fit leaves.
#pragma once

#include "plumb/commission/motion_fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

/// What bounds are made of: a multiple of the standard deviations, and no less than the floors, which stand for what
/// one recording cannot show: what changes from one run to the next.
struct BoundRule {
  double factor = 3.0;  ///< one in 400 beyond it for a normal error; several bounds add up in every limit
  double scale = 0.002;
  double axis_rad = 0.002;
  double bias_mps2 = 0.03;  ///< temperature, and vibration other than that of the recording
  double lever_m = 0.001;
  double lag_factor = 1.5;        ///< times the lag that the recording needs
  double lag_periods = 1.0;       ///< units on clocks of their own: between two samples vibration may do anything
  int shortest_block = 1;         ///< of `MotionSetup`: with 32 the recording needs less lag where clocks differ
  double noise_mps2 = 0.0;        ///< of a sample at rest; 0: as much as would leave what the fit leaves in blocks
  double rate_bound_radps = 0.0;  ///< of `MotionSetup`, for samples without a gyro
  GyroErrors gyro{0.01, 0.01, 0.01, 0.0, 0.001};
};

struct CommissionSettings {
  AlignmentLimits alignment;
  FitSettings fit;
  BoundRule bounds;
};

struct MotionCommissioning {
  std::vector<UnitAlignment> alignment;
  MotionFit fit;
  SensorArray array;          ///< sensors in the order of the units, in the first unit's frame
  MotionSetup setup;          ///< reference point: the middle of the units; chips: the units
  double lag_needed_s = 0.0;  ///< the least that explains every reading of the recording

  /// A log brought to one clock by an alignment of its own: delays change from run to run, mountings do not.
  MotionLog aligned(const MotionLog& log, const std::vector<UnitAlignment>& clocks) const;
  /// Sample k of such a log as the monitor takes it.
  MotionSample sample(const MotionLog& aligned_log, std::size_t k) const;
};

/// Errors: those of `align_by_gyros` and `fit_motion`.
CommissionExpected<MotionCommissioning> commission_motion(const MotionLog& log,
                                                          const CommissionSettings& settings = {});

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
