// A power cycle: the monitor that takes up the snapshot still knows which sensor it had excluded.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::paper_datasheet());
  plumb::MonitorSetup setup;
  setup.model = tool.datasheet.model();
  setup.array = *tool.datasheet.array();
  static plumb::HealthMonitor before, after;
  static std::array<std::uint8_t, plumb::HealthMonitor::snapshot_size_max()> flash;
  if (!before.configure(setup)) return 1;
  auto run = sim::Simulator::make(sim::drilling_run(tool, 2, {sim::dead_at_station(1, 6)}));
  plumb::Sample sample;
  while (run->next(sample)) before.step(sample);
  const plumb::Expected<std::size_t> size = before.snapshot(flash.data(), flash.size());
  if (!size || !after.restore(setup, flash.data(), *size)) return 1;  // in place of configure
  after.begin_time_base();                                            // the clock may have begun anew
  sample.time_s = 0.0;
  const plumb::Verdict& v = after.step(sample);
  std::printf("%s, %s, a2 excluded: %d\n", plumb::to_string(v.state), plumb::to_string(v.validity), v.excluded.has(1));
}
