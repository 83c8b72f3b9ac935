/// Cosine and sine from the four operations alone: the same bits from every C library and every machine. std::cos and
/// std::sin differ in the last digit of one value in thirty, on some processors from others with one and the same
/// library.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct CirclePoint {
  double cosine = 1.0, sine = 0.0;
};

/// The point of the unit circle at that angle, the nearest doubles but for one in a million: |angle_rad| <= 8; NaN
/// beyond.
CirclePoint circle_point(double angle_rad) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
