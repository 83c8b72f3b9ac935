// plumb monitor: a log or a live stream through the health monitor.
#include <memory>

#include "monitor_groups.hpp"
#include "monitor_options.hpp"
#include "monitor_watch.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr const char* kMonitorAbout =
    "Monitor an array of accelerometers: read a log (or a live stream) sample by sample, say which sensors are\n"
    "valid, which way is down, and within what bound. A table line is printed at every change of state;\n"
    "a summary follows at the end. A sensor is excluded only when no other explanation of the data is left.";

/// One array: the accelerometers of a tool, or one of its groups.
io::ExitCode monitor_array(const MonitorOptions& options) {
  const tl::expected<std::unique_ptr<ArrayWatch>, io::ExitCode> watch = ArrayWatch::begin(options);
  if (!watch) return watch.error();
  ArrayWatch& array = **watch;
  std::vector<session::LogShare> shares = {array.share()};
  const io::FileExpected<void> done = session::run_log(array.log(), shares);
  if (!done) return report(done.error());
  const io::FileExpected<void> kept = array.keep(std::move(shares.front().end));
  return kept ? array.say() : report(kept.error());
}

}  // namespace

Command add_monitor(const Options& tool) {
  auto options = std::make_shared<MonitorOptions>();
  const Options command =
      tool.add_command("monitor", "monitor a log or a live stream: which sensors are valid, which way is down");
  add_monitor_options(command, *options);
  return {command, kMonitorAbout,
          [options] { return options->groups.empty() ? monitor_array(*options) : monitor_tool(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
