/// What a run shows of its sensors one by one, beside the state: noise of one, full scale, drift rate, blocks in
/// motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/findings/common_cause.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/session/monitor_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

struct SensorNote {
  std::string label;  ///< of its line in the summary
  std::string text;
  std::string remedy;  ///< empty: none is needed
};

/// One cause that explains what the run showed as well as several faults.
std::optional<findings::CommonCause> common_cause_of(const session::MonitorRun& run, const io::ArrayFile& array);

/// A common cause, noisy sensors, readings at full scale and drift rates, in this order; only what was found.
std::vector<SensorNote> sensor_notes(const session::MonitorRun& run, const io::ArrayFile& array,
                                     const SensorArray& sensors);

/// As lines of the summary, with the blocks in motion before them.
std::string notes_text(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors);

/// As things to do.
std::vector<std::string> note_actions(const session::MonitorRun& run, const io::ArrayFile& array,
                                      const SensorArray& sensors);

/// For --json; null where there is none.
io::Json common_cause_json(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors);

/// "123 of 456 (27 %)"; empty where it was not counted.
std::string motion_words(const session::MonitorRun& run);

/// null where it was not counted; 0 where there is no block.
io::Json motion_share(const session::MonitorRun& run);

/// The figures of sensor i that stand in the summary and in the health report alike.
void put_sensor_counts(io::Json& out, const session::MonitorRun& run, const io::ArrayFile& array,
                       const SensorArray& sensors, int i);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
