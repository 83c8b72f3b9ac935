/// Units. Inside plumb everything is SI; names at boundaries carry their unit (`_mps2`, `_rad`).
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Standard gravity [m/s^2], exact. The only meaning of "g0" in plumb; a bare "g" is refused.
inline constexpr double kG0_mps2 = 9.80665;
inline constexpr double kPi = 3.14159265358979323846;

constexpr double rad_from_deg(double deg) noexcept { return deg * (kPi / 180.0); }
constexpr double deg_from_rad(double rad) noexcept { return rad * (180.0 / kPi); }
constexpr double mps2_from_g0(double g0) noexcept { return g0 * kG0_mps2; }
constexpr double g0_from_mps2(double mps2) noexcept { return mps2 / kG0_mps2; }

}  // namespace PLUMB_ABI
}  // namespace plumb
