/// The state machine, printed from the one table that runs in the monitor.
#pragma once

#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// A Markdown table: events in rank order by modes; modes with the same row share a column.
std::string machine_markdown();
/// For Graphviz.
std::string machine_graph();
/// Every cell, for machines.
std::string machine_json();

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
