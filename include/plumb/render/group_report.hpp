/// What the groups of one tool say, one after the other and together.
#pragma once

#include <string>

#include "plumb/io/array_file.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/session/group_dip.hpp"
#include "plumb/session/rate_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// A line above the results of a group.
std::string group_heading(const io::ArrayFile& group);
/// The same before its lines of JSON: {"group": {"name": ..., "field": ..., "sensors": [...]}}.
std::string group_heading_json(const io::ArrayFile& group);

/// For standard error, where gyros are judged by a datasheet that bounds their errors by nothing; else empty.
std::string rate_bounds_note(const io::ArrayFile& group, bool calibrated);
std::string rate_run_text(const session::RateRun& run, const io::ArrayFile& group);
std::string rate_run_json(const session::RateRun& run, const io::ArrayFile& group);

/// In one sentence: which gyros serve. Trusted: all do, with a bound on the rate.
bool rate_is_trusted(const session::RateRun& run) noexcept;
std::string rate_sentence(const session::RateRun& run, const io::ArrayFile& group);

/// Gravity against the field of `group`; null: the group states no dip. `accelerometers`: of the tool.
std::string dip_text(const session::GroupDip* dip, const SensorArray& accelerometers);
/// The same for a page: without the names of lines.
std::string dip_sentence(const session::GroupDip* dip, const SensorArray& accelerometers);
io::Json dip_json(const session::GroupDip* dip, const io::ArrayFile& group, const SensorArray& accelerometers);

/// Lines of the table: what has changed at a time, in words.
std::string dip_line(const session::DipEvent& event, const io::ArrayFile& group, const SensorArray& accelerometers);
std::string rate_line(const session::RateEvent& event, const SensorArray& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
