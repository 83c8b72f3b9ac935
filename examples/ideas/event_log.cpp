// An event log: every change of state is one record with its cause and figures, whatever happened in between.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::paper_datasheet());
  plumb::MonitorSetup setup;
  setup.model = tool.datasheet.model();
  setup.array = *tool.datasheet.array();
  static plumb::HealthMonitor monitor;
  if (!monitor.configure(setup)) return 1;
  auto run = sim::Simulator::make(sim::drilling_run(tool, 2, {sim::dead_at_station(1, 6)}));
  for (plumb::Sample sample; run->next(sample);) {
    const plumb::TransitionRecord t = monitor.step(sample).transition;
    if (t.sequence == 0) continue;
    std::printf("{\"n\": %u, \"t\": %.2f, \"event\": \"%s\", \"cause\": \"%s\", \"sensors\": %u, \"over\": %.1f}\n",
                t.sequence, t.time_s, plumb::to_string(t.event), plumb::to_string(t.cause), t.sensors.bits,
                t.limit > 0.0 ? t.statistic / t.limit : 0.0);
  }
}
