// A recorded roll test first: a tool that cannot turn where it works begins its run validated.
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
  auto roll = sim::Simulator::make(sim::calibration_run(tool, 1, 6));
  sim::Scenario still = sim::calibration_run(tool, 2, 1);  // one attitude, its clock begins at 0 again
  auto run = sim::Simulator::make(still);
  plumb::Sample sample;
  if (!monitor.configure(setup)) return 1;
  while (roll->next(sample)) monitor.step(sample);
  monitor.begin_time_base();  // the next sample may have any time
  while (run->next(sample)) monitor.step(sample);
  const bool not_yet_validated = (monitor.verdict().qualifiers & plumb::Qualifier::not_yet_validated) != 0;
  std::printf("%s, %s\n", plumb::to_string(monitor.verdict().state),
              not_yet_validated ? "not_yet_validated" : "validated");
}
