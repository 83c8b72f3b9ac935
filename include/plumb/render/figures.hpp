/// Units of the figures on a page or in a table.
#pragma once

#include <cstddef>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

inline constexpr double kMg0 = 1e3 / kG0_mps2;  ///< m/s^2 -> mg0

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

inline double in_mg0(double mps2) noexcept { return 1e3 * g0_from_mps2(mps2); }

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
