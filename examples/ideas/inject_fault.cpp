// Put a fault into a run, from one line of text, and see what the monitor makes of it.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/fault_text.hpp"
#include "plumb/scenario/library.hpp"

int main() {
  namespace sim = plumb::scenario;
  const sim::Tool tool = sim::perfect_tool(sim::hexad_datasheet());
  sim::FaultContext context;
  context.datasheet = tool.datasheet;
  for (const char* text : {"a3:bias=50mg0@15s", "a3:stuck=0V@15s", "a3:missing=100%@15s", "log:shake=0.1g0@15s"}) {
    const auto fault = sim::parse_fault(text, context);
    plumb::MonitorSetup setup;
    setup.model = tool.datasheet.model();
    setup.array = *tool.datasheet.array();
    static plumb::HealthMonitor monitor;
    auto run = sim::Simulator::make(sim::drilling_run(tool, 2, {*fault}));
    if (!monitor.configure(setup)) return 1;
    for (plumb::Sample sample; run->next(sample);) monitor.step(sample);
    std::printf("%s: %s\n", sim::describe(*fault, context).c_str(), plumb::to_string(monitor.verdict().state));
  }
}
