/// The mistake that would explain a refusal, in sentences (private to src/render).
#pragma once

#include <string>
#include <vector>

#include "plumb/findings/calibration_run.hpp"
#include "plumb/findings/finding.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// "; with the columns of a1 and a4 exchanged all would be well", to follow the reason. Of the findings that say what
/// would settle; there is one at least.
std::string settling_words(const std::vector<findings::Finding>& settling, const findings::CalibrationRun& run,
                           const io::ArrayFile& array);
/// What to do about it.
std::string settling_remedy(const std::vector<findings::Finding>& settling, const findings::CalibrationRun& run,
                            const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
