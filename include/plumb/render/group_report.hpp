/// What the groups of one tool say, one after the other and together.
#pragma once

#include <string>

#include "plumb/io/array_file.hpp"
#include "plumb/session/group_track.hpp"
#include "plumb/session/rate_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// A line above the results of a group.
std::string group_heading(const io::ArrayFile& group);
/// The same before its lines of JSON: {"group": {"name": ..., "field": ..., "sensors": [...]}}.
std::string group_heading_json(const io::ArrayFile& group);

std::string rate_run_text(const session::RateRun& run, const io::ArrayFile& group);
std::string rate_run_json(const session::RateRun& run, const io::ArrayFile& group);

/// Gravity against the field of `group`.
std::string dip_text(const session::DipCheck& check, const io::ArrayFile& group);
std::string dip_json(const session::DipCheck& check, const io::ArrayFile& group);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
