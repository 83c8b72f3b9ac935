#include "plumb/verification/replayed.hpp"

#include <algorithm>
#include <memory>

#include "plumb/campaign/kernel.hpp"
#include "plumb/campaign/replay.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
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

void note(const Verdict& verdict, Coverage& out) {
  const bool initial = (verdict.qualifiers & Qualifier::initial_calibration) != 0;
  ++out.samples[static_cast<size_t>(mode_of(verdict.state, initial))];
  const TransitionRecord& record = verdict.transition;
  if (record.sequence == 0 || record.event == HealthEvent::none) return;
  const auto from = static_cast<size_t>(mode_of(record.from, initial));
  const auto to = static_cast<size_t>(mode_of(record.to, initial));
  ++out.records[from][static_cast<size_t>(record.event)];
  if (from != to) ++out.moves[from][to];
}

bool same(const campaign::Outcome& a, const campaign::Outcome& b) {
  bool out = a.blocks == b.blocks && a.alarm_block == b.alarm_block && a.isolated_block == b.isolated_block &&
             a.excluded == b.excluded && a.provisionally_excluded == b.provisionally_excluded &&
             a.ever_excluded == b.ever_excluded && a.ever_provisionally_excluded == b.ever_provisionally_excluded &&
             a.failed == b.failed;
  for (int k = 0; out && k < a.blocks; ++k) {
    const campaign::BlockOutcome& x = a.block[static_cast<size_t>(k)];
    const campaign::BlockOutcome& y = b.block[static_cast<size_t>(k)];
    out =
        x.tilt_rad == y.tilt_rad && x.protection_rad == y.protection_rad && x.usable == y.usable && x.alert == y.alert;
  }
  return out;
}

}  // namespace

tl::expected<Replayed, std::string> replay_first(const std::vector<const Trials*>& campaigns, std::uint64_t scenarios) {
  Replayed out;
  const auto look = [&out](const Verdict& verdict) { note(verdict, out.coverage); };
  for (const Trials* trials : campaigns) {
    const campaign::Plan& plan = trials->file.plan;
    const auto kernel = campaign::make_kernel(plan);
    if (!kernel) return tl::unexpected<std::string>(kernel.error());
    const auto played = std::make_unique<campaign::Outcome>();
    for (std::uint64_t number = 0; number < std::min(scenarios, plan.scenarios); ++number) {
      const campaign::Spec spec = campaign::spec_of(plan, number);
      (*kernel)->play(spec, *played);
      const auto again = campaign::replay(plan, spec.tool, campaign::scenario_of(plan, spec), look, &out.step_ns);
      if (!again) return tl::unexpected<std::string>(again.error());
      ++out.counted.scenarios;
      if (same(*played, *again)) {
        ++out.counted.agree;
      } else {
        out.differing.emplace_back(plan.name, number);
      }
    }
  }
  return out;
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
