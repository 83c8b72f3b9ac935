#include "plumb/detection/set_test.hpp"

#include <cmath>
#include <limits>

#include "reach.hpp"

#include "plumb/detection/detail/parity_rows.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

using std::size_t;

/// A length read through one set of sensors errs by nine numbers, whatever the attitude u: products of two components
/// of u and components of u.
constexpr int kNormHarmonics = 9;
/// Calibrations beyond: shared by parity and the norm.
constexpr double kBeyondTail = 0.005;

/// Of parity whatever is left in its rows: four numbers each.
double parity_factor(int rows) noexcept { return std::sqrt(chi2_tail_quantile(kBeyondTail, rows > 1 ? 4 * rows : 4)); }

/// Members of a set with their whitened rows and readings.
struct SetRows {
  int count = 0;
  std::array<int, kCapacity> sensor{};
  std::array<Vec3, kCapacity> a{};    ///< h_i / sigma_i
  std::array<double, kCapacity> z{};  ///< y_i / sigma_i
  std::array<double, kCapacity> inverse_sigma{};
  std::array<double, kCapacity> tolerance{};  ///< tau_i / sigma_i
  bool tolerant = false;                      ///< some of them is not zero
};

SetRows gather(const SensorArray& array, const Readings& y_mps2, SensorSet set) noexcept {
  SetRows rows;
  double sigma = 0.0, inverse = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    const auto k = static_cast<size_t>(rows.count);
    if (array.sigma_mps2(i) != sigma) {  // most arrays are of one kind of sensor
      sigma = array.sigma_mps2(i);
      inverse = 1.0 / sigma;
    }
    rows.sensor[k] = i;
    rows.a[k] = scaled(array.axis(i), inverse);
    rows.z[k] = y_mps2[static_cast<size_t>(i)] * inverse;
    rows.inverse_sigma[k] = inverse;
    ++rows.count;
  }
  return rows;
}

void add_tolerances(const BlockEvidence& block, SetRows& rows) noexcept {
  for (int k = 0; k < rows.count; ++k) {
    const auto a = static_cast<size_t>(k);
    const auto tolerance_mps2 = static_cast<double>(block.tolerance_mps2[static_cast<size_t>(rows.sensor[a])]);
    if (!(tolerance_mps2 > 0.0)) continue;
    rows.tolerance[a] = tolerance_mps2 * rows.inverse_sigma[a];
    rows.tolerant = true;
  }
}

/// C times the sum of a_i z_i: weighted least squares, C from `invert_normal`.
Vec3 solve_rows(const SetRows& rows, const Mat3& c) noexcept {
  Vec3 right{};
  for (int k = 0; k < rows.count; ++k)
    right = plus(right, scaled(rows.a[static_cast<size_t>(k)], rows.z[static_cast<size_t>(k)]));
  return times(c, right);
}

/// Inverse of the symmetric 3x3 normal matrix; false where the set has no rank 3.
bool invert_normal(const SetRows& rows, Mat3& inverse) noexcept {
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
  if (k <= 0 || trace <= 0.0) return 0.0;  // not a number is no bound, and no limit made of it is met
  const double mean = trace / k;
  const double variance = trace_of_square / k - mean * mean;
  return mean + (variance <= 0.0 ? 0.0 : std::sqrt(variance * (k - 1)));
}

struct Projection {
  std::array<double, kCapacity> w{};  ///< norm row, unit length, zero where there is no norm row
  std::array<Vec3, kCapacity> ca{};   ///< C a_i
};

/// sqrt(lambda_max(Q' C_cal Q)) of the parity rows, of the norm row and of both, in whitened units.
struct Systematic {
  double parity = 0.0, norm = 0.0, both = 0.0;
};

double trace_of_product(const Mat3& a, const Mat3& b) noexcept {
  double sum = 0.0;
  for (size_t r = 0; r < 3; ++r) {
    for (size_t q = 0; q < 3; ++q) sum += a[3 * r + q] * b[3 * q + r];
  }
  return sum;
}

/// What the calibration covariance C of the rows, whitened, does to the axes, to their C a_i and to the norm row.
struct Products {
  std::array<Vec3, kCapacity> on_a{}, on_ca{};
  std::array<double, kCapacity> on_w{};
  double trace = 0.0, square = 0.0;  ///< of C and of C C
};

Products products_of(const RowUncertainty& uncertainty, const SetRows& rows, const Projection& p,
                     const Vec3& x) noexcept {
  Products out;
  const AttitudeProducts attitude(x);
  for (int i = 0; i < rows.count; ++i) {
    const auto a = static_cast<size_t>(i);
    for (int j = 0; j <= i; ++j) {
      const auto b = static_cast<size_t>(j);
      const double c = uncertainty.of_parameters_at(rows.sensor[a], rows.sensor[b], attitude) * rows.inverse_sigma[a] *
                       rows.inverse_sigma[b];
      out.on_a[a] = plus(out.on_a[a], scaled(rows.a[b], c));
      out.on_ca[a] = plus(out.on_ca[a], scaled(p.ca[b], c));
      out.on_w[a] += c * p.w[b];
      out.square += c * c;
      if (i == j) {
        out.trace += c;
        continue;
      }
      out.on_a[b] = plus(out.on_a[b], scaled(rows.a[a], c));
      out.on_ca[b] = plus(out.on_ca[b], scaled(p.ca[a], c));
      out.on_w[b] += c * p.w[a];
      out.square += c * c;
    }
  }
  return out;
}

/// w'C w of the norm row alone, as the square of one vector over the four numbers of every row.
double norm_row_variance(const RowUncertainty& uncertainty, const SetRows& rows, const Projection& p,
                         const Vec3& x) noexcept {
  const std::array<double, 4> z = {x[0], x[1], x[2], 1.0};
  double variance = 0.0;
  for (int i = 0; i < rows.count; ++i) {
    const auto a = static_cast<size_t>(i);
    const double weight = p.w[a] * rows.inverse_sigma[a];
    const size_t first = 4 * static_cast<size_t>(rows.sensor[a]);
    size_t start = first * (first + 1) / 2;
    for (size_t row = 0; row < 4; start += first + ++row) {
      double along = 0.0;  // of the blocks left of the diagonal, and half of that on it
      for (size_t b = 0; b < a; ++b) {
        const double* const entry = &uncertainty.covariance[start + 4 * static_cast<size_t>(rows.sensor[b])];
        double sum = 0.0;
        sum += entry[0] * z[0];
        sum += entry[1] * z[1];
        sum += entry[2] * z[2];
        sum += entry[3] * z[3];
        along += p.w[b] * rows.inverse_sigma[b] * sum;
      }
      const double* const entry = &uncertainty.covariance[start + first];
      double sum = 0.5 * entry[row] * z[row];
      for (size_t q = 0; q < row; ++q) sum += entry[q] * z[q];
      along += weight * sum;
      variance += 2.0 * weight * z[row] * along;
    }
  }
  return variance;
}

/// With P = I - A K', A the rows and K the C a_i, everything about P C follows from products of n x 3 matrices:
/// tr(PC) = tr C - tr(K'CA), tr(PCPC) = tr CC - 2 tr(K'C CA) + tr(K'CA K'CA), w'C P C w = |Cw|^2 - (A'Cw).(K'Cw).
Systematic calibration_bound(const RowUncertainty& uncertainty, const SetRows& rows, const Projection& p,
                             const Vec3& x) noexcept {
  const int s = rows.count;
  Systematic out;
  if (s == 3) {
    const double variance = norm_row_variance(uncertainty, rows, p, x);
    out.norm = out.both = std::sqrt(variance <= 0.0 ? 0.0 : variance);
    return out;
  }
  const Products c = products_of(uncertainty, rows, p, x);
  double norm_row = 0.0, cross_term = 0.0;
  Mat3 once{}, twice{};  // K'CA and K'C CA
  Vec3 along_a{}, along_ca{};
  for (int i = 0; i < s; ++i) {
    const auto a = static_cast<size_t>(i);
    norm_row += p.w[a] * c.on_w[a];
    add_outer(once, p.ca[a], c.on_a[a]);
    add_outer(twice, c.on_ca[a], c.on_a[a]);
    along_a = plus(along_a, scaled(rows.a[a], c.on_w[a]));
    along_ca = plus(along_ca, scaled(p.ca[a], c.on_w[a]));
    cross_term += c.on_w[a] * c.on_w[a];
  }
  const double trace = c.trace - (once[0] + once[4] + once[8]);
  const double square = c.square - 2.0 * (twice[0] + twice[4] + twice[8]) + trace_of_product(once, once);
  cross_term -= dot(along_a, along_ca);
  // With the norm row: trace adds w'Cw; trace of the square adds (w'Cw)^2 + 2 |P C w|^2 (P is a projector).
  out.norm = std::sqrt(norm_row <= 0.0 ? 0.0 : norm_row);
  out.parity = std::sqrt(largest_eigenvalue_bound(trace, square, s - 3));
  out.both =
      std::sqrt(largest_eigenvalue_bound(trace + norm_row, square + norm_row * norm_row + 2.0 * cross_term, s - 2));
  return out;
}

/// What errors d with |d_i| <= tau_i, of whatever signs, do to the parity residual and to the norm row, whitened. The
/// projector P of the parity rows gives |P d| <= |d| <= sqrt(sum tau_i^2), and by its columns, whose lengths are the
/// roots of the leverages, |P d| <= sum |P e_i| tau_i.
Systematic tolerance_bound(const SetRows& rows, const Projection& p, const Vec3& u, double length,
                           double sigma_norm) noexcept {
  Systematic out;
  Reach reach;
  double columns = 0.0, square = 0.0;
  for (int i = 0; i < rows.count; ++i) {
    const auto a = static_cast<size_t>(i);
    const double tau = rows.tolerance[a];
    const double leverage = 1.0 - dot(rows.a[a], p.ca[a]);
    columns += leverage > 0.0 ? std::sqrt(leverage) * tau : 0.0;
    square += tau * tau;
    reach.add(p.ca[a], u, tau);
  }
  if (rows.count > 3) out.parity = std::fmin(columns, std::sqrt(square));
  out.norm = reach.of_length_mps2(length) / sigma_norm;
  out.both = std::sqrt(out.parity * out.parity + out.norm * out.norm);
  return out;
}

}  // namespace

TestLimits TestLimits::from_rates(int n, double false_alarm_rate, double rejection_rate,
                                  double acceleration_mps2) noexcept {
  TestLimits limits;
  for (size_t nu = 1; nu < limits.reject.size(); ++nu)
    limits.reject[nu] = std::sqrt(chi2_tail_quantile(rejection_rate, static_cast<int>(nu)));
  for (size_t nu = 1; nu < limits.parity_alarm.size(); ++nu)
    limits.parity_alarm[nu] = std::sqrt(chi2_tail_quantile(false_alarm_rate, static_cast<int>(nu)));
  limits.norm_alarm = limits.parity_alarm[1];
  limits.calibration = std::sqrt(chi2_tail_quantile(2.0 * kBeyondTail, 4 * n - 3));
  limits.parity_calibration = parity_factor(n - 3);
  limits.norm_calibration = std::sqrt(chi2_tail_quantile(kBeyondTail, kNormHarmonics));
  limits.acceleration_mps2 = acceleration_mps2;
  return limits;
}

TestLimits TestLimits::of(const SensorArray& array) const noexcept {
  TestLimits out = *this;
  if constexpr (kCapacity <= 4) return out;  // one row: the factors are the same
  const int rows = array.size() - 3;
  if (rows > 1) out.parity_calibration = parity_rows_alike(array) ? kLikeRows * roys_root(rows) : parity_factor(rows);
  return out;
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

double parity_residual(const SensorArray& array, const Readings& y_mps2, SensorSet set) noexcept {
  if (set.size() < 4 || !array.all().contains(set)) return 0.0;
  const SetRows rows = gather(array, y_mps2, set);
  Mat3 c{};
  if (!invert_normal(rows, c)) return 0.0;
  const Vec3 x = solve_rows(rows, c);
  double square = 0.0;
  for (int k = 0; k < rows.count; ++k) {
    const auto i = static_cast<size_t>(k);
    const double r = rows.z[i] - dot(rows.a[i], x);
    square += r * r;
  }
  return std::sqrt(square);
}

SetTest test_set(const SensorArray& array, const GravityReference& gravity, const TestLimits& limits,
                 const BlockEvidence& block, SensorSet set) noexcept {
  SetTest out;
  test_set(array, array.perfectly_known() ? nullptr : &array.uncertainty(), gravity, limits, block, set, out);
  return out;
}

void test_set(const SensorArray& array, const RowUncertainty* uncertainty, const GravityReference& gravity,
              const TestLimits& limits, const BlockEvidence& block, SensorSet set, SetTest& out) noexcept {
  if (set.size() < 3 || !array.all().contains(set) || !block.usable.contains(set) || !(block.samples > 0.0)) return;
  SetRows rows = gather(array, block.mean_mps2, set);
  Mat3 c{};
  if (!invert_normal(rows, c)) return;
  add_tolerances(block, rows);

  const Vec3 x = solve_rows(rows, c);
  const double length = norm(x);
  const Vec3 u = length > 0.0 ? scaled(x, 1.0 / length) : Vec3{0.0, 0.0, 1.0};
  const Vec3 cu = times(c, u);
  const double sigma_norm = std::sqrt(dot(u, cu));  // of |x| for one sample [m/s^2]
  if (!(sigma_norm > 0.0)) return;                  // readings beyond all bounds, as a forged snapshot may hold them

  Projection p;
  double rss = 0.0;
  out.least_leverage = 1.0;
  for (int k = 0; k < rows.count; ++k) {
    const auto i = static_cast<size_t>(k);
    const double r = rows.z[i] - dot(rows.a[i], x);
    rss += r * r;
    p.ca[i] = times(c, rows.a[i]);
    if (uncertainty != nullptr) p.w[i] = dot(rows.a[i], cu) / sigma_norm;
    const double leverage = 1.0 - dot(rows.a[i], p.ca[i]);
    if (leverage < out.least_leverage) out.least_leverage = leverage;
  }
  const double root_n = std::sqrt(block.samples);
  out.tested = true;
  out.x_mps2 = x;
  out.samples = block.samples;
  out.parity_rows = rows.count - 3;
  out.parity = out.parity_rows > 0 ? std::sqrt(rss) * root_n : 0.0;
  out.norm_error_mps2 = length - gravity.g_mps2;
  out.norm_sigma_mps2 = sigma_norm;
  out.norm = out.norm_error_mps2 / sigma_norm * root_n;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t column = 0; column <= row; ++column) {
      out.covariance[3 * row + column] = out.covariance[3 * column + row] = c[3 * row + column] / block.samples;
    }
  }

  // Systematic terms: calibration at this attitude, drift since, gravity, motion inside the block, and the acceleration
  // that the host allows for. All sets of a block feel the same one, so it widens the norm and leaves parity alone.
  const Systematic cal = uncertainty != nullptr ? calibration_bound(*uncertainty, rows, p, x) : Systematic{};
  const Systematic drift = rows.tolerant ? tolerance_bound(rows, p, u, length, sigma_norm) : Systematic{};
  const double moved = block.spread_mps2_sq / (2.0 * gravity.g_mps2) + block.motion_mps2 + limits.acceleration_mps2;
  const double scaled_by = uncertainty != nullptr ? uncertainty->common_scale * gravity.g_mps2 : 0.0;
  const double reference = (TestLimits::gravity * (gravity.sigma_mps2 + scaled_by) + moved) / sigma_norm;
  const double both = out.parity_rows > 0 ? limits.calibration * cal.both : limits.norm_calibration * cal.norm;
  const double growth =
      uncertainty != nullptr ? noise_growth(largest_misfit(array, *uncertainty, set, block.samples)) : 0.0;
  const auto rows_of_parity = static_cast<size_t>(out.parity_rows);
  out.parity_systematic =
      root_n * (limits.parity_calibration * cal.parity + drift.parity) + limits.reject[rows_of_parity] * growth;
  out.norm_systematic =
      root_n * (limits.norm_calibration * cal.norm + drift.norm + reference) + limits.reject[1] * growth;
  out.systematic = root_n * (both + drift.both + reference) + limits.reject[rows_of_parity + 1U] * growth;
}

double largest_misfit(const SensorArray& array, const RowUncertainty& uncertainty, SensorSet set,
                      double samples) noexcept {
  double most = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    const double misfit = uncertainty.misfit_mps2[static_cast<size_t>(i)] / array.sigma_mps2(i);
    if (!(misfit >= 0.0)) return std::numeric_limits<double>::quiet_NaN();  // no limit made of it is met
    if (misfit > most) most = misfit;
  }
  return most * std::sqrt(samples);
}

SetTest test_set(const SensorArray& array, const RowUncertainty& uncertainty, const GravityReference& gravity,
                 const TestLimits& limits, const BlockEvidence& block, SensorSet set) noexcept {
  SetTest out;
  test_set(array, &uncertainty, gravity, limits, block, set, out);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
