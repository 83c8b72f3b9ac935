// Offer a calibration from elsewhere: it is tried at stations visited from now on, then adopted or refused.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  sim::Tool tool = sim::perfect_tool(sim::hexad_datasheet());
  for (auto& sensor : tool.datasheet.sensor) sensor.prior = {1e-3, 1e-4, 1e-4};  // what a bench leaves, 1 sigma
  plumb::MonitorSetup setup;
  setup.model = tool.datasheet.model();
  setup.array = *tool.datasheet.array();
  setup.array.set_uncertainty(tool.datasheet.uncertainty());
  static plumb::HealthMonitor monitor;
  if (!monitor.configure(setup)) return 1;
  tool.model.sensor[1].bias[0] += 0.006;  // a2 has drifted since, and a bench knows it
  auto run = sim::Simulator::make(sim::calibration_run(tool, 3, 40));
  for (plumb::Sample sample; run->next(sample);) {
    const plumb::TransitionRecord t = monitor.step(sample).transition;
    if (t.sequence == 1 && !monitor.offer_calibration(tool.model, setup.array)) return 1;
    if (t.sequence != 0) std::printf("%6.2f s  %s\n", t.time_s, plumb::to_string(t.event));
  }
  std::printf("bias of a2: %.4f m/s^2\n", monitor.model().sensor[1].bias[0]);
}
