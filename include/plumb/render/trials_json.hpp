/// The campaigns of a verification report as sections of the master JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "plumb/verification/replayed.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

/// Tables, times, diagrams and worst cases, every rate as k of n with its interval. `command` is what replays scenario
/// numbers, to be completed by one.
Json fault_trials_json(const verification::Trials& trials, const std::string& command);
Json healthy_trials_json(const verification::Trials& trials, const std::string& command);

/// What was played again: whether both agree, and which states, transitions and cells of the table were visited.
Json replayed_json(const verification::Replayed& replayed);
Json coverage_json(const verification::Coverage& coverage);

/// Number, median, 99.9 % and high-water mark of these times; null where there are none.
Json step_times_json(std::vector<std::int64_t> step_ns);

Json rate_json(const verification::Rate& rate);
/// Every count of the scenarios as a rate, with what it means.
Json rates_json(const campaign::Tally& tally);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
