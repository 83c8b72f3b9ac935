/// Units of the figures on a page (private to src/report).
#pragma once

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {

inline constexpr double kMg0 = 1e3 / kG0_mps2;  ///< m/s^2 -> mg0

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
