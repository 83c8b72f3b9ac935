#include "plumb/detection/set_test.hpp"

#include <cmath>

#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

using std::size_t;

/// A member whose fault shows in parity with less than the root of this is one that nobody checks.
constexpr double kMinLeverage = 0.05;

/// Members of a set with their whitened rows and readings.
struct Rows {
  int count = 0;
  std::array<int, kCapacity> sensor{};
  std::array<Vec3, kCapacity> a{};    ///< h_i / sigma_i
  std::array<double, kCapacity> z{};  ///< y_i / sigma_i
  std::array<double, kCapacity> inverse_sigma{};
};

Rows gather(const SensorArray& array, const BlockEvidence& block, SensorSet set) noexcept {
  Rows rows;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    const auto k = static_cast<size_t>(rows.count);
    const double inverse = 1.0 / array.sigma_mps2(i);
    rows.sensor[k] = i;
    rows.a[k] = scaled(array.axis(i), inverse);
    rows.z[k] = block.mean_mps2[static_cast<size_t>(i)] * inverse;
    rows.inverse_sigma[k] = inverse;
    ++rows.count;
  }
  return rows;
}

/// Inverse of the symmetric 3x3 normal matrix; false where the set has no rank 3.
bool invert_normal(const Rows& rows, Mat3& inverse) noexcept {
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  for (int k = 0; k < rows.count; ++k) {
    const Vec3& a = rows.a[static_cast<size_t>(k)];
    xx += a[0] * a[0];
    xy += a[0] * a[1];
    xz += a[0] * a[2];
    yy += a[1] * a[1];
    yz += a[1] * a[2];
    zz += a[2] * a[2];
  }
  const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
  const double det = xx * cxx + xy * cxy + xz * cxz;
  const double trace = xx + yy + zz;
  // Loose enough for sigmas a factor of 300 apart (which the monitor's set-up does not let pass).
  if (!(det > 1e-15 * trace * trace * trace)) return false;
  const double d = 1.0 / det;
  inverse = {cxx * d,
             cxy * d,
             cxz * d,
             cxy * d,
             (xx * zz - xz * xz) * d,
             (xy * xz - xx * yz) * d,
             cxz * d,
             (xy * xz - xx * yz) * d,
             (xx * yy - xy * xy) * d};
  return true;
}

/// Upper bound of the largest eigenvalue of a symmetric positive semidefinite matrix of rank <= k from
/// its trace and the trace of its square (Wolkowicz and Styan); exact for k = 1 and 2.
double largest_eigenvalue_bound(double trace, double trace_of_square, int k) noexcept {
  if (k <= 0 || !(trace > 0.0)) return 0.0;
  const double mean = trace / k;
  const double variance = trace_of_square / k - mean * mean;
  return mean + (variance > 0.0 ? std::sqrt(variance * (k - 1)) : 0.0);
}

struct Projection {
  std::array<double, kCapacity> w{};  ///< norm row, unit length, zero where there is no norm row
  std::array<Vec3, kCapacity> ca{};   ///< C a_i
};

/// sqrt(lambda_max(Q' C_cal Q)) of the parity rows, of the norm row and of both, in whitened units.
struct Systematic {
  double parity = 0.0, norm = 0.0, both = 0.0;
};

Systematic calibration_bound(const SensorArray& array, const Rows& rows, const Projection& p, const Vec3& x) noexcept {
  const int s = rows.count;
  std::array<std::array<double, kCapacity>, kCapacity> cal{};
  for (int i = 0; i < s; ++i) {
    for (int j = 0; j <= i; ++j) {
      const auto a = static_cast<size_t>(i), b = static_cast<size_t>(j);
      cal[a][b] =
          array.uncertainty().at(rows.sensor[a], rows.sensor[b], x) * rows.inverse_sigma[a] * rows.inverse_sigma[b];
      cal[b][a] = cal[a][b];
    }
  }
  // D = P C with P the projector onto the parity space; its trace and that of its square bound lambda_max.
  double norm_row = 0.0, trace = 0.0, square = 0.0, cross_term = 0.0;
  std::array<std::array<double, kCapacity>, kCapacity> d{};
  std::array<double, kCapacity> cw{};
  for (int i = 0; i < s; ++i) {
    const auto a = static_cast<size_t>(i);
    for (int j = 0; j < s; ++j) cw[a] += cal[a][static_cast<size_t>(j)] * p.w[static_cast<size_t>(j)];
    norm_row += p.w[a] * cw[a];
  }
  if (s > 3) {
    for (int i = 0; i < s; ++i) {
      for (int j = 0; j < s; ++j) {
        double sum = cal[static_cast<size_t>(i)][static_cast<size_t>(j)];
        for (int k = 0; k < s; ++k) {
          sum -= dot(rows.a[static_cast<size_t>(i)], p.ca[static_cast<size_t>(k)]) *
                 cal[static_cast<size_t>(k)][static_cast<size_t>(j)];
        }
        d[static_cast<size_t>(i)][static_cast<size_t>(j)] = sum;
      }
      trace += d[static_cast<size_t>(i)][static_cast<size_t>(i)];
    }
    for (int i = 0; i < s; ++i) {
      for (int j = 0; j < s; ++j) {
        square += d[static_cast<size_t>(i)][static_cast<size_t>(j)] * d[static_cast<size_t>(j)][static_cast<size_t>(i)];
      }
      double projected = cw[static_cast<size_t>(i)];
      for (int k = 0; k < s; ++k) {
        projected -= dot(rows.a[static_cast<size_t>(i)], p.ca[static_cast<size_t>(k)]) * cw[static_cast<size_t>(k)];
      }
      cross_term += projected * cw[static_cast<size_t>(i)];
    }
  }
  // With the norm row: trace adds w'Cw; trace of the square adds (w'Cw)^2 + 2 |P C w|^2 (P is a projector).
  Systematic out;
  out.norm = std::sqrt(norm_row > 0.0 ? norm_row : 0.0);
  out.parity = std::sqrt(largest_eigenvalue_bound(trace, square, s - 3));
  out.both =
      std::sqrt(largest_eigenvalue_bound(trace + norm_row, square + norm_row * norm_row + 2.0 * cross_term, s - 2));
  return out;
}

}  // namespace

TestLimits TestLimits::from_rates(int n, double false_alarm_rate, double rejection_rate) noexcept {
  TestLimits limits;
  for (int nu = 1; nu <= kCapacity; ++nu) {
    limits.reject[static_cast<size_t>(nu)] = std::sqrt(chi2_tail_quantile(rejection_rate, nu));
    limits.parity_alarm[static_cast<size_t>(nu)] = std::sqrt(chi2_tail_quantile(false_alarm_rate, nu));
  }
  limits.norm_alarm = limits.parity_alarm[1];
  limits.calibration = std::sqrt(chi2_tail_quantile(0.01, 4 * n - 3));
  return limits;
}

double SetTest::combined() const noexcept { return std::sqrt(parity * parity + norm * norm); }
double SetTest::reject_limit(const TestLimits& limits) const noexcept {
  return limits.reject[static_cast<size_t>(parity_rows) + 1U] + systematic;
}
double SetTest::parity_reject_limit(const TestLimits& limits) const noexcept {
  return limits.reject[static_cast<size_t>(parity_rows)] + parity_systematic;
}
double SetTest::parity_alarm_limit(const TestLimits& limits) const noexcept {
  return limits.parity_alarm[static_cast<size_t>(parity_rows)] + parity_systematic;
}
double SetTest::norm_alarm_limit(const TestLimits& limits) const noexcept {
  return limits.norm_alarm + norm_systematic;
}
double SetTest::norm_reject_limit(const TestLimits& limits) const noexcept {
  return limits.reject[1] + norm_systematic;
}

SetTest test_set(const SensorArray& array, const GravityReference& gravity, const TestLimits& limits,
                 const BlockEvidence& block, SensorSet set) noexcept {
  SetTest out;
  if (set.size() < 3 || !array.all().contains(set) || !block.usable.contains(set) || !(block.samples > 0.0)) return out;
  const Rows rows = gather(array, block, set);
  Mat3 c{};
  if (!invert_normal(rows, c)) return out;

  Vec3 right{};
  for (int k = 0; k < rows.count; ++k)
    right = plus(right, scaled(rows.a[static_cast<size_t>(k)], rows.z[static_cast<size_t>(k)]));
  const Vec3 x = times(c, right);
  const double length = norm(x);
  const Vec3 u = length > 0.0 ? scaled(x, 1.0 / length) : Vec3{0.0, 0.0, 1.0};
  const Vec3 cu = times(c, u);
  const double sigma_norm = std::sqrt(dot(u, cu));  // of |x| for one sample [m/s^2]
  if (!(sigma_norm > 0.0)) return out;              // readings beyond all bounds, as a forged snapshot may hold them

  Projection p;
  double rss = 0.0;
  out.least_leverage = 1.0;
  for (int k = 0; k < rows.count; ++k) {
    const auto i = static_cast<size_t>(k);
    const double r = rows.z[i] - dot(rows.a[i], x);
    rss += r * r;
    p.ca[i] = times(c, rows.a[i]);
    p.w[i] = dot(rows.a[i], cu) / sigma_norm;
    const double leverage = 1.0 - dot(rows.a[i], p.ca[i]);
    if (leverage < out.least_leverage) out.least_leverage = leverage;
  }
  const double root_n = std::sqrt(block.samples);
  out.tested = true;
  out.x_mps2 = x;
  out.parity_rows = rows.count - 3;
  out.parity = out.parity_rows > 0 ? std::sqrt(rss) * root_n : 0.0;
  out.norm_error_mps2 = length - gravity.g_mps2;
  out.norm_sigma_mps2 = sigma_norm;
  out.norm = out.norm_error_mps2 / sigma_norm * root_n;
  for (size_t i = 0; i < 9; ++i) out.covariance[i] = c[i] / block.samples;

  // Systematic terms: calibration at this attitude, gravity, and motion inside the block.
  const Systematic cal = calibration_bound(array, rows, p, x);
  const double reference =
      (limits.gravity * gravity.sigma_mps2 + block.spread_mps2_sq / (2.0 * gravity.g_mps2)) / sigma_norm;
  out.parity_systematic = root_n * limits.calibration * cal.parity;
  out.norm_systematic = root_n * (limits.calibration * cal.norm + reference);
  out.systematic = root_n * (limits.calibration * cal.both + reference);
  return out;
}

bool vouches_for_norm(const SensorArray& array, const GravityReference& gravity, const TestLimits& limits,
                      const BlockEvidence& block, SensorSet set, const SetTest& test) noexcept {
  if (!test.tested || test.parity_rows < 1) return false;
  if (test.least_leverage >= kMinLeverage) return true;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    const double whitened = dot(array.axis(i), times(test.covariance, array.axis(i))) * block.samples /
                            (array.sigma_mps2(i) * array.sigma_mps2(i));
    if (1.0 - whitened >= kMinLeverage) continue;
    const SetTest others = test_set(array, gravity, limits, block, set.without(i));
    if (!others.tested) return false;
    const double limit = others.norm_reject_limit(limits);
    const bool off_too = std::fabs(others.norm) > limit;
    // Where the others know the length so badly that it may be what the set says, a steady acceleration explains all.
    const double apart_mps2 = std::fabs(others.norm_error_mps2 - test.norm_error_mps2);
    const bool deny = apart_mps2 * std::sqrt(block.samples) > limit * others.norm_sigma_mps2;
    if (!off_too && deny) return false;
  }
  return true;
}

Mat3 calibration_covariance(const SensorArray& array, const SetTest& test, SensorSet set) noexcept {
  Mat3 cal{};
  if (!test.tested) return cal;
  const LeastSquares ls = least_squares(array, set);
  for (int i = 0; i < array.size(); ++i) {
    for (int j = 0; j < array.size(); ++j) {
      if (!set.has(i) || !set.has(j)) continue;
      const double c = array.uncertainty().at(i, j, test.x_mps2);
      const Vec3& a = ls.column[static_cast<size_t>(i)];
      const Vec3& b = ls.column[static_cast<size_t>(j)];
      for (size_t r = 0; r < 3; ++r) {
        for (size_t q = 0; q < 3; ++q) cal[3 * r + q] += a[r] * c * b[q];
      }
    }
  }
  return cal;
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
