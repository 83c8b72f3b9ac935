// Three sensors are left: the output is degraded, and its protection level says what one more fault could hide.
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
  plumb::Verdict before;
  for (plumb::Sample sample; run->next(sample);) {
    const plumb::Verdict& v = monitor.step(sample);
    if (v.state == plumb::HealthState::degraded_3_sensor) break;
    if (v.validity == plumb::Validity::valid) before = v;
  }
  std::printf("valid: within %.2f deg\n", plumb::deg_from_rad(before.protection_level_housing_rad));
  std::printf("degraded: within %.0f deg\n", plumb::deg_from_rad(monitor.verdict().protection_level_housing_rad));
}
