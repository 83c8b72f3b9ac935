// Drift since the calibration: stated by the datasheet, counted in days by the host, paid for in the protection level.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::hexad_datasheet());
  for (const double days : {0.0, 90.0, 365.0}) {
    plumb::MonitorSetup setup;
    setup.model = tool.datasheet.model();
    setup.array = *tool.datasheet.array();
    setup.stability.fill({5e-4, 1e-5, 0.0, 0.0});  // 1 sigma: 0.05 mg at once, 1 ug a day [m/s^2]
    setup.days_since_calibration = days;           // the host has the calendar
    static plumb::HealthMonitor monitor;
    if (!monitor.configure(setup)) return 1;
    auto run = sim::Simulator::make(sim::drilling_run(tool, 2));
    for (plumb::Sample sample; run->next(sample);) monitor.step(sample);
    const plumb::Verdict& v = monitor.verdict();
    std::printf("after %3.0f days: %s, within %.2f deg\n", days, plumb::to_string(v.state),
                plumb::deg_from_rad(v.protection_level_housing_rad));
  }
}
