/// Inclination, toolfaces and azimuth of a station with their covariance.
#pragma once

#include <array>

#include "plumb/survey/angle.hpp"
#include "plumb/survey/measurement.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// An angle counts as undefined within so many sigma of where it is: beyond, the first order of the propagation errs by
/// less than 1/25 of the angle's own error.
inline constexpr double kUndefinedWithinSigmas = 5.0;

/// With h = hypot(Gx, Gy):
///   inclination        atan2(h, Gz), 0 to pi
///   gravity toolface   atan2(-Gx, -Gy), from the high side
///   magnetic toolface  atan2(Bx, By), from magnetic north for a tool near vertical
///   azimuth            atan2(|G| (Gx By - Gy Bx), Bz h^2 - Gz (Gx Bx + Gy By))
/// (Williamson, SPE 67616; Gx = -g sin I sin t, Gy = -g sin I cos t, Gz = g cos I). Covariances are of first order.
struct Attitude {
  OrUndefined<Angle> inclination;
  OrUndefined<Angle> gravity_toolface;
  OrUndefined<Angle> magnetic_toolface;
  OrUndefined<MagneticAzimuth> azimuth;
  /// Of (inclination, gravity toolface, magnetic toolface, azimuth) [rad^2], row-major; rows of undefined ones are 0.
  std::array<double, 16> covariance{};
};

/// `total` is the covariance of the station's six components, tool errors included.
Attitude attitude_of(const Measurement& station, const Covariance6& total);

/// Derivatives of the four angles to the six components, row-major 4 x 6; rows are 0 where the angle has none.
std::array<double, 24> angle_jacobian(const Vec3& gravity_mps2, const Vec3& field_tesla) noexcept;

/// Length of gravity, length of the field, and dip asin(G.B / |G| |B|), by atan2.
struct Totals {
  double gravity_mps2 = 0.0;
  double field_tesla = 0.0;
  double dip_rad = 0.0;
};
Totals totals_of(const Vec3& gravity_mps2, const Vec3& field_tesla) noexcept;
/// Their derivatives to the six components, row-major 3 x 6. At a dip of 90 degrees, which every error makes smaller,
/// that of a direction across.
std::array<double, 18> totals_jacobian(const Vec3& gravity_mps2, const Vec3& field_tesla) noexcept;

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
