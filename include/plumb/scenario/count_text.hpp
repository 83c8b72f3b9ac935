/// A count and what is counted, in words: "1 row", "3 rows", "0 rows". Every sentence of plumb that counts something
/// uses this; the library of scenarios is the lowest one that makes sentences.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// `one` for a count of 1, `several` for every other one: "is" and "are", "it" and "they".
template <class Count>
std::string_view by_count(Count count, std::string_view one, std::string_view several) noexcept {
  return count == Count{1} ? one : several;
}

/// "1 row" or "3 rows". `several` is the plural, where it is not `one` with an "s": "blocks at rest". A count of
/// floating point is a whole number.
template <class Count>
std::string count_text(Count count, std::string_view one, std::string_view several = {}) {
  static_assert(std::is_arithmetic_v<Count>, "counts are numbers");
  std::string out;
  if constexpr (std::is_floating_point_v<Count>) {
    out = std::to_string(std::llround(count));
  } else {
    out = std::to_string(count);
  }
  out += ' ';
  if (count == Count{1}) return out.append(one);
  if (!several.empty()) return out.append(several);
  return out.append(one) + 's';
}

}  // namespace PLUMB_ABI
}  // namespace plumb
