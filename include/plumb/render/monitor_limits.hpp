/// The limits of a monitor as a table and as JSON.
#pragma once

#include <string>

#include "plumb/findings/monitor_limits.hpp"
#include "plumb/io/field.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

std::string limits_text(const findings::MonitorLimits& limits, io::FieldKind field = io::FieldKind::gravity);
/// One JSON object.
std::string limits_json(const findings::MonitorLimits& limits, io::FieldKind field = io::FieldKind::gravity);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
