/// The four sizes in text and JSON: the same names and figures in every command.
#pragma once

#include <string>

#include "plumb/findings/detection_sizes.hpp"
#include "plumb/io/field.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

/// Ends with a line feed.
std::string sizes_text(const findings::SizeTable& table, int sensors, io::FieldKind field);
/// SI units in the names, null where there is no such size.
Json sizes_json(const findings::SizeTable& table, int sensors);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
