// The first scenarios of the campaigns a second time, by other code, with an eye on the state machine.
#include <algorithm>
#include <array>
#include <memory>

#include "plumb/campaign/kernel.hpp"
#include "plumb/campaign/replay.hpp"
#include "plumb/health/transition_table.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/report/trials.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {
namespace {

using std::size_t;

Mode mode_of(HealthState state, bool initial) {
  switch (state) {
    case HealthState::nominal: return Mode::nominal;
    case HealthState::isolated: return Mode::isolated;
    case HealthState::suspect: return Mode::suspect;
    case HealthState::degraded_3_sensor: return Mode::degraded;
    case HealthState::recalibrating: return initial ? Mode::initial : Mode::recalibrating;
    case HealthState::failed: return Mode::failed;
  }
  return Mode::failed;
}

/// What was seen of the state machine.
struct Seen {
  std::array<std::uint64_t, kModeCount> samples{};
  std::array<std::array<std::uint64_t, kEventCount>, kModeCount> records{};
  std::array<std::array<std::uint64_t, kModeCount>, kModeCount> moves{};

  void look(const Verdict& verdict) {
    const bool initial = (verdict.qualifiers & Qualifier::initial_calibration) != 0;
    ++samples[static_cast<size_t>(mode_of(verdict.state, initial))];
    const TransitionRecord& record = verdict.transition;
    if (record.sequence == 0 || record.event == HealthEvent::none) return;
    const auto from = static_cast<size_t>(mode_of(record.from, initial));
    const auto to = static_cast<size_t>(mode_of(record.to, initial));
    ++records[from][static_cast<size_t>(record.event)];
    if (from != to) ++moves[from][to];
  }
};

bool same(const campaign::Outcome& a, const campaign::Outcome& b) {
  bool out = a.blocks == b.blocks && a.alarm_block == b.alarm_block && a.isolated_block == b.isolated_block &&
             a.excluded == b.excluded && a.set_aside == b.set_aside && a.ever_excluded == b.ever_excluded &&
             a.ever_set_aside == b.ever_set_aside && a.failed == b.failed;
  for (int k = 0; out && k < a.blocks; ++k) {
    const campaign::BlockOutcome& x = a.block[static_cast<size_t>(k)];
    const campaign::BlockOutcome& y = b.block[static_cast<size_t>(k)];
    out =
        x.tilt_rad == y.tilt_rad && x.protection_rad == y.protection_rad && x.usable == y.usable && x.alert == y.alert;
  }
  return out;
}

Json coverage_json(const Seen& seen) {
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

}  // namespace

tl::expected<Json, std::string> replayed_json(const std::vector<const Trials*>& campaigns, std::uint64_t scenarios,
                                              std::vector<std::int64_t>* step_ns) {
  Seen seen;
  std::uint64_t replayed = 0, agreed = 0;
  Json differing = Json::array();
  for (const Trials* trials : campaigns) {
    const campaign::Plan& plan = trials->file.plan;
    const auto kernel = campaign::make_kernel(plan);
    if (!kernel) return tl::unexpected<std::string>(kernel.error());
    const auto played = std::make_unique<campaign::Outcome>();
    for (std::uint64_t number = 0; number < std::min(scenarios, plan.scenarios); ++number) {
      const campaign::Spec spec = campaign::spec_of(plan, number);
      (*kernel)->play(spec, *played);
      const auto look = [&seen](const Verdict& verdict) { seen.look(verdict); };
      const auto again = campaign::replay(plan, spec.tool, campaign::scenario_of(plan, spec), look, step_ns);
      if (!again) return tl::unexpected<std::string>(again.error());
      ++replayed;
      if (same(*played, *again)) {
        ++agreed;
      } else {
        differing.push_back(io::object({{"campaign", plan.name}, {"scenario", number}}));
      }
    }
  }
  Json out = io::object({{"scenarios", replayed}, {"agree", agreed}, {"differing", std::move(differing)}});
  out["coverage"] = coverage_json(seen);
  return out;
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

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
