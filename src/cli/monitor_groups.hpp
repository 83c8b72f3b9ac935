/// plumb monitor --group: the other groups of sensors of a tool in the same run, and the checks between them.
#pragma once

#include "monitor_options.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// One array, as `plumb monitor` without groups runs it. `beside`: a sink beside those that were asked for; may be
/// null.
io::ExitCode monitor_array(const MonitorOptions& options, session::VerdictSink* beside);

/// The accelerometers, then each group that was asked for, each with files of its own ("events-mag.jsonl"), then what
/// they say together.
io::ExitCode monitor_tool(const MonitorOptions& options);

/// "V.jsonl" -> "V-mag.jsonl"; what is empty or "-" stays.
std::string name_for_group(const std::string& path, const std::string& group);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
