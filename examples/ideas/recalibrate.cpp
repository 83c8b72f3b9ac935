// Ask for a recalibration: biases are estimated anew beside the run, and adopted once stations held out confirm them.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  sim::Tool tool = sim::perfect_tool(sim::hexad_datasheet());
  plumb::MonitorSetup setup;
  setup.model = tool.datasheet.model();
  setup.array = *tool.datasheet.array();
  setup.stability.fill({0.002, 0.0, 0.0, 0.0});  // drift since the calibration, 1 sigma [m/s^2]
  static plumb::HealthMonitor monitor;
  if (!monitor.configure(setup)) return 1;
  tool.model.sensor[1].bias[0] += 0.006;  // a2 has drifted since
  auto run = sim::Simulator::make(sim::calibration_run(tool, 3, 48));
  for (plumb::Sample sample; run->next(sample);) {
    const plumb::Verdict& v = monitor.step(sample);
    if (v.transition.to == plumb::HealthState::nominal) monitor.request_recalibration();
    if (v.transition.sequence != 0) std::printf("%6.2f s  %s\n", v.time_s, plumb::to_string(v.transition.event));
    if (v.transition.event == plumb::HealthEvent::fit_accepted) break;
  }
  std::printf("bias of a2: %.4f m/s^2\n", monitor.model().sensor[1].bias[0]);
}
