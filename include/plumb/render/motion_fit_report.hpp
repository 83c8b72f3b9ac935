/// What `plumb calibrate --motion` says of a fit in motion: the report as text and as JSON, and why there is none.
#pragma once

#include <string>
#include <vector>

#include "plumb/io/json_fields.hpp"
#include "plumb/render/fit_report.hpp"
#include "plumb/session/motion_commissioning.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

std::string motion_fit_text(const session::MotionCommissioning& run, const io::ArrayFile& array);
io::Json motion_fit_json(const session::MotionCommissioning& run, const io::ArrayFile& array);

/// Where the run was refused: why, and what to do.
Refusal refusal_of(const session::MotionCommissioning& run, const io::ArrayFile& array);
/// One word of it, for programs.
const char* word_of(session::MotionRefusal refusal) noexcept;

/// What the motion leaves open, one phrase each: "lever arm of imu2 along z".
std::vector<std::string> left_open(const session::MotionCommissioning& run, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
