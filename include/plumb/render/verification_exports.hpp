/// What a verification report gives to other programs, made from the master JSON alone.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

/// Limits and requirements as test cases (JUnit XML): not met and failed are failures, open and traced are skipped,
/// each with its reason.
std::string junit_xml(const Json& report);
/// Requirements, hazards and tests for sphinx-needs (needs.json).
std::string needs_json(const Json& report);
/// The requirements as a document of StrictDoc, hazards as parents, for ReqIF tools.
std::string requirements_sdoc(const Json& report);
/// What the tool was built from (SPDX 2.3, JSON).
std::string spdx_json(const Json& report);
/// The argument as a goal structure (SVG): the goal, the strategies, and what stands behind each.
std::string argument_svg(const Json& report, bool narrow = false);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
