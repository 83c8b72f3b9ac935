// A survey station: the mean of its valid blocks as inclination and toolface.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/navigation/tilt.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::paper_datasheet());
  plumb::MonitorSetup setup;
  setup.model = tool.datasheet.model();
  setup.array = *tool.datasheet.array();
  static plumb::HealthMonitor monitor;
  if (!monitor.configure(setup)) return 1;
  plumb::Vec3 sum = {};  // the length of a vector does not matter
  auto run = sim::Simulator::make(sim::calibration_run(tool, 2, 1));
  for (plumb::Sample sample; run->next(sample);) {
    const plumb::Verdict& v = monitor.step(sample);
    if (!v.tick || v.validity != plumb::Validity::valid) continue;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += v.gravity_mps2[c];
  }
  const plumb::Tilt t = plumb::tilt_of(sum, plumb::Mat3{});
  std::printf("%.3f deg, %.3f deg\n", plumb::deg_from_rad(t.inclination_rad), plumb::deg_from_rad(t.toolface_rad));
}
