/// The verdict of a verification report as a section of the master JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "plumb/verification/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

Json verdict_section(const verification::Report& judged);
/// "requirements", "active", ...
Json counts_json(const verification::RequirementCounts& counts);

/// The criteria of a whole report, by their ids; names are not read. Throws std::invalid_argument where an id or a
/// result is none: a criterion is never passed over.
std::vector<verification::Criterion> criteria_of(const Json& report);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
