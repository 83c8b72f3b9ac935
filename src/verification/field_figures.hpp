/// Errors in the fine unit of what the sensors measure (private to src/verification).
#pragma once

#include <fmt/format.h>

#include <string>

#include "plumb/io/field.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

/// "5 mg0", "500 nT".
inline std::string fine_words(double inside, io::FieldKind field, int digits) {
  const io::FieldUnits& units = io::units_of(field);
  return fmt::format("{:.{}g} {}", units.fine_per_inside * inside, digits, units.fine);
}

inline bool is_magnetic(io::FieldKind field) noexcept { return field == io::FieldKind::magnetic; }

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
