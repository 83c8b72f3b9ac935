#include "monitor_options.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

std::optional<io::FileError> follow_misuse(const MonitorOptions& options) {
  if (!options.log.follow || options.log.path != "-") return std::nullopt;
  return io::FileError{"--follow",
                       0,
                       "",
                       "standard input is followed anyway, until it is closed",
                       "leave --follow out, or name the file that grows with --log",
                       io::ExitCode::usage};
}

std::optional<io::FileError> calibration_misuse(const MonitorOptions& options) {
  if (options.calibrate_first == options.calibration.empty()) {
    if (!options.calibrate_first || !options.limits) return std::nullopt;
    return io::FileError{"--limits",
                         0,
                         "",
                         "tells the limits of a calibrated array, and there is no calibration yet",
                         "name one with --calibration",
                         io::ExitCode::usage};
  }
  return io::FileError{
      "--calibration",
      0,
      "",
      options.calibrate_first ? "and --calibrate-first are two ways to the same thing"
                              : "is missing, and without a calibration nothing that is published is valid",
      "name what plumb calibrate wrote with --calibration, or let the monitor calibrate itself first with "
      "--calibrate-first",
      io::ExitCode::usage};
}

std::optional<io::FileError> snapshot_misuse(const MonitorOptions& options, const io::ArrayFile& array) {
  const NamedFile named[] = {{"--snapshot-in", options.snapshot_in}, {"--snapshot-out", options.snapshot_out}};
  for (const NamedFile& file : named) {
    if (file.path.empty()) continue;
    if (file.path == "-") {
      return io::FileError{file.option,        0, "", "a snapshot is kept in a file, not in a pipe", "name a file",
                           io::ExitCode::usage};
    }
    if (array.monitor.mode == MonitorMode::paper) {
      return io::FileError{file.option,
                           0,
                           "",
                           "the paper's algorithm keeps no snapshot",
                           "leave the option out, or set mode = \"plumb\" in " + array.path,
                           io::ExitCode::usage};
    }
  }
  return std::nullopt;
}

io::FileError limits_of_paper(const io::ArrayFile& array) {
  return io::FileError{array.path,
                       0,
                       "monitor.mode",
                       "is \"paper\": delta_f is its one limit, and --limits is about plumb's own tests",
                       "leave out --limits, or set mode = \"plumb\" with the same delta_f to see what that hides",
                       io::ExitCode::usage};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
