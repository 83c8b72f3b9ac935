/// What many sources write of numbers.
#pragma once

#include <cstddef>
#include <limits>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace numbers {  // of its own: short names, which a user's source may have as well

/// A sensor's number as the index of an array.
constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace numbers
}  // namespace PLUMB_ABI
}  // namespace plumb
