/// What `plumb monitor` says of a run when it has ended.
#pragma once

#include <string>

#include "monitor_pipeline.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// `days` since the calibration, here and below.
std::string summary_text(const MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors, double days);

/// For --json, as one line; `roll_test` is null where there was none.
std::string summary_json(const MonitorRun& run, const SensorArray& sensors, const Mat3& frame, double days,
                         const io::Json& roll_test);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
