/// Rows through a monitor of whichever kind and capacity (private to this module).
#pragma once

#include <cstring>
#include <type_traits>

#include "plumb/core/sample.hpp"
#include "plumb/session/detail/packed.hpp"
#include "plumb/session/detail/run_counter.hpp"
#include "plumb/session/stepper.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace stepping_detail {

/// Row k; sensors beyond those of the rows are left as they are.
inline void take_row(const stepping::Rows& rows, std::size_t k, Sample& sample) noexcept {
  const stepping::Row& row = rows.row[k];
  std::memcpy(sample.raw.data(), rows.raw_of(k), static_cast<std::size_t>(rows.sensors) * sizeof(double));
  sample.time_s = row.time_s;
  sample.temperature_degc = row.temperature_degc;
  sample.delivered = SensorSet(row.delivered);
  sample.station = row.station;
  sample.count = row.count;
  sample.roll_group = row.roll_group;
}

/// A record that says something and moves nothing: the first alarm of an episode, and what has event `none`.
inline bool is_notice(const TransitionRecord& record) noexcept {
  return record.from == record.to && (record.event == HealthEvent::alarm || record.event == HealthEvent::none);
}

/// `counter` belongs to this monitor and this run. `before(time_s)` is called before each step.
template <class Monitor, class Before>
void step_rows(Monitor& monitor, const stepping::Rows& rows, bool first, stepping::Wanted wanted, RunCounter& counter,
               stepping::Said& said, Before before) {
  said.clear();
  if constexpr (std::is_same_v<Monitor, HealthMonitor>) {
    if (first) counter.begin(monitor, rows.sensors, said.counts);
  }
  Sample sample;
  for (std::size_t k = 0; k < rows.row.size(); ++k) {
    take_row(rows, k, sample);
    if constexpr (std::is_same_v<Monitor, HealthMonitor>) {
      if (!rows.turn.empty()) {
        const stepping::Turn& turn = rows.turn[k];
        (void)monitor.set_rotation({turn.turning, turn.rate_known, turn.rate_radps});  // the reader's are finite
      }
    }
    if constexpr (std::is_same_v<Monitor, HealthMonitor>) {
      if (!rows.found.empty()) monitor.set_motion({rows.found[k].alarm, SensorSet(rows.found[k].excluded)});
    }
    before(sample.time_s);
    const Verdict& verdict = monitor.step(sample);
    if constexpr (std::is_same_v<Monitor, HealthMonitor>) counter.add(monitor, verdict, rows.raw_of(k), said.counts);
    const bool changed = verdict.transition.sequence != 0;
    said.blocks += verdict.tick ? 1U : 0U;
    said.changes += changed && !is_notice(verdict.transition) ? 1U : 0U;
    const bool asked_for = changed || (first && k == 0) || wanted == stepping::Wanted::samples ||
                           (wanted == stepping::Wanted::blocks && verdict.tick);
    if (!asked_for) continue;
    said.row.push_back(k);
    pack(verdict, said.bytes);
  }
}

}  // namespace stepping_detail
}  // namespace PLUMB_ABI
}  // namespace plumb
