#include "plumb/detection/alarm_form.hpp"

#include <cmath>

#include "plumb/detection/estimate_error.hpp"
#include "plumb/numeric/cholesky.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

using std::size_t;

/// |r|^2 in the metric of noise and calibration together.
double parity_square(const SensorArray& array, const BlockEvidence& block, SensorSet set, const Vec3& x) noexcept {
  const ParityBasis basis = parity_basis(array, set);
  const int rows = basis.rows, n = array.size();
  std::array<double, kCapacity> r{}, solved{};
  std::array<double, size_t{kCapacity} * kCapacity> m{};
  for (int a = 0; a < rows; ++a) {
    const auto& va = basis.weight[static_cast<size_t>(a)];
    std::array<double, kCapacity> spread{};  // row a times C_cal
    for (int i = 0; i < n; ++i) {
      if (!set.has(i)) continue;
      r[static_cast<size_t>(a)] += va[static_cast<size_t>(i)] * block.mean_mps2[static_cast<size_t>(i)];
      for (int j = 0; j < n; ++j) {
        if (set.has(j)) spread[static_cast<size_t>(j)] += va[static_cast<size_t>(i)] * array.uncertainty().at(i, j, x);
      }
    }
    for (int b = 0; b <= a; ++b) {
      double sum = 0.0;
      for (int j = 0; j < n; ++j) {
        if (set.has(j))
          sum += spread[static_cast<size_t>(j)] * basis.weight[static_cast<size_t>(b)][static_cast<size_t>(j)];
      }
      m[static_cast<size_t>(a) * kCapacity + static_cast<size_t>(b)] = (a == b ? 1.0 : 0.0) + block.samples * sum;
    }
    r[static_cast<size_t>(a)] *= std::sqrt(block.samples);
  }
  solved = r;
  // Identity plus a covariance: a pivot of 0 would take a covariance that is none. Noise alone decides then.
  if (cholesky_factor(m.data(), rows, kCapacity)) cholesky_solve(m.data(), rows, kCapacity, solved.data());
  double square = 0.0;
  for (int a = 0; a < rows; ++a) square += r[static_cast<size_t>(a)] * solved[static_cast<size_t>(a)];
  return square;
}

}  // namespace

SetTest in_quadrature(const SensorArray& array, const GravityReference& gravity, const BlockEvidence& block,
                      SensorSet set, const SetTest& test, double acceleration_mps2) noexcept {
  SetTest out = test;
  if (!test.tested) return out;
  if (test.parity_rows > 0) {
    const double square = parity_square(array, block, set, test.x_mps2);
    out.parity = std::sqrt(square > 0.0 ? square : 0.0);
  }
  const double length = norm(test.x_mps2);
  const Vec3 u = length > 0.0 ? scaled(test.x_mps2, 1.0 / length) : Vec3{0.0, 0.0, 1.0};
  const double left = dot(u, times(calibration_covariance(array, test, set), u));
  const double variance = test.norm_sigma_mps2 * test.norm_sigma_mps2 / block.samples + (left > 0.0 ? left : 0.0) +
                          gravity.sigma_mps2 * gravity.sigma_mps2;
  const double sigma = std::sqrt(variance);
  out.norm = test.norm_error_mps2 / sigma;
  // Drift since the calibration is a bound as well, and the metric of noise and calibration makes it no longer.
  const ToleranceBound drift = tolerance_bound(array, block, set, test);
  out.parity_systematic = drift.parity;
  out.norm_systematic =
      (block.spread_mps2_sq / (2.0 * gravity.g_mps2) + block.motion_mps2 + acceleration_mps2 + drift.norm_mps2) / sigma;
  out.systematic = std::sqrt(drift.parity * drift.parity + out.norm_systematic * out.norm_systematic);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
