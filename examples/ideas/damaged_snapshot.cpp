// One bit of a snapshot flips in flash: it is refused by name, and the monitor runs without its history.
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
  static std::array<std::uint8_t, plumb::HealthMonitor::snapshot_size_max()> flash;
  if (!monitor.configure(setup)) return 1;
  const plumb::Expected<std::size_t> size = monitor.snapshot(flash.data(), flash.size());
  if (!size) return 1;
  flash[*size / 2] ^= 1;
  const plumb::Expected<void> taken = monitor.restore(setup, flash.data(), *size);
  if (taken) return 1;
  std::printf("%s\n%s\n", plumb::describe(taken.error().code), plumb::remedy(taken.error().code));
  std::printf("%s, %s\n", plumb::to_string(monitor.verdict().state), plumb::to_string(monitor.verdict().cause));
}
