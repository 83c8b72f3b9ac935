/// What a calibration leaves in the parity of an array, over all attitudes at once.
#pragma once

#include "plumb/array/sensor_array.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Largest variance that the calibration leaves in parity at any attitude, in squared standard deviations of one
/// sample: a bound of sup over |u| = 1 of lambda_max(V' C(u) V), V the parity basis of all sensors (docs/theory.md,
/// section 3.3). Parity of fewer sensors lies in that of all and has no more. Infinite where an entry is not finite.
double worst_parity_variance(const SensorArray& array, double g_mps2) noexcept;

/// The same of the least-squares vector of all sensors: the largest trace of its covariance [(m/s^2)^2].
double worst_vector_variance(const SensorArray& array, double g_mps2) noexcept;

/// sup over |u| = 1 of u'Au + 2 b'u + c, A symmetric: from above, by duality, but for rounding.
double largest_over_directions(const Mat3& a, const Vec3& b, double c) noexcept;

/// Whether all parity rows are left with one and the same 4x4 covariance, and with none between them, as a fit of all
/// sensors at every station leaves it: within 1 in 1000 of its smallest eigenvalue. With one row it is so.
bool parity_rows_alike(const SensorArray& array) noexcept;

/// By so much is the bound of rows alike only to 1 in 1000 wider.
inline constexpr double kLikeRows = 1.001;

/// sqrt of what the largest eigenvalue of W'W stays below in 995 of 1000, W a `rows` x 4 matrix of independent standard
/// normals (Roy's largest root); `rows` 1 to 21. For all attitudes and all subsets at once: |Bz|^2 <= that z'Gz.
double roys_root(int rows) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
