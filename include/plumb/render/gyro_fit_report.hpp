/// What `plumb calibrate --motion` says of a fit of gyros: the report as text and as JSON.
#pragma once

#include <string>

#include "plumb/io/json_fields.hpp"
#include "plumb/session/gyro_commissioning.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

std::string gyro_fit_text(const session::GyroCommissioning& run, const io::ArrayFile& group);
io::Json gyro_fit_json(const session::GyroCommissioning& run, const io::ArrayFile& group);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
