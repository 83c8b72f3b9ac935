// Warmer than any temperature of the calibration: the output becomes unconfirmed, and a bit says why.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::hexad_datasheet());
  plumb::MonitorSetup setup;
  setup.model = tool.datasheet.model();
  setup.array = *tool.datasheet.array();
  setup.config.temperature_min_degc = 10.0;  // calibrated span, from the calibration file
  setup.config.temperature_max_degc = 60.0;
  for (const double degc : {25.0, 64.0, 66.0}) {  // 5 degC beyond the span is its margin
    static plumb::HealthMonitor monitor;
    sim::Scenario scenario = sim::calibration_run(tool, 2, 6);
    scenario.temperature.start_degc = degc;
    auto run = sim::Simulator::make(scenario);
    if (!monitor.configure(setup)) return 1;
    for (plumb::Sample sample; run->next(sample);) monitor.step(sample);
    const bool usable = (monitor.verdict().usable & plumb::Usable::temperature) != 0;
    std::printf("%.0f degC: %s%s\n", degc, plumb::to_string(monitor.verdict().validity), usable ? "" : ", temperature");
  }
}
