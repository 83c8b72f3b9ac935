// What was counted, as it is judged.
#include <algorithm>

#include "plumb/study/proportion.hpp"
#include "plumb/verification/trials.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

using campaign::Count;
using campaign::Tally;

Rate of_scenarios(const Tally& tally, Count count) {
  return rate_of(tally.total(count), tally.total(Count::scenarios));
}

}  // namespace

Rate rate_of(std::uint64_t count, std::uint64_t of) {
  const study::Proportion p = study::proportion(count, of);
  return {count, of, p.low, p.high};
}

std::uint64_t blocks_at_risk(const Trials& healthy) {
  std::uint64_t out = 0;
  for (const Trial& t : healthy.trial)
    out += static_cast<std::uint64_t>(t.alarm_block >= 0 ? t.alarm_block + 1 : t.blocks);
  return out;
}

std::uint64_t blocks_at_risk(const Trials& healthy, const Tally& longer) {
  const int first = healthy.trial.empty() ? 0 : healthy.trial.front().blocks;
  const bool same =
      std::all_of(healthy.trial.begin(), healthy.trial.end(), [first](const Trial& t) { return t.blocks == first; });
  if (!same || first <= 0) return 0;
  // A scenario without an alarm was at risk in all its blocks; one with an alarm in one at least.
  const std::uint64_t alarms = longer.total(Count::false_alarm);
  return (longer.total(Count::scenarios) - alarms) * static_cast<std::uint64_t>(first) + alarms;
}

std::vector<std::uint64_t> up_to_the_last(const std::array<std::uint64_t, campaign::kMostBlocks>& counts) {
  std::vector<std::uint64_t> out(counts.begin(), counts.end());
  while (!out.empty() && out.back() == 0) out.pop_back();
  return out;
}

HealthyCampaign healthy_facts(const Trials& played) {
  const Tally& tally = played.counted.tally;
  return {true, "", rate_of(tally.total(Count::false_alarm), blocks_at_risk(played)),
          of_scenarios(tally, Count::unavailable)};
}

void take_longer(const Trials& played, const Tally& longer, HealthyCampaign& out) {
  const std::uint64_t at_risk = blocks_at_risk(played, longer);
  if (at_risk > 0) out.false_alarm_per_block = rate_of(longer.total(Count::false_alarm), at_risk);
  out.unavailable = of_scenarios(longer, Count::unavailable);
}

FaultCampaign fault_facts(const Trials& played) {
  FaultCampaign out;
  out.played = true;
  take_longer(played.counted.tally, out);
  out.blocks_to_detect = up_to_the_last(played.counted.tally.blocks_to_detect());
  out.block_s = played.file.plan.window / played.file.plan.rate_hz;
  return out;
}

void take_longer(const Tally& longer, FaultCampaign& out) {
  out.wrong_exclusion = of_scenarios(longer, Count::wrong_exclusion);
  out.misleading = of_scenarios(longer, Count::misleading);
  out.isolated = of_scenarios(longer, Count::isolated);
  out.ambiguous = of_scenarios(longer, Count::ambiguous);
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
