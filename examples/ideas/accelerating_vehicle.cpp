// A vehicle that may accelerate steadily looks like a tilted one: state how much, and the bound counts it.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::hexad_datasheet());
  for (const double bound_mps2 : {0.0, 0.05, 0.5}) {
    plumb::MonitorSetup setup;
    setup.model = tool.datasheet.model();
    setup.array = *tool.datasheet.array();
    setup.config.acceleration_bound_mps2 = bound_mps2;
    static plumb::HealthMonitor monitor;
    if (!monitor.configure(setup)) return 1;
    auto run = sim::Simulator::make(sim::drilling_run(tool, 2));
    for (plumb::Sample sample; run->next(sample);) monitor.step(sample);
    const plumb::Verdict& v = monitor.verdict();
    const bool assumed = (v.qualifiers & plumb::Qualifier::standstill_assumed) != 0;
    std::printf("up to %.2f m/s^2: within %.2f deg%s%s\n", bound_mps2,
                plumb::deg_from_rad(v.protection_level_housing_rad), assumed ? ", standstill assumed" : "",
                v.alert ? ", alert" : "");
  }
}
