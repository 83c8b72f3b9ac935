/// `plumb calibrate --motion`: lever arms, lags and rectification from a log in motion, added to a calibration.
#pragma once

#include <string>

#include "plumb/session/calibration_pipeline.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct CalibrateMotionOptions {
  std::string array;
  std::string calibration;
  session::LogSpec log;  ///< in motion
  std::string out;
  std::string date;
  bool json = false;
};

io::ExitCode run_calibrate_motion(const CalibrateMotionOptions& options);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
