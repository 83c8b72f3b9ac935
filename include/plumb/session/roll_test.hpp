/// A recorded roll test, played through the monitor before the log.
#pragma once

#include "plumb/session/monitor_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

struct RollTest {
  MonitorRun run;
  int attitudes = 0;  ///< apart from one another by the angle that tells attitudes apart
};

/// Steps all rows of the recording, and tells the monitor that time begins anew. Errors: those of the recording, whole;
/// nothing of a part of it is gone on with. Ctrl-C is left in `run.interrupted`.
io::FileExpected<RollTest> play_roll_test(HealthMonitor& monitor, const io::ArrayFile& array, const LogSpec& recording);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
