/// What `plumb monitor` was asked to do, and which of it makes no sense together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/session/calibration_pipeline.hpp"
#include "plumb/session/incident_recorder.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct MonitorOptions {
  std::string array;
  std::string calibration;
  bool calibrate_first = false;
  session::LogSpec log{"-", io::BadRowPolicy::stop, false};
  std::string events;
  std::string verdicts;
  std::string report;
  std::string motion;
  std::string inclination;
  session::IncidentSettings incidents;  ///< no directory: none are recorded
  std::string date;                     ///< of the run; empty: today
  std::string snapshot_in;
  std::string roll_test;
  std::string snapshot_out;
  std::vector<std::string> host;
  std::vector<std::string> groups;  ///< "mag=mag.json", "gyros"
  /// Stands before each line of the table where several groups share it; empty: the array is watched alone.
  std::string label;
  bool every_sample = false;
  bool limits = false;
  bool json = false;
};

/// The options on the command line, and what `--help` says at its end.
void add_monitor_options(const Options& command, MonitorOptions& options);

std::optional<io::FileError> follow_misuse(const MonitorOptions& options);
/// One of the two: a calibration, or a monitor that makes its own.
std::optional<io::FileError> calibration_misuse(const MonitorOptions& options);
std::optional<io::FileError> snapshot_misuse(const MonitorOptions& options, const io::ArrayFile& array);
/// What --roll-test cannot be, and what it cannot be combined with.
std::optional<io::FileError> roll_test_misuse(const MonitorOptions& options, const io::ArrayFile& array);
std::optional<io::FileError> motion_misuse(const MonitorOptions& options);
std::optional<io::FileError> incidents_misuse(const MonitorOptions& options);
/// In paper mode delta_f decides alone, by coefficients of its own for each triple.
io::FileError limits_of_paper(const io::ArrayFile& array);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
