// Which way to turn: a tool rolled about one of its axes has not shown that this sensor lives, and the verdict says so.
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
  sim::Scenario roll = sim::calibration_run(tool, 1);
  roll.attitudes = sim::RollTest{};  // once round the tool's axis z, along which a4 points
  auto run = sim::Simulator::make(roll);
  for (plumb::Sample sample; run->next(sample);) monitor.step(sample);
  const plumb::Verdict& v = monitor.verdict();
  std::printf("%s; change gravity by %.2f m/s^2 along (%.2f, %.2f, %.2f)\n", plumb::to_string(v.state),
              v.rotation.change_mps2, v.rotation.along[0], v.rotation.along[1], v.rotation.along[2]);
}
