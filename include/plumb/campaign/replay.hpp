/// One scenario of a campaign on its own: as small as it can be made, as a scenario file, and played again by other
/// code than the campaign's (`scenario::Simulator`, and the monitor of the tool).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/campaign/kernel.hpp"
#include "plumb/campaign/tally.hpp"
#include "plumb/health/verdict.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
namespace campaign {

/// What must not happen, for `shrunk`.
bool fails(const Plan& plan, Count what, const Outcome& outcome) noexcept;

/// The simplest scenario found in which `what` still happens: fewest faults, fewest stations, no error of gravity or
/// calibration, round numbers, earliest onset. The spec itself where nothing can be omitted.
Spec shrunk(const Plan& plan, Kernel& kernel, const Spec& spec, Count what);

/// The scenario file, array included; its array has the name of the plan's tool.
std::string case_text(const Plan& plan, const Spec& spec);

/// Plays the validation, then the scenario; `look` sees every verdict of the latter. `tool` is an index of the
/// plan. `step_ns`, where given, gets how long every call of `HealthMonitor::step` took, by std::chrono::steady_clock.
/// Errors: those of the simulator and of the monitor's configuration.
tl::expected<Outcome, std::string> replay(const Plan& plan, int tool, const scenario::Scenario& scenario,
                                          const std::function<void(const Verdict&)>& look,
                                          std::vector<std::int64_t>* step_ns = nullptr);

/// The spec as the simulator plays it.
scenario::Scenario scenario_of(const Plan& plan, const Spec& spec);

/// What happens in it, in words.
std::string sentence_of(const Plan& plan, const Spec& spec);

}  // namespace campaign
}  // namespace plumb
