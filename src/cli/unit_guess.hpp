/// Which unit the numbers of a log are in, where it cannot be the one that the array file states.
#pragma once

#include <string>
#include <vector>

#include "plumb/core/sample.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Length of the vector by the nominal model over gravity, median over the stations; 0 where none has one.
double length_factor(const io::ArrayFile& array, const std::vector<Station>& stations);

/// Whether that is so far from 1 that the numbers cannot be in the unit, or of the scale, that the array file states.
bool of_another_unit(const io::ArrayFile& array, const std::vector<Station>& stations);

/// ": they look like mV" for a vector that is `factor` times as long as gravity, or what else to look at. Empty where
/// the factor is near 1.
std::string likely_unit(const io::ArrayFile& array, double factor);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
