/// Mirrors: what a wrong reading or a wrong mounting of one sensor of a triple must be so that the triple still
/// measures the right length (theorem T1).
#pragma once

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Column of the triple's inverse that belongs to its `member` (0..2): how the vector moves with that sensor's reading.
/// Zero where the triple has no inverse, or either argument is out of range.
Vec3 triple_weight(const SensorArray& array, int triple, int member) noexcept;

/// f*: the error of that member's reading which turns gravity g into its mirror image in the plane of the other two
/// axes, so that the length stays as it was: -2 g.w/|w|^2 [unit of g]. Any other error but 0 changes the length,
/// | |x|^2 - |g|^2 | = |w|^2 |f| |f - f*|. Zero where there is no inverse.
double mirror_error(const SensorArray& array, int triple, int member, const Vec3& g) noexcept;

/// Axis along which that member would have to be mounted to read the mirror value at every attitude: a remount that the
/// length of this triple's vector never shows. A unit vector; zero where there is no inverse.
Vec3 mirror_axis(const SensorArray& array, int triple, int member) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
