/// Built-in geometries. Every function fills `axes` with unit vectors and returns their number.
#pragma once

#include <array>

#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using AxisList = std::array<Vec3, kCapacity>;

/// The paper's four (eq 16): three on a cone about z, the fourth along z.
int paper_tetrahedron(AxisList& axes) noexcept;
/// Orthogonal triad x, y, z.
int orthogonal_triad(AxisList& axes) noexcept;
/// n axes on a cone about z. `half_angle_rad` <= 0 picks acos(1/sqrt(3)), for which H'H = n/3 I.
/// Returns 0 where n < 3 or n > capacity, or the half angle is beyond pi.
int cone(AxisList& axes, int n, double half_angle_rad = 0.0) noexcept;
/// n-1 axes on a cone and one along z (half angle so that H'H is a multiple of I).
int cone_with_axis(AxisList& axes, int n) noexcept;
/// One axis per pair of opposite faces (Platonic sets): n = 3 cube, 4 octahedron, 6 dodecahedron,
/// 10 icosahedron; 0 for any other n or beyond the capacity.
int platonic(AxisList& axes, int n) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
