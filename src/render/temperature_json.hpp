/// The part of the JSON report that tells of temperature (private to src/render).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "plumb/findings/calibration_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

nlohmann::ordered_json temperature_json(const findings::CalibrationRun& run, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
