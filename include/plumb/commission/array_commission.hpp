/// From the fit of an array to bounds for `MotionMonitor`, and what the monitor says with them of a stretch of samples.
#pragma once

#include "plumb/commission/array_fit.hpp"
#include "plumb/motion/motion_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

/// Beside `kBoundSigmas` standard deviations: floors, for what changes from one run to the next and one recording
/// cannot show. Fixed before any recording was judged.
struct ArrayBoundRule {
  double lever_m = 2e-4;
  double lag_s = 5e-6;
  double lag_factor = 1.5;  ///< times the lag that the recording needs beyond what was fitted
  double rectification = 2e-6;
  GyroErrors gyro{0.002, 0.002, 0.001, 0.0, 1e-5};
};

struct ArrayBounds {
  std::array<Vec3, kCapacity> lever_arm_m{};
  std::array<double, kCapacity> lever_m{}, lag_s{}, rectification{};
  GyroErrors gyro;
};

/// Bounds from the fit. Arms are corrected by it; what else it found is not taken off readings, and is in the bounds.
ArrayBounds bounds_of(const ArrayOnBoard& on_board, const ArrayFit& fit, const std::vector<MotionSample>& samples,
                      const ArrayBoundRule& rule = {});

/// 1 sigma of a sample of a gyro: from the difference of two, from a single one with what it turns from sample to
/// sample.
double gyro_noise_radps(const std::vector<MotionSample>& samples, int gyros);

/// What the monitor came to in samples of [first, end), from anew.
struct Replay {
  std::size_t judged = 0;
  bool alarm = false;
  double alarm_s = 0.0;  ///< the first one
  SensorSet suspects;    ///< of all alarms
  SensorSet isolated;
  bool gyros_disagree = false;
  double gyros_disagree_s = 0.0;  ///< the first time
};
Replay replayed(const SensorArray& array, const MotionSetup& setup, const std::vector<MotionSample>& samples,
                std::size_t first, std::size_t end);

/// The least lag of all sensors with which the monitor finds no contradiction, to a part in a hundred, where those of
/// the setup are the least to begin with; negative: none is enough.
double lag_needed_s(const SensorArray& array, const MotionSetup& setup, const std::vector<MotionSample>& samples,
                    std::size_t first, std::size_t end);

/// How readings scatter from sample to sample, by what no force explains, in stated sigmas: about 1 or more; less where
/// the log was filtered.
double scatter_in_sigmas(const SensorArray& array, const std::vector<MotionSample>& samples);

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
