/// What an array file states for a monitor of motion: [motion], [gyro], [[clock]], and the bounds of each sensor. What
/// it does not state stays empty, and the session says which key is missing. Contract: docs/array-file.md, "Motion".
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "plumb/motion/motion_clocks.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Of one accelerometer while it is healthy: its own keys, else those of [motion].
struct MotionBounds {
  std::optional<double> lever_arm_m;             ///< of each component of `lever_arm_m`
  std::optional<double> lag_s;                   ///< skew, and what the bandwidths differ by, as a time
  std::optional<double> rectification_per_mps2;  ///< of the mean square of the reading
  std::optional<double> scale;                   ///< these three follow from calibration and stability where empty
  std::optional<double> axis_rad;
  std::optional<double> bias_mps2;
};

/// [gyro]: the triad whose rates `[input] rotation_radps` names, or a [[group]] of redundant gyros in its place.
struct GyroSpec {
  bool stated = false;
  std::string group;  ///< of gyros of the same file; of the bounds here only `lag_s` counts then
  std::optional<double> scale, axis_rad, bias_radps, noise_radps, lag_s;
  bool corroborated = false;  ///< the host knows by other means that it is right
};

/// [[clock]]: a chip, gyros or both that sample by a clock of their own.
struct ClockSpec {
  std::string name;    ///< in reports: the package, else the gyro
  std::string column;  ///< of the log: the time by this clock
  std::optional<double> sample_period_s;
  MotionClock clock;  ///< all but the sample period, which may be that of [motion]
};

struct MotionSpec {
  bool stated = false;     ///< there is a table [motion]
  bool mentioned = false;  ///< some key of motion is given; without [motion] it has no effect
  std::optional<double> sample_period_s;
  std::optional<double> rate_bound_radps;
  std::optional<double> velocity_bound_mps;  ///< stated: the inclination in motion is wanted
  double inclination_window_s = 10.0;
  MotionSetup limits;  ///< force_bound_mps2, false_alarms_per_hour, dwell_s, quiet_s, max_faults; else as it is made
  GyroSpec gyro;
  std::vector<ClockSpec> clocks;  ///< at most kMotionClocks; what names none is on the time of the log
  std::optional<double> clock_wait_s;
  std::array<MotionBounds, kCapacity> sensor{};
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
