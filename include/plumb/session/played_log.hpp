/// Logs played from scenarios, and the truth behind them in the frame in which plumb answers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/io/array_file.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Plays the scenario into a log; returns what was really the case at every row.
io::FileExpected<std::vector<scenario::Truth>> write_log(const std::string& path, const io::ArrayFile& array,
                                                         const scenario::Scenario& scenario);

/// Gravity cannot tell how the array as a whole sits in its housing: axes and vector may be turned together.
/// plumb's frame is therefore the one in which the nominal axes fit best. This turns what the simulator
/// knows, in the frame of its housing, into that frame; without it the comparison would charge plumb and
/// the plain answer alike with a mounting error that neither can see.
void into_frame_of_nominal_axes(const scenario::Tool& tool, std::vector<scenario::Truth>& truth);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
