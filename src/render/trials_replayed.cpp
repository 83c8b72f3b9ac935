// What the scenarios that were played again showed.
#include <algorithm>

#include "plumb/io/json_fields.hpp"
#include "plumb/render/trials_json.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using std::size_t;

Json coverage_json(const verification::Coverage& seen) {
  Json states = Json::array(), cells = Json::array(), moves = Json::array();
  int visited = 0, reached = 0, taken = 0;
  for (int m = 0; m < kModeCount; ++m) {
    const auto mode = static_cast<Mode>(m);
    const std::uint64_t samples = seen.samples[static_cast<size_t>(m)];
    visited += samples > 0 ? 1 : 0;
    states.push_back(io::object({{"mode", to_string(mode)}, {"samples", samples}}));
    for (int e = 0; e < kEventCount; ++e) {
      const auto event = static_cast<HealthEvent>(e);
      const std::uint64_t count = seen.records[static_cast<size_t>(m)][static_cast<size_t>(e)];
      if (cell_of(mode, event).kind != CellKind::taken) continue;
      ++taken;
      reached += count > 0 ? 1 : 0;
      cells.push_back(io::object({{"mode", to_string(mode)}, {"event", to_string(event)}, {"records", count}}));
    }
    for (int to = 0; to < kModeCount; ++to) {
      const std::uint64_t count = seen.moves[static_cast<size_t>(m)][static_cast<size_t>(to)];
      if (count > 0)
        moves.push_back(
            io::object({{"from", to_string(mode)}, {"to", to_string(static_cast<Mode>(to))}, {"count", count}}));
    }
  }
  return io::object({{"modes", kModeCount},
                     {"modes_visited", visited},
                     {"cells_taken", taken},
                     {"cells_recorded", reached},
                     {"states", std::move(states)},
                     {"cells", std::move(cells)},
                     {"moves", std::move(moves)}});
}

Json replayed_json(const verification::Replayed& replayed) {
  Json differing = Json::array();
  for (const auto& [name, number] : replayed.differing)
    differing.push_back(io::object({{"campaign", name}, {"scenario", number}}));
  return io::object({{"scenarios", replayed.counted.scenarios},
                     {"agree", replayed.counted.agree},
                     {"differing", std::move(differing)},
                     {"coverage", coverage_json(replayed.coverage)}});
}

Json step_times_json(std::vector<std::int64_t> step_ns) {
  if (step_ns.empty()) return {};
  std::sort(step_ns.begin(), step_ns.end());
  // The smallest time that so many of a thousand calls did not exceed.
  const auto at = [&step_ns](size_t of_1000) { return step_ns[(step_ns.size() * of_1000 + 999) / 1000 - 1]; };
  return io::object({{"calls", step_ns.size()},
                     {"median_ns", at(500)},
                     {"p999_ns", at(999)},
                     {"high_water_ns", step_ns.back()},
                     {"clock", "std::chrono::steady_clock"}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
