/// From logs of a tool in motion to the calibration of a group of its gyros, or to why there is none: what
/// `plumb calibrate --array TOOL.toml#GROUP --motion` does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/commission/gyro_common.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/gyro_calibration.hpp"
#include "plumb/session/log_spec.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

struct GyroCommissioningLogs {
  LogSpec motion;                     ///< the tool rests, then turns about all axes
  std::vector<std::string> held_out;  ///< of the same gyros; none: the last third of `motion`
  std::vector<std::string> turns;     ///< from rest to rest in many attitudes; none: axes stay relative
  /// Of the accelerometers, by which gravity turns; null: their datasheet, which `turns` do not take.
  const io::CalibrationFile* accelerometers = nullptr;
  bool delay = true;  ///< fit the delay of each axis
  bool force = true;  ///< and its g-sensitivity
};

/// What the calibrated axes differ by in one log.
struct GyroCheck {
  std::string name;
  std::uint64_t rows = 0;
  commission::GyroResidual all;   ///< at any rate
  commission::GyroResidual fast;  ///< above half of the fastest that `rate_bound_radps` allows, or that the log has
  double fast_radps = 0.0;
  bool alarm = false;  ///< the monitor contradicts it
  double alarm_s = 0.0;
  SensorSet alarm_axes;
};

/// What the square of a residual is made of, by regression on that of the rate and its slope.
struct GyroLimit {
  double noise_radps = 0.0;                         ///< what does not change with the motion
  double timing_s = 0.0;                            ///< rms: as if every sample were taken so much early or late
  double relative = 0.0;                            ///< rms: as if every reading were off by this part
  double timing_share = 0.0, relative_share = 0.0;  ///< of the mean square
};

struct GyroCommissioning {
  /// Why it is not accepted, and what to do; empty: it is.
  std::string refusal, next;
  std::uint64_t rows = 0, fitted_rows = 0;
  double duration_s = 0.0;
  int rests = 0, rests_turned = 0;  ///< stretches at rest, and those that the gyros contradict
  double rest_s = 0.0;
  double bias_scatter_radps = 0.0;  ///< from stretch to stretch
  std::optional<commission::GyroFit> fit;
  GyroCheck fitted;
  std::vector<GyroCheck> held_out;
  GyroLimit limit;
  double lag_factor = 1.0;  ///< by which the fitted log needs more than three sigma
  int turns = 0, turns_held_out = 0;
  std::optional<commission::CommonMatrix> common;
  double common_part = 0.0;  ///< of the bound of a rate, while the axes are relative; infinite: none is stated
  io::GyroCalibration found;
};

/// Errors: files that cannot be read. `group` is a rate group of `tool`.
io::FileExpected<GyroCommissioning> run_gyro_commissioning(const io::ArrayFile& tool, const io::ArrayFile& group,
                                                           const GyroCommissioningLogs& logs);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
