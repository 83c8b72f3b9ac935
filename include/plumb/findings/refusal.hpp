/// Why a fit was refused.
#pragma once

#include <vector>

#include "plumb/findings/calibration_run.hpp"
#include "plumb/findings/finding.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// The reason first; behind it what goes with it: further columns that are stuck, columns that lacked numbers where too
/// little was recorded, or the one mistake that would explain values that do not fit. Of a run that was not accepted.
std::vector<Finding> refusal_of(const CalibrationRun& run, const io::ArrayFile& array);

/// The same of the fits by the paper's method.
Finding paper_refusal_of(const CalibrationRun& run, const io::ArrayFile& array);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
