#include "plumb/array/named.hpp"

#include <cmath>
#include <cstddef>
#include <initializer_list>

#include "plumb/core/circle_point.hpp"
#include "plumb/core/detail/numbers.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// n axes at equal azimuths, the first above x, with the given cosine and sine of the half angle.
void fill_cone(AxisList& axes, int n, double cosine, double sine) noexcept {
  for (int k = 0; k < n; ++k) {
    const CirclePoint around = circle_point(2.0 * kPi * k / n);
    axes[at(k)] = {sine * around.cosine, sine * around.sine, cosine};
  }
}

Vec3 unit(double x, double y, double z) noexcept {
  const Vec3 v = {x, y, z};
  return scaled(v, 1.0 / norm(v));
}

/// The four body diagonals of a cube.
int add_diagonals(AxisList& axes, int next) noexcept {
  axes[at(next++)] = unit(1.0, 1.0, 1.0);
  axes[at(next++)] = unit(-1.0, 1.0, 1.0);
  axes[at(next++)] = unit(1.0, -1.0, 1.0);
  axes[at(next++)] = unit(-1.0, -1.0, 1.0);
  return next;
}

/// (0, a, b) and (0, -a, b) with their cyclic permutations: six lines.
int add_cyclic(AxisList& axes, int next, double a, double b) noexcept {
  for (const double s : {a, -a}) {
    axes[at(next++)] = unit(0.0, s, b);
    axes[at(next++)] = unit(s, b, 0.0);
    axes[at(next++)] = unit(b, 0.0, s);
  }
  return next;
}

}  // namespace

int paper_tetrahedron(AxisList& axes) noexcept {
  const double r2 = std::sqrt(2.0);
  const double r6 = std::sqrt(6.0);
  axes[0] = {2.0 * r2 / 3.0, 0.0, 1.0 / 3.0};
  axes[1] = {-r2 / 3.0, r6 / 3.0, 1.0 / 3.0};
  axes[2] = {-r2 / 3.0, -r6 / 3.0, 1.0 / 3.0};
  axes[3] = {0.0, 0.0, 1.0};
  return 4;
}

int orthogonal_triad(AxisList& axes) noexcept {
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = {0.0, 0.0, 1.0};
  return 3;
}

int cone(AxisList& axes, int n, double half_angle_rad) noexcept {
  if (n < 3 || n > kCapacity || !std::isfinite(half_angle_rad) || half_angle_rad > kPi) return 0;
  if (half_angle_rad <= 0.0) {
    fill_cone(axes, n, std::sqrt(1.0 / 3.0), std::sqrt(2.0 / 3.0));
  } else {
    const CirclePoint half = circle_point(half_angle_rad);
    fill_cone(axes, n, half.cosine, half.sine);
  }
  return n;
}

int cone_with_axis(AxisList& axes, int n) noexcept {
  if (n < 4 || n > kCapacity) return 0;  // a cone of two axes spans no more than a plane with its own axis
  // (n-1) cos^2 + 1 = n/3 makes the z entry of H'H equal to the other two.
  const double cosine2 = (n - 3.0) / (3.0 * (n - 1.0));
  fill_cone(axes, n - 1, std::sqrt(cosine2), std::sqrt(1.0 - cosine2));
  axes[at(n - 1)] = {0.0, 0.0, 1.0};
  return n;
}

int platonic(AxisList& axes, int n) noexcept {
  if (n > kCapacity) return 0;
  const double golden = (1.0 + std::sqrt(5.0)) / 2.0;
  switch (n) {
    case 3: return orthogonal_triad(axes);
    case 4: return add_diagonals(axes, 0);
    case 6: return add_cyclic(axes, 0, 1.0, golden);
    case 10: return add_cyclic(axes, add_diagonals(axes, 0), 1.0 / golden, golden);
    default: return 0;
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
