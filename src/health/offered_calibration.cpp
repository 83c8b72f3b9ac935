#include "plumb/health/detail/offered_calibration.hpp"

#include <cmath>

#include "plumb/array/geometry.hpp"
#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

using Row = std::array<double, 4>;         // of a sensor's parameters: W_x, W_y, W_z, b
using PairBlock = std::array<double, 16>;  // of two sensors' parameters, by rows

constexpr std::size_t packed_at(int a, int b) noexcept {
  return at(a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a);
}

/// Scale changes W along the axis, bias is b.
Row direction_of(const SensorArray& array, int parameter) noexcept {
  const Vec3& h = array.axis(parameter / 2);
  return parameter % 2 == 0 ? Row{h[0], h[1], h[2], 0.0} : Row{0.0, 0.0, 0.0, 1.0};
}

double covariance_along(const SensorArray& array, int i, const Row& a, int j, const Row& b) noexcept {
  double sum = 0.0;
  for (int p = 0; p < 4; ++p) {
    for (int q = 0; q < 4; ++q) sum += a[at(p)] * array.row_covariance(4 * i + p, 4 * j + q) * b[at(q)];
  }
  return sum;
}

/// L C R', where a side that is taken over keeps only what lies across its axis.
PairBlock kept_part(const SensorArray& array, int i, bool i_taken, int j, bool j_taken) noexcept {
  const auto across = [&array](int sensor, bool taken, int p, int q) {
    if (!taken) return p == q ? 1.0 : 0.0;
    if (p == 3 || q == 3) return 0.0;
    return (p == q ? 1.0 : 0.0) - array.axis(sensor)[at(p)] * array.axis(sensor)[at(q)];
  };
  PairBlock half{}, out{};
  for (int p = 0; p < 4; ++p) {
    for (int q = 0; q < 4; ++q) {
      for (int k = 0; k < 4; ++k) {
        half[at(4 * p + q)] += across(i, i_taken, p, k) * array.row_covariance(4 * i + k, 4 * j + q);
      }
    }
  }
  for (int p = 0; p < 4; ++p) {
    for (int q = 0; q < 4; ++q) {
      for (int k = 0; k < 4; ++k) out[at(4 * p + q)] += half[at(4 * p + k)] * across(j, j_taken, q, k);
    }
  }
  return out;
}

/// 1 sigma of an axis, in one direction across it [rad].
double axis_sigma_rad(const SensorArray& array, int i) noexcept {
  const PairBlock across = kept_part(array, i, true, i, true);
  return std::sqrt(std::fmax(0.0, across[0] + across[5] + across[10]) / 2.0);
}

}  // namespace

double OfferedCalibration::variance(int parameter) const noexcept {
  return covariance_[packed_at(parameter, parameter)];
}

/// What is wrong with the calibration of one sensor at sight.
Error OfferedCalibration::check(const SensorArray& now_array, const SensorArray& array, int i,
                                const DriftBounds& bounds) const noexcept {
  const double limit_rad = DriftBounds::kCommissioningSigmas * std::fmax(kAxis_rad, axis_sigma_rad(now_array, i));
  const double off_rad = angle_between_rad(array.axis(i), now_array.axis(i));
  if (!(off_rad <= limit_rad)) return Error{Errc::implausible, i, off_rad, limit_rad};
  const double worst = std::fmax(std::sqrt(variance(2 * i)) / bounds.sigma(i).scale,
                                 std::sqrt(variance(2 * i + 1)) / bounds.sigma(i).bias_mps2);
  const double least = std::fmin(variance(2 * i), variance(2 * i + 1));
  if (!(least > 0.0 && worst <= 1.0)) return Error{Errc::implausible, i, worst, 1.0};
  return Error{};
}

Error OfferedCalibration::read(const SensorModel& now, const SensorArray& now_array, const SensorModel& model,
                               const SensorArray& array, SensorSet sensors, const DriftBounds& bounds,
                               CoefficientChange& change) noexcept {
  const int n = now_array.size();
  clear();
  if (model.size != n || array.size() != n) return Error{Errc::not_calibrated, -1, 1.0 * model.size, 1.0 * n};
  for (const double m : model.misalignment) {
    if (m != 0.0) return Error{Errc::not_calibrated, -1, m, 0.0};
  }
  for (int a = 0; a < 2 * n; ++a) {
    for (int b = 0; b <= a; ++b) {
      covariance_[packed_at(a, b)] =
          covariance_along(array, a / 2, direction_of(array, a), b / 2, direction_of(array, b));
    }
  }
  for (int i = 0; i < n; ++i) {
    if (!sensors.has(i)) continue;
    const Error error = check(now_array, array, i, bounds);
    if (error.code != Errc::ok) return error;
    const SensorCoefficients& c = now.sensor[at(i)];
    change.length[at(i)] = model.scale_at(i, c.reference_degc) / c.scale[0];
    change.shift_mps2[at(i)] = model.bias_at(i, c.reference_degc) * change.length[at(i)] - c.bias[0];
  }
  return Error{};
}

void OfferedCalibration::uncertainty(const SensorArray& array, SensorSet sensors, RowUncertainty& out) const noexcept {
  out = array.uncertainty();
  out.common_scale = 0.0;  // the rows taken over and those that stay have their own
  for (int i = 0; i < array.size(); ++i) {
    for (int j = 0; j <= i; ++j) {
      const bool both = sensors.has(i) && sensors.has(j);
      const PairBlock kept = kept_part(array, i, sensors.has(i), j, sensors.has(j));
      for (int p = 0; p < 4; ++p) {
        for (int q = 0; q < (i == j ? p + 1 : 4); ++q) {
          double sum = kept[at(4 * p + q)];
          for (int k = 0; both && k < 4; ++k) {
            const int a = 2 * i + k / 2, b = 2 * j + k % 2;
            sum += direction_of(array, a)[at(p)] * covariance_[packed_at(a, b)] * direction_of(array, b)[at(q)];
          }
          out.covariance[packed_at(4 * i + p, 4 * j + q)] = sum;
        }
      }
    }
  }
}

bool OfferedCalibration::plausible(int configured, SensorSet sensors, const DriftBounds& bounds) const noexcept {
  if (sensors_ != configured) return false;
  for (int a = 0; a < 2 * sensors_; ++a) {
    for (int b = 0; b <= a; ++b) {
      const double c = covariance_[packed_at(a, b)];
      if (!(c * c <= variance(a) * variance(b) * (1.0 + 1e-9))) return false;
    }
    const double limit = a % 2 == 0 ? bounds.sigma(a / 2).scale : bounds.sigma(a / 2).bias_mps2;
    const bool sane = variance(a) > 0.0 && variance(a) <= limit * limit;
    if (sensors.has(a / 2) && !sane) return false;
  }
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
