/// plumb monitor --group: the other groups of sensors of a tool in the same run, and the checks between them.
#pragma once

#include "monitor_options.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// The accelerometers and each group that was asked for, in step over one pass of the log, with files of their own
/// ("events-mag.jsonl"), and what they say together.
io::ExitCode monitor_tool(const MonitorOptions& options);

/// "V.jsonl" -> "V-mag.jsonl"; what is empty or "-" stays.
std::string name_for_group(const std::string& path, const std::string& group);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
