/// The longest side of a right-angled triangle from the four operations and the root: the same bits from every C
/// library, where std::hypot differs in its last digit. Within 1 unit in the last place, and the nearest double in 99
/// of 100 cases.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// sqrt(x^2 + y^2), whatever the size of x and y; infinite where one is, NaN where one is and the other is finite.
double hypotenuse(double x, double y) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
