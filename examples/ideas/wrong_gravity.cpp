// Gravity left at another latitude: the monitor finds how far off it is, and the length to configure.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::hexad_datasheet());
  plumb::MonitorSetup setup;
  setup.model = tool.datasheet.model();
  setup.array = *tool.datasheet.array();
  setup.gravity = {9.83, 0.001, plumb::GravityModel::value};
  static plumb::HealthMonitor monitor;
  if (!monitor.configure(setup)) return 1;
  auto run = sim::Simulator::make(sim::calibration_run(tool, 4, 20));  // where gravity is 9.80665 m/s^2
  for (plumb::Sample sample; run->next(sample);) {
    const double g_mps2 = monitor.step(sample).norm_mismatch.configure_mps2;
    if (g_mps2 == 0.0) continue;
    std::printf("%s: configure %.3f m/s^2\n", plumb::to_string(monitor.verdict().norm_mismatch.kind), g_mps2);
    return monitor.set_gravity({g_mps2, 0.001, plumb::GravityModel::value}) ? 0 : 1;
  }
  return 1;
}
