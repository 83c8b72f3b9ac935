// plumb calibrate --align-by: axes of a magnetic group turned into the frame of the accelerometers.
#pragma once

#include <string>

#include "plumb/session/calibration_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// What was wrong with asking for it, or for a known attitude, of such a group; empty where nothing is.
std::optional<io::FileError> misuse_of_alignment(const io::ArrayFile& array, const std::string& align_by,
                                                 bool known_attitudes);

/// The rotation, from the stations of the log that both have seen; `fit` is turned by it. Refuses what the dip does not
/// show, with the reason and exit code 4. `text` says what was found.
io::FileExpected<io::FrameAlignment> align_group(const std::string& array_path, const std::string& calibration,
                                                 const session::LogSpec& log, const io::ArrayFile& group,
                                                 session::CalibrationRun& fit, std::string& text);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
