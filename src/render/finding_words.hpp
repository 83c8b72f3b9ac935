/// Findings about a recording and its fit, one phrase each (private to src/render).
#pragma once

#include <string>

#include "plumb/findings/calibration_run.hpp"
#include "plumb/findings/finding.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

bool is_of_column(findings::FindingCode code);
/// The name in the log of the column that the finding is about.
std::string column_of(const findings::Finding& f, const io::ArrayFile& array);
/// "`third` (a3) is empty in all 48 rows"
std::string column_words(const findings::Finding& f, const findings::CalibrationRun& run, const io::ArrayFile& array);

/// Temperatures that are hardly degC, as a question with the likely unit; empty where they are plausible.
std::string temperature_unit_words(const findings::CalibrationRun& run, const io::ArrayFile& array);

/// ": they look like mV", what the numbers of the log may be; empty where nothing is likely.
std::string unit_words(const io::ArrayFile& array, double factor);

/// Why no still stretch was found, with the key of the array file that it concerns.
std::string log_words(const findings::Finding& f, const io::ArrayFile& array);

/// What the attitudes lack, and sensors that most stations are without, one sentence.
std::string remark_words(const findings::Finding& f, const findings::CalibrationRun& run, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
