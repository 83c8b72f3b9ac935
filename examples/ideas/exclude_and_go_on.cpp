// A sensor fails: the monitor suspects it, excludes it, and continues with the others.
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
  auto run = sim::Simulator::make(sim::drilling_run(tool, 2, {sim::dead_at_station(1, 6)}));  // a2, at station 6
  plumb::Sample sample;
  while (run->next(sample)) {
    const plumb::Verdict& v = monitor.step(sample);
    if (v.transition.sequence == 0) continue;  // nothing has changed
    std::printf("%6.2f s  %-8s  %d in service, %d excluded, %d provisionally excluded: %s\n", v.time_s,
                plumb::to_string(v.state), v.in_service.size(), v.excluded.size(), v.provisionally_excluded.size(),
                plumb::to_string(v.validity));
  }
}
