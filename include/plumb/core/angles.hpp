/// Angles and their sines from additions, multiplications, divisions and roots alone: the same bits from every C
/// library and every machine, where std::sin, asin and atan2 differ by their last digits. What a monitor publishes and
/// judges by is made of these. Within 2 units in the last place of the true value.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Of the direction (x, y) from the x axis, y >= 0: 0 to pi; 0 where both are zero, NaN where one is.
double angle_of(double y, double x) noexcept;

/// The sine of an angle from -pi/2 to pi/2 [rad].
double sine_of(double angle_rad) noexcept;

/// The angle from 0 to pi/2 with that sine, 0 to 1; NaN beyond.
double angle_with_sine(double sine) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
