/// `plumb calibrate --array TOOL.toml#GROUP --motion`: gyros aligned by motion and by gravity's turns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/session/log_spec.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// What only a calibration of gyros takes.
struct GyroOptions {
  std::vector<std::string> turns, held_out, without;

  /// The first of them that was given; null: none.
  const char* given() const;
};

/// What it shares with the rest of the command.
struct CalibrateGyrosOptions {
  std::string array;        ///< with its group
  std::string calibration;  ///< of the accelerometers; empty: none
  session::LogSpec log;     ///< in motion
  std::string out, date, serial;
  bool json = false;
};

void add_gyro_options(const Options& command, GyroOptions& options);

io::ExitCode run_calibrate_gyros(const GyroOptions& own, const CalibrateGyrosOptions& options);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
