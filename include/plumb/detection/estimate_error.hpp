/// How far the estimate of a tested set may be off: by what calibration leaves, by drift within the tolerances, by an
/// acceleration within its bound, by noise (docs/theory.md, sections 3 and 7).
#pragma once

#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Covariance of x over the set that calibration leaves at this attitude [(m/s^2)^2]; zero where the
/// set was not tested.
Mat3 calibration_covariance(const SensorArray& array, const SetTest& test, SensorSet set) noexcept;

/// 1-sigma of the direction of x that calibration leaves: `tilt_sigma_rad` of the above, without making it.
double calibration_tilt_sigma_rad(const SensorArray& array, const SetTest& test, SensorSet set) noexcept;

/// What the reading of sensor i adds to x, for a member of the tested set: a column of the least-squares map.
Vec3 estimate_column(const SensorArray& array, const SetTest& test, int i) noexcept;

/// What errors within the tolerances of the block can do to the residuals of a set, whatever their signs: to parity in
/// standard deviations of the block mean, to the length in m/s^2. Zero where the set was not tested.
struct ToleranceBound {
  double parity = 0.0, norm_mps2 = 0.0;
};
ToleranceBound tolerance_bound(const SensorArray& array, const BlockEvidence& block, SensorSet set,
                               const SetTest& test) noexcept;

/// Largest turn of the estimate over the set by errors within the tolerances of the block, whatever their signs.
double tolerance_turn_rad(const SensorArray& array, const BlockEvidence& block, SensorSet set,
                          const SetTest& test) noexcept;

/// How far the direction of what the sensors feel may be from that of gravity under any acceleration of at most
/// `bound_mps2`: |a| <= A < G leaves g + a within asin(A / G) of g. pi from G on. G is taken 3 sigmas short.
double acceleration_turn_rad(const GravityReference& gravity, double bound_mps2) noexcept;

/// 1-sigma of the direction of x from a covariance, in rad: root of the part across x over its length.
/// pi where x has no length.
double tilt_sigma_rad(const Vec3& x_mps2, const Mat3& covariance) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
