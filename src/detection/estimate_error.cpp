#include "plumb/detection/estimate_error.hpp"

#include <cmath>

#include "plumb/core/angles.hpp"
#include "reach.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

Vec3 estimate_column(const SensorArray& array, const SetTest& test, int i) noexcept {
  const double sigma = array.sigma_mps2(i);
  return scaled(times(test.covariance, array.axis(i)), test.samples / (sigma * sigma));
}

Mat3 calibration_covariance(const SensorArray& array, const SetTest& test, SensorSet set) noexcept {
  Mat3 cal{};
  if (!test.tested || array.perfectly_known()) return cal;
  add_outer(cal, scaled(test.x_mps2, array.uncertainty().common_scale),
            scaled(test.x_mps2, array.uncertainty().common_scale));
  const AttitudeProducts attitude(test.x_mps2);
  std::array<Vec3, kCapacity> column{};
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    Vec3& own = column[static_cast<size_t>(i)];
    own = estimate_column(array, test, i);
    Vec3 carried{};
    for (int j = 0; j < i; ++j) {
      if (set.has(j))
        carried = plus(carried, scaled(column[static_cast<size_t>(j)], array.uncertainty().at(i, j, attitude)));
    }
    add_outer(cal, own, carried);
    add_outer(cal, carried, own);
    add_outer(cal, scaled(own, array.uncertainty().at(i, i, attitude)), own);
  }
  return cal;
}

double calibration_tilt_sigma_rad(const SensorArray& array, const SetTest& test, SensorSet set) noexcept {
  const double length = norm(test.x_mps2);
  if (!test.tested) return 0.0;
  if (!(length > 0.0)) return kPi;
  if (array.perfectly_known()) return 0.0;
  const AttitudeProducts attitude(test.x_mps2);
  const Vec3 u = scaled(test.x_mps2, 1.0 / length);
  std::array<Vec3, kCapacity> across{};
  double variance = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    const Vec3 column = estimate_column(array, test, i);
    Vec3& own = across[static_cast<size_t>(i)];
    own = minus(column, scaled(u, dot(u, column)));
    for (int j = 0; j < i; ++j) {
      if (set.has(j))
        variance += 2.0 * array.uncertainty().at(i, j, attitude) * dot(own, across[static_cast<size_t>(j)]);
    }
    variance += array.uncertainty().at(i, i, attitude) * dot(own, own);
  }
  return variance > 0.0 ? std::sqrt(variance) / length : 0.0;
}

namespace {

/// What the sensors of a set may have drifted by, for its estimate and its parity.
struct Drift {
  Reach reach;
  double whitened_sq = 0.0;
};

Drift drift_of(const SensorArray& array, const BlockEvidence& block, SensorSet set, const SetTest& test,
               double length) noexcept {
  Drift out;
  const Vec3 u = scaled(test.x_mps2, 1.0 / length);
  for (int i = 0; i < array.size(); ++i) {
    const auto tau = static_cast<double>(block.tolerance_mps2[static_cast<size_t>(i)]);
    if (!set.has(i) || !(tau > 0.0)) continue;
    const double whitened = tau / array.sigma_mps2(i);
    out.whitened_sq += whitened * whitened;
    out.reach.add(estimate_column(array, test, i), u, tau);
  }
  return out;
}

}  // namespace

ToleranceBound tolerance_bound(const SensorArray& array, const BlockEvidence& block, SensorSet set,
                               const SetTest& test) noexcept {
  ToleranceBound out;
  const double length = norm(test.x_mps2);
  if (!test.tested || !(length > 0.0)) return out;
  const Drift drift = drift_of(array, block, set, test, length);
  out.norm_mps2 = drift.reach.of_length_mps2(length);
  if (test.parity_rows > 0) out.parity = std::sqrt(drift.whitened_sq * test.samples);
  return out;
}

double tolerance_turn_rad(const SensorArray& array, const BlockEvidence& block, SensorSet set,
                          const SetTest& test) noexcept {
  const double length = norm(test.x_mps2);
  if (!test.tested || !(length > 0.0)) return 0.0;
  const Reach reach = drift_of(array, block, set, test, length).reach;
  return reach.across > 0.0 ? angle_of(reach.across, reach.least_length(length)) : 0.0;
}

double acceleration_turn_rad(const GravityReference& gravity, double bound_mps2) noexcept {
  if (!(bound_mps2 > 0.0)) return 0.0;
  const double least = gravity.g_mps2 - TestLimits::gravity * gravity.sigma_mps2;
  return bound_mps2 < least ? angle_with_sine(bound_mps2 / least) : kPi;
}

double tilt_sigma_rad(const Vec3& x_mps2, const Mat3& covariance) noexcept {
  const double length = norm(x_mps2);
  if (!(length > 0.0)) return kPi;
  const Vec3 u = scaled(x_mps2, 1.0 / length);
  const double across = covariance[0] + covariance[4] + covariance[8] - dot(u, times(covariance, u));
  return across > 0.0 ? std::sqrt(across) / length : 0.0;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
