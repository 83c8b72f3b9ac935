/// Texts about a group of sensors in the units and the words of its field (plumb/io/field.hpp). Of accelerometers
/// nothing changes. The same for machines: plumb/io/field_json.hpp.
#pragma once

#include <string>

#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// An error in the fine unit of the array: mg0, nT.
double in_fine(const io::ArrayFile& array, double inside) noexcept;
const char* fine_unit(const io::ArrayFile& array) noexcept;

/// A text for people, written as of gravity, with every number in the fine or the coarse unit of the field already:
/// "mg0", "m/s^2", "gravity" become "nT", "uT", "the magnetic field".
std::string in_field_words(std::string text, io::FieldKind field);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
