/// What is known of a table of text beforehand: options of the commands that read logs of other programs.
#pragma once

#include "plumb/logs/csv_log.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// --table-separator, --table-decimal, --table-time, --table-unit, --table-rate, --table-header. `hints` outlives the
/// command.
void add_table_options(const Options& command, logs::CsvHints& hints);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
