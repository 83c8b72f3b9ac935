#include "plumb/calibration/sensor_model.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "fit_internal.hpp"
#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// A pivot below this times the largest entry of I - M is taken for zero.
constexpr double kPivotTolerance = 1e-12;

struct CrossSystem {
  std::array<double, std::size_t{kCapacity} * kCapacity> a{};  ///< I - M, row-major with stride kCapacity
  std::array<double, kCapacity> b{};
  int n = 0;

  double& entry(int i, int k) noexcept { return a[at(i * kCapacity + k)]; }

  void swap_rows(int i, int k) noexcept {
    for (int c = 0; c < n; ++c) {
      const double kept = entry(i, c);
      entry(i, c) = entry(k, c);
      entry(k, c) = kept;
    }
    const double kept = b[at(i)];
    b[at(i)] = b[at(k)];
    b[at(k)] = kept;
  }
};

double largest_entry(CrossSystem& s) noexcept {
  double largest = 0.0;
  for (int i = 0; i < s.n; ++i) {
    for (int k = 0; k < s.n; ++k) largest = std::fmax(largest, std::fabs(s.entry(i, k)));
  }
  return largest;
}

/// Gauss elimination with row pivots, solution left in b; false where I - M has no inverse.
bool solve_cross(CrossSystem& s) noexcept {
  const double smallest = kPivotTolerance * largest_entry(s);
  for (int c = 0; c < s.n; ++c) {
    int best = c;
    for (int i = c + 1; i < s.n; ++i) {
      if (std::fabs(s.entry(i, c)) > std::fabs(s.entry(best, c))) best = i;
    }
    // Written so that a NaN pivot is refused too.
    if (!(std::fabs(s.entry(best, c)) > smallest)) return false;
    if (best != c) s.swap_rows(best, c);
    for (int i = c + 1; i < s.n; ++i) {
      const double factor = s.entry(i, c) / s.entry(c, c);
      if (factor == 0.0) continue;
      for (int k = c; k < s.n; ++k) s.entry(i, k) -= factor * s.entry(c, k);
      s.b[at(i)] -= factor * s.b[at(c)];
    }
  }
  for (int i = s.n - 1; i >= 0; --i) {
    double sum = s.b[at(i)];
    for (int k = i + 1; k < s.n; ++k) sum -= s.entry(i, k) * s.b[at(k)];
    s.b[at(i)] = sum / s.entry(i, i);
  }
  return true;
}

}  // namespace

double SensorModel::scale_at(int i, double temperature_degc) const noexcept {
  const SensorCoefficients& c = sensor[at(i)];
  return fit::cubic(c.scale, temperature_degc - c.reference_degc);
}

double SensorModel::bias_at(int i, double temperature_degc) const noexcept {
  const SensorCoefficients& c = sensor[at(i)];
  return fit::cubic(c.bias, temperature_degc - c.reference_degc);
}

Readings SensorModel::without_misalignment(const std::array<double, kCapacity>& raw, double temperature_degc,
                                           SensorSet delivered) const noexcept {
  const double sign = reads == Reads::gravity ? 1.0 : -1.0;
  Readings out{};
  for (int i = 0; i < size; ++i) {
    if (!delivered.has(i)) continue;
    const SensorCoefficients& c = sensor[at(i)];
    const double t = temperature_degc - c.reference_degc;
    const double scale = fit::cubic(c.scale, t);
    // A cubic scale factor may pass through zero far from its calibrated span: no reading then, rather than infinity.
    const double felt =
        scale != 0.0 ? raw[at(i)] / scale - fit::cubic(c.bias, t) : std::numeric_limits<double>::quiet_NaN();
    out[at(i)] = sign * felt;
  }
  return out;
}

Readings SensorModel::apply(const std::array<double, kCapacity>& raw, double temperature_degc,
                            SensorSet delivered) const noexcept {
  const Readings direct = without_misalignment(raw, temperature_degc, delivered);
  Readings out = direct;
  for (int i = 0; i < size; ++i) {
    if (!delivered.has(i)) continue;
    double cross_terms = 0.0;
    for (int k = 0; k < size; ++k) {
      const double m = misalignment[at(i * kCapacity + k)];
      // Zero terms are skipped, not multiplied: 0 * NaN of a broken neighbour would leak.
      if (m != 0.0) cross_terms += m * direct[at(k)];
    }
    out[at(i)] = direct[at(i)] - cross_terms;
  }
  return out;
}

Expected<std::array<double, kCapacity>> SensorModel::raw_from(const Readings& accel_mps2,
                                                              double temperature_degc) const noexcept {
  const double sign = reads == Reads::gravity ? 1.0 : -1.0;
  CrossSystem system;
  system.n = size;
  for (int i = 0; i < size; ++i) {
    for (int k = 0; k < size; ++k) {
      system.entry(i, k) = (i == k ? 1.0 : 0.0) - misalignment[at(i * kCapacity + k)];
    }
    system.b[at(i)] = sign * accel_mps2[at(i)];
  }
  if (!solve_cross(system)) return fail(Errc::not_invertible);
  std::array<double, kCapacity> raw{};
  for (int i = 0; i < size; ++i) {
    raw[at(i)] = scale_at(i, temperature_degc) * (system.b[at(i)] + bias_at(i, temperature_degc));
  }
  return raw;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
