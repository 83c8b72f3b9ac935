/// The groups that --group names, and what does not go with them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "monitor_options.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/gyro_calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// A group of the tool that is to be watched.
struct WantedGroup {
  std::string name, calibration;
  const io::ArrayFile* array = nullptr;
  std::optional<io::GyroCalibration> gyros{};  ///< of a rate that is calibrated
};

/// "mag=mag.json": a calibration, which a rate need not have. Errors: a group that the tool has not, a calibration
/// that is missing or of another array. `tool` outlives them.
io::FileExpected<std::vector<WantedGroup>> wanted_groups(const MonitorOptions& options, const io::ArrayFile& tool);

/// Two groups that would write the same file.
std::optional<io::FileError> groups_clash(const MonitorOptions& options, const std::vector<WantedGroup>& groups);

/// An option that a run with groups does not take.
std::optional<io::FileError> groups_misuse(const MonitorOptions& options);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
