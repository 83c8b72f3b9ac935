// Small things of figures that several commands need.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

using Json = nlohmann::ordered_json;

inline constexpr double kMilliG0_mps2 = 1e-3 * kG0_mps2;

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

inline double in_mg0(double mps2) noexcept { return 1e3 * g0_from_mps2(mps2); }

/// Null where there is no figure: JSON has no infinity.
Json finite_or_null(double value);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
