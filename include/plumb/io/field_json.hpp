/// Results of a group of sensors as JSON, in the units of its field (plumb/io/field.hpp). Of accelerometers nothing
/// changes.
#pragma once

#include <string>

#include "plumb/io/field.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Keys that end in _mps2, _per_mps2, _mps2_2, _mps2_per_h or _per_g0 take the field's unit, and their numbers with
/// them; "gravity" in a key becomes "field", "acceleration" "disturbance".
Json in_field_units(const Json& value, FieldKind field);
/// The same of one line of JSON.
std::string in_field_units(const std::string& line, FieldKind field);

/// For a page that shows errors in mg0, and lengths and scales in m/s^2: the same keys, with such numbers that what it
/// shows is in the fine and the coarse unit of the field.
Json with_fine_as_mg0(const Json& value, FieldKind field);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
