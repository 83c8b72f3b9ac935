/// The first scenarios of the campaigns a second time, by other code (the simulator, and the monitor for 24 sensors),
/// with an eye on the state machine.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "plumb/health/transition_table.hpp"
#include "plumb/verification/trials.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

/// Where the scenarios led: samples in every mode, records in every cell of the table, moves from mode to mode.
struct Coverage {
  std::array<std::uint64_t, kModeCount> samples{};
  std::array<std::array<std::uint64_t, kEventCount>, kModeCount> records{};
  std::array<std::array<std::uint64_t, kModeCount>, kModeCount> moves{};
};

struct Replayed {
  Replay counted;
  std::vector<std::pair<std::string, std::uint64_t>> differing;  ///< campaign and number of the scenario
  Coverage coverage;
  std::vector<std::int64_t> step_ns;  ///< of every step of the monitor
};

/// So many of each campaign. Errors: those of `make_kernel` and `replay`.
tl::expected<Replayed, std::string> replay_first(const std::vector<const Trials*>& campaigns, std::uint64_t scenarios);

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
