/// Numbers with units inside the text of a fault. The io module has a larger parser for files; it stands
/// above this module, so the few units that faults need are read here, under the same names.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/scenario/fault_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// `factor` turns a number in this unit into the unit that the fault stores.
struct TextUnit {
  std::string name;
  double factor = 1.0;
  bool print = true;  ///< may be chosen by `quantity_text`
};
using TextUnits = std::vector<TextUnit>;

const TextUnits& acceleration_units(FaultContext::Vector of);  ///< -> m/s^2, 4 uT or rad/s
const TextUnits& time_units();                                 ///< -> s
const TextUnits& angle_units();                                ///< -> rad
const TextUnits& share_units();                                ///< -> 1
TextUnits drift_units(FaultContext::Vector of);                ///< -> the same per s

/// A number and the text behind it. A leading '+' is allowed.
struct NumberText {
  double value = 0.0;
  std::string_view rest;
};
tl::expected<NumberText, std::string> read_number(std::string_view text);

/// A number with one of the units, and nothing behind it. "what" names the quantity in messages.
tl::expected<double, std::string> read_quantity(std::string_view text, const TextUnits& units, const char* what);

/// Shortest decimal text of a double.
std::string shortest_text(double value);
/// Shortest text that `read_quantity` turns back into the identical double, `gap` between number and unit.
/// The first unit must have the factor 1, so that there is always one.
std::string quantity_text(double value, const TextUnits& units, const char* gap = "");

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
