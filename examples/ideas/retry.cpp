// Failed by timeout without an operator: another try after a pause, a stated number of times, each of them logged.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/health/retry.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::paper_datasheet());
  plumb::MonitorSetup setup;
  setup.model = tool.datasheet.model();
  setup.array = *tool.datasheet.array();
  static plumb::HealthMonitor monitor;
  if (!monitor.configure(setup)) return 1;
  plumb::RetryAfterTimeout retry({10.0, 1, setup.config.reset_key});  // pause [s], retries at most, key
  const sim::Drill drill = sim::drill_a(tool, 3);                     // two of four sensors fail
  auto run = sim::Simulator::make(drill.scenario);
  for (plumb::Sample sample; run->next(sample);) {
    const plumb::Verdict& v = monitor.step(sample);
    const plumb::RetryRecord tried = retry.offer(v, monitor);
    if (tried.action != plumb::RetryAction::none) std::printf("%5.1f s  %s\n", tried.time_s, to_string(tried.action));
  }
}
