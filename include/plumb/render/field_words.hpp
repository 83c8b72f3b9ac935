/// Results of a group of sensors in the units and the words of its field (plumb/io/field.hpp). Of accelerometers
/// nothing changes.
#pragma once

#include <string>

#include "plumb/io/array_file.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// An error in the fine unit of the array: mg0, nT.
double in_fine(const io::ArrayFile& array, double inside) noexcept;
const char* fine_unit(const io::ArrayFile& array) noexcept;

/// A text for people, written as of gravity, with every number in the fine or the coarse unit of the field already:
/// "mg0", "m/s^2", "gravity" become "nT", "uT", "the magnetic field".
std::string in_field_words(std::string text, io::FieldKind field);

/// A result for machines: keys that end in _mps2, _per_mps2, _mps2_2, _mps2_per_h or _per_g0 take the field's unit, and
/// their numbers with them; "gravity" in a key becomes "field".
io::Json in_field_units(const io::Json& value, io::FieldKind field);
/// The same of one line of JSON.
std::string in_field_units(const std::string& line, io::FieldKind field);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
