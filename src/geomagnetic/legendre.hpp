// Associated Legendre functions as the field's gradient needs them, without a division by the sine of the colatitude.
#pragma once

#include <array>

#include "plumb/geomagnetic/field_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {

/// Schmidt semi-normalised P(n, m) of cos(theta), its derivative to theta, and P(n, m) / sin(theta) for m >= 1, all
/// finite at the poles. By `coefficient_index`.
struct LegendreTable {
  std::array<double, kCoefficientCount> value{}, slope{}, over_sine{};
};

/// Forward recurrences in the degree, of the regular functions P(n, m) / sin(theta) where m >= 1 (Holmes and
/// Featherstone, J. Geodesy 76, 2002, equations (11) to (13), in Schmidt's normalisation).
LegendreTable legendre_table(double cos_theta, double sin_theta) noexcept;

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb
