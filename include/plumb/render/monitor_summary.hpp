/// What `plumb monitor` says of a run when it has ended.
#pragma once

#include <string>

#include "plumb/io/json_fields.hpp"
#include "plumb/render/motion_words.hpp"
#include "plumb/session/monitor_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// `days` since the calibration, and what is told of motion, here and below.
std::string summary_text(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors,
                         double days, const MotionTold& motion = {});

/// For --json, as one line; `roll_test` is null where there was none.
std::string summary_json(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors,
                         double days, const io::Json& roll_test, const MotionTold& motion = {});

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
