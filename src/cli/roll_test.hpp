/// --roll-test: a recorded roll test, played through the monitor before the log.
#pragma once

#include <string>

#include "monitor_options.hpp"
#include "monitor_pipeline.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct RollTest {
  MonitorRun run;
  int attitudes = 0;  ///< apart from one another by the angle that tells attitudes apart
};

/// Steps all rows of the recording, and tells the monitor that time begins anew. Errors: those of the recording, whole;
/// nothing of a part of it is gone on with. Ctrl-C is left in `run.interrupted`.
io::FileExpected<RollTest> play_roll_test(HealthMonitor& monitor, const io::ArrayFile& array,
                                          const MonitorOptions& options);

/// What it came to, in one line: which sensors are validated or which turn is missing, who is out, which doubt stands,
/// and in which state the run begins.
std::string roll_test_text(const RollTest& test, const std::string& path, const HealthMonitor& monitor,
                           const Mat3& frame);
/// The same for the summary of --json.
io::Json roll_test_json(const RollTest& test, const HealthMonitor& monitor, const Mat3& frame);

/// What --roll-test cannot be, and what it cannot be combined with.
std::optional<io::FileError> roll_test_misuse(const MonitorOptions& options, const io::ArrayFile& array);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
