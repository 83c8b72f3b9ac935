// Inhibit exclusion, for example during a survey: the monitor still reports the suspicion, and excludes no sensor
// before the release.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::hexad_datasheet());
  plumb::MonitorSetup setup;
  setup.model = tool.datasheet.model();
  setup.array = *tool.datasheet.array();
  static plumb::HealthMonitor monitor;
  if (!monitor.configure(setup)) return 1;
  auto run = sim::Simulator::make(sim::drilling_run(tool, 2, {sim::dead_at_station(1, 6)}));
  for (plumb::Sample sample; run->next(sample);) {
    monitor.inhibit(sample.time_s >= 10.0 && sample.time_s < 25.0);
    const plumb::TransitionRecord t = monitor.step(sample).transition;
    if (t.sequence != 0) std::printf("%5.2f s  %s, %s\n", t.time_s, plumb::to_string(t.to), plumb::to_string(t.cause));
  }
}
