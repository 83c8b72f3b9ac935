/// What is reported of a fit beside its figures, whether it was accepted or not.
#pragma once

#include <vector>

#include "plumb/findings/calibration_run.hpp"
#include "plumb/findings/finding.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Sensors that most stations are without.
std::vector<Finding> absent_sensors(const CalibrationRun& run, const io::ArrayFile& array);
/// What the attitudes lack, absent sensors among it.
std::vector<Finding> coverage_remarks(const CalibrationRun& run, const io::ArrayFile& array);
/// Sensors whose samples scatter more than declared; none where the unit is wrong, for then the noise is too.
std::vector<Finding> noise_remarks(const CalibrationRun& run, const io::ArrayFile& array);
/// What all sensors have in common, where it is more than chance: scale factors, and a turn about a wrong roll axis.
std::vector<Finding> common_remarks(const FitReport& report);
/// What the temperatures of the stations leave open.
std::vector<Finding> temperature_remarks(const CalibrationRun& run);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
