/// The pictures of a fit, written to a directory.
#pragma once

#include <string>
#include <vector>

#include "plumb/session/calibration_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Writes data and script, and draws. `missing` says why there are no pictures where gnuplot cannot draw them; the
/// returned names are those of the files that exist then. Error: a file or the directory cannot be written.
io::FileExpected<std::vector<std::string>> draw_fit(const std::string& directory, const session::CalibrationRun& run,
                                                    const io::ArrayFile& array, std::string& missing);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
