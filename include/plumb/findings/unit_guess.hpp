/// Which unit the numbers of a log are in, where it cannot be the one that the array file states.
#pragma once

#include <cstdint>
#include <vector>

#include "plumb/core/sample.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Length of the vector by the nominal model over gravity, median over the stations; 0 where none has one.
double length_factor(const io::ArrayFile& array, const std::vector<Station>& stations);

/// Whether that is so far from 1 that the numbers cannot be in the unit, or of the scale, that the array file states.
bool of_another_unit(const io::ArrayFile& array, const std::vector<Station>& stations);

/// What the numbers of a log are likely to be.
struct UnitGuess {
  enum class Kind : std::uint8_t { none, unit, counts, volts };
  Kind kind = Kind::none;
  const char* unit = "";  ///< its name, where it is one that is known
};
/// Of a vector that is `factor` times as long as gravity; none where the factor is near 1, or nothing fits.
UnitGuess likely_unit(const io::ArrayFile& array, double factor);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
