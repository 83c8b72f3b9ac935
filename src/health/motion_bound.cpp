#include "plumb/health/detail/motion_bound.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

/// The greatest of n squares is no less than their mean, and their sum no less than the least eigenvalue of sum h h'.
/// That is the determinant over the product of the other two, which is no more than the square of their mean; each
/// round takes the eigenvalue found so far from the trace, and so stays below it.
double least_share_felt(const SensorArray& array, SensorSet used) noexcept {
  Mat3 m{};
  for (int i = 0; i < array.size(); ++i) {
    if (!used.has(i)) continue;
    const Vec3& h = array.axis(i);
    for (size_t k = 0; k < 9; ++k) m[k] += h[k / 3] * h[k % 3];
  }
  const double determinant = dot({m[0], m[1], m[2]}, cross({m[3], m[4], m[5]}, {m[6], m[7], m[8]}));
  if (!(determinant > 0.0)) return 0.0;
  double least = 0.0;
  for (int round = 0; round < 4; ++round) {
    const double mean = 0.5 * (m[0] + m[4] + m[8] - least);
    least = determinant / (mean * mean);
  }
  return std::sqrt(least / used.size());
}

double hidden_turn_rad(const InForce& in_force, SensorSet in_service, SensorSet used, double scatter_factor,
                       double noise_factor) noexcept {
  const double share = least_share_felt(in_force.array, used);
  if (!(share > 0.0) || !(scatter_factor > 1.0)) return 0.0;  // a row that is a station has no scatter
  double most_mps2 = 0.0;
  for (int i = 0; i < in_force.array.size(); ++i) {
    if (in_service.has(i)) most_mps2 = std::fmax(most_mps2, in_force.array.sigma_mps2(i) * noise_factor);
  }
  return std::sqrt(12.0 * (scatter_factor - 1.0)) * most_mps2 / (share * in_force.gravity.g_mps2);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
