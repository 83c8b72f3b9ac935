/// Units of the figures on a page or in a table.
#pragma once

#include <cstddef>
#include <string>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

inline constexpr double kMg0 = 1e3 / kG0_mps2;  ///< m/s^2 -> mg0

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

inline double in_mg0(double mps2) noexcept { return 1e3 * g0_from_mps2(mps2); }

/// A formatted number without the minus sign of a zero, whatever was rounded to it: "-0.00" is "0.00". Every number of
/// a text or a page that may be negative goes through here.
inline std::string unsigned_zero(std::string number) {
  const bool zero = number.find('0') != std::string::npos && number.find_first_of("123456789") == std::string::npos;
  if (zero && number.front() == '-') number.erase(0, 1);
  return number;
}

/// With so many decimals.
std::string fixed_words(double value, int decimals);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
