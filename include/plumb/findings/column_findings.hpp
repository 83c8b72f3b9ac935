/// What the columns of a log did not hold.
#pragma once

#include <optional>
#include <vector>

#include "plumb/findings/calibration_run.hpp"
#include "plumb/findings/finding.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Columns that lacked something, in the order of the array file; then temperature and roll group.
std::vector<Finding> column_findings(const CalibrationRun& run, const io::ArrayFile& array);

/// Temperatures of the stations that are hardly degC.
std::optional<Finding> temperature_unit(const CalibrationRun& run, const io::ArrayFile& array);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
