/// What a case ought to show, worked out from the truth without any code that the monitor uses (private to
/// src/testing).
#pragma once

#include "plumb/testing/case.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace testing {

/// Beyond every limit by eight sigmas and more, in standard deviations of a block's mean.
inline constexpr double kFarShift = 16.0;

/// How far a bias moves the parity of a block, in its standard deviations.
double parity_shift(const Case& c, int sensor, double bias_mps2);

/// Every three axes are independent, and over the stations `from` .. `until` (numbers behind those of validation) every
/// triple that holds a faulty sensor misses the length of gravity by far at one of them, every four that hold one
/// disagree by far at each.
bool told_apart(const Case& c, SensorSet faulty, int from, int until);

}  // namespace testing
}  // namespace PLUMB_ABI
}  // namespace plumb
