/// The part of the JSON report that tells of temperature.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

nlohmann::ordered_json temperature_json(const CalibrationRun& run, const io::ArrayFile& array);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
