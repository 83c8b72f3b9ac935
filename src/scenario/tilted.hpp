/// Small turns of a sensitive axis (private to src/scenario).
#pragma once

#include "plumb/core/config.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/scenario/attitude.hpp"
#include "plumb/scenario/portable_math.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// Turns `axis` by the angles a and b [rad] about two directions across it: one rotation by their
/// vector sum, so that the length stays 1 and the order does not matter.
inline Vec3 tilted(const Vec3& axis, double a_rad, double b_rad) noexcept {
  const Vec3 first = perpendicular_to(axis);
  const Vec3 second = cross(axis, first);
  const Vec3 way = plus(scaled(first, a_rad), scaled(second, b_rad));
  const double angle_rad = norm(way);
  if (!(angle_rad > 0.0)) return axis;
  const SinCos turn = portable_sincos(angle_rad);
  const Vec3 v = plus(scaled(axis, turn.cos), scaled(way, turn.sin / angle_rad));
  return scaled(v, 1.0 / norm(v));
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
