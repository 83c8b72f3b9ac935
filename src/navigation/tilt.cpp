#include "plumb/navigation/tilt.hpp"

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/numeric/hypotenuse.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

/// An angle of which nothing is known is uniform on the circle; no sigma is larger than that one.
double bounded_sigma(double variance) noexcept {
  const double unknown = kPi / std::sqrt(3.0);
  if (variance <= 0.0) return 0.0;
  const double sigma = std::sqrt(variance);
  return sigma < unknown ? sigma : unknown;  // NaN ends here too
}

double quadratic(const Mat3& c, const Vec3& v) noexcept { return dot(v, times(c, v)); }

/// Variance of the inclination for a unit gravity vector u with horizontal part h, covariance relative.
double inclination_variance(const Vec3& u, double h, const Mat3& c) noexcept {
  if (h > 0.0) {
    const Vec3 gradient = {u[2] * u[0] / h, u[2] * u[1] / h, -h};
    return quadratic(c, gradient);
  }
  // Along the pole every horizontal direction is the gradient of some error: take the worst.
  const double mean = 0.5 * (c[0] + c[4]);
  return mean + hypotenuse(0.5 * (c[0] - c[4]), 0.5 * (c[1] + c[3]));
}

double wrapped(double angle_rad) noexcept {
  const double positive = angle_rad < 0.0 ? angle_rad + 2.0 * kPi : angle_rad;
  return positive >= 2.0 * kPi ? 0.0 : positive;  // a tiny negative angle rounds up to the full turn
}

}  // namespace

Tilt tilt_of(const Vec3& gravity_mps2, const Mat3& covariance, double min_inclination_rad) noexcept {
  Tilt out;
  for (const double g : gravity_mps2) {
    if (!std::isfinite(g)) return out;
  }
  const double largest =
      std::fmax(std::fabs(gravity_mps2[0]), std::fmax(std::fabs(gravity_mps2[1]), std::fabs(gravity_mps2[2])));
  if (!(largest > 0.0)) return out;
  // Scaled first, so that no finite vector overflows or vanishes in a square.
  Vec3 u = {gravity_mps2[0] / largest, gravity_mps2[1] / largest, gravity_mps2[2] / largest};
  const double length = norm(u);
  u = scaled(u, 1.0 / length);
  Mat3 relative = covariance;
  for (double& c : relative) c = c / largest / largest / length / length;

  const double h = hypotenuse(u[0], u[1]);
  out.inclination_rad = std::atan2(h, u[2]);
  out.inclination_sigma_rad = bounded_sigma(inclination_variance(u, h, relative));
  out.inclination_valid = true;
  if (h > 0.0) {
    out.toolface_rad = wrapped(std::atan2(-u[0], -u[1]));
    const Vec3 gradient = {u[1] / h / h, -u[0] / h / h, 0.0};
    out.toolface_sigma_rad = bounded_sigma(quadratic(relative, gradient));
  } else {
    out.toolface_sigma_rad = kPi / std::sqrt(3.0);
  }
  out.toolface_valid = out.inclination_rad > min_inclination_rad && out.inclination_rad < kPi - min_inclination_rad;
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
