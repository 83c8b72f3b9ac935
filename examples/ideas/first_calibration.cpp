// No calibration at all: the monitor begins with a datasheet and makes its own, from attitudes and gravity.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::paper_tool(1);  // biases to 20 mg, scales to 2 %, axes to 2 deg: plumb does not know them
  plumb::MonitorSetup setup;
  if (!plumb::set_datasheet(tool.datasheet, setup)) return 1;
  static plumb::HealthMonitor monitor;
  if (!monitor.configure(setup)) return 1;
  auto run = sim::Simulator::make(sim::calibration_run(tool, 5, 60));
  for (plumb::Sample sample; run->next(sample);) {
    const plumb::Verdict& v = monitor.step(sample);
    if (v.transition.sequence == 0) continue;
    std::printf("%6.2f s  %s -> %s, %s\n", v.time_s, plumb::to_string(v.transition.from),
                plumb::to_string(v.transition.to), plumb::to_string(v.transition.cause));
  }
  std::printf("bias of a1: %.4f, true %.4f m/s^2\n", monitor.model().sensor[0].bias[0], tool.model.sensor[0].bias[0]);
}
