/// A log of a tool with gyros and accelerometers, read whole for a fit of the gyros (private to this module).
#pragma once

#include <vector>

#include "plumb/commission/gyro_common.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/session/log_spec.hpp"
#include "plumb/session/motion_inputs.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// A stretch in which the accelerometers say that the tool stands still.
struct GyroRestStretch {
  std::size_t begin = 0, end = 0;  ///< samples of the log, `end` included
  Vec3 direction{};                ///< of the specific force, unit vector; 0: not known
  bool turned = false;             ///< the gyros contradict: it turned about the vertical, say
  std::vector<double> mean_radps;  ///< by axis; NaN where not given
};

struct GyroRecording {
  commission::GyroLog log;  ///< readings by the datasheet; NaN where an axis does not deliver or is at full scale
  double start_s = 0.0;     ///< time of its first sample
  std::vector<GyroRestStretch> rest;
  MotionInputs inputs;
  io::LogStatistics file;
};

/// Which log, and what of it.
struct GyroRecordingSpec {
  LogSpec log;
  const io::CalibrationFile* accelerometers = nullptr;  ///< null: those of the datasheet
  bool force = false;                                   ///< keep the specific force of every sample
};

/// Twice through the log: gyros, then accelerometers. Errors: those of the log, and more rows than fit.
io::FileExpected<GyroRecording> read_gyros(const io::ArrayFile& tool, const io::ArrayFile& group,
                                           const GyroRecordingSpec& spec);

/// From stretch to stretch, where the direction changes and no more than `kLongestTurn_s` is between them. `sigma_rad`:
/// of a direction; what biases, and noise of `noise_radps` a sample, integrate to is added.
std::vector<commission::GravityTurn> turns_of(const GyroRecording& recording, double sigma_rad, double bias_sigma_radps,
                                              double noise_radps);
inline constexpr double kLongestTurn_s = 30.0;

/// What follows: all samples at which nothing is given in between, so that no turn or slope leads over the seam.
void append(const GyroRecording& more, GyroRecording& to);

/// 1 sigma of the biases from stretch to stretch, of the axis in which it is largest; 0 with fewer than three.
double bias_scatter_radps(const GyroRecording& recording);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
