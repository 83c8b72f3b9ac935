/// Which way is down, as a driller says it: inclination and toolface from the gravity vector.
#pragma once

#include "plumb/core/config.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Inclination in [0, pi] and gravity toolface in [0, 2 pi), with 1-sigma from the covariance.
struct Tilt {
  double inclination_rad = 0.0;
  double toolface_rad = 0.0;
  double inclination_sigma_rad = 0.0;
  double toolface_sigma_rad = 0.0;
  bool inclination_valid = false;  ///< vector finite and not zero
  bool toolface_valid = false;     ///< inclination further than `min_inclination_rad` from 0 and pi
};

/// Inclination of the z axis against gravity and gravity toolface (ISCWSA axes: z down hole, output
/// positive downwards): I = atan2(hypot(gx, gy), gz), tau = atan2(-gx, -gy). Never acos, which loses
/// half its digits at 0 and pi. `covariance` is that of g, row-major [(m/s^2)^2]. Any input is
/// accepted; a vector that is not finite or is zero gives an invalid tilt with zeros.
Tilt tilt_of(const Vec3& gravity_mps2, const Mat3& covariance,
             double min_inclination_rad = 3.0 * 3.14159265358979323846 / 180.0) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
