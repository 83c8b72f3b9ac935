// A channel falls silent for a second and comes back: it is absent, then excluded, then on probation.
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
  auto run = sim::Simulator::make(sim::drilling_run(tool, 2));
  for (plumb::Sample sample; run->next(sample);) {
    if (sample.time_s >= 15.0 && sample.time_s < 16.0) sample.delivered = sample.delivered.without(2);  // a3
    const plumb::Verdict& v = monitor.step(sample);
    if (v.transition.sequence == 0) continue;
    const char* const where = v.absent.has(2) ? "absent" : v.excluded.has(2) ? "excluded" : "in service";
    std::printf("%6.2f s  %-16s  a3 %s\n", v.time_s, plumb::to_string(v.transition.event), where);
  }
}
