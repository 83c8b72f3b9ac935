#include "plumb/detection/detail/parity_rows.hpp"

#include <cmath>
#include <limits>

#include "largest_eigenvalue.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/core/detail/numbers.hpp"
#include "plumb/core/units.hpp"
#include "plumb/numeric/cholesky.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;
using numbers::kInfinity;

namespace {

using std::size_t;

constexpr double kAlike = 1e-3;

/// Symmetric, of what multiplies (u, 1) in a reading: the axis times gravity, and the offset.
using Form = std::array<double, 16>;

/// Adds `weight` times the block (i, j) of the covariance.
void add_block(const RowUncertainty& left, int i, int j, double g_mps2, double weight, Form& sum) noexcept {
  for (int p = 0; p < 4; ++p) {
    for (int q = 0; q < 4; ++q) {
      const int a = 4 * i + p, b = 4 * j + q;
      const double entry = left.covariance[at(a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a)];
      sum[at(4 * p + q)] += weight * entry * (p < 3 ? g_mps2 : 1.0) * (q < 3 ? g_mps2 : 1.0);
    }
  }
}

/// What is left in two parity rows together.
Form between(const SensorArray& array, const ParityBasis& basis, int k, int l, double g_mps2) noexcept {
  Form out{};
  for (int i = 0; i < array.size(); ++i) {
    for (int j = 0; j < array.size(); ++j) {
      add_block(array.uncertainty(), i, j, g_mps2, basis.weight[at(k)][at(i)] * basis.weight[at(l)][at(j)], out);
    }
  }
  return out;
}

double largest_entry_of(const Form& form) noexcept {
  const Mat3 a = {form[0], form[1], form[2], form[4], form[5], form[6], form[8], form[9], form[10]};
  return largest_over_directions(a, {form[3], form[7], form[11]}, form[15]);
}

/// sup over the attitudes of sum_ij weight(i, j) z' Cov_ij z, without misfit.
template <class Weight>
double worst_sum(const SensorArray& array, double g_mps2, Weight&& weight) noexcept {
  Form sum{};
  for (int i = 0; i < array.size(); ++i) {
    for (int j = 0; j < array.size(); ++j) add_block(array.uncertainty(), i, j, g_mps2, weight(i, j), sum);
  }
  return std::fmax(largest_entry_of(sum), 0.0);
}

}  // namespace

/// For mu above all eigenvalues of A, u'Au + 2b'u <= mu + b'(mu - A)^-1 b: add mu (1 - |u|^2) = 0 and complete the
/// square. It is least, and reached, where |(mu - A)^-1 b| = 1; the upper end of the bisection is used.
double largest_over_directions(const Mat3& a, const Vec3& b, double c) noexcept {
  Mat3 work = a, vectors{};
  Vec3 values{};
  if (!std::isfinite(norm(b)) || !symmetric_eigen(work.data(), 3, 3, values.data(), vectors.data())) return kInfinity;
  const auto along_of = [&](size_t k) { return vectors[k] * b[0] + vectors[3 + k] * b[1] + vectors[6 + k] * b[2]; };
  const Vec3 along = {along_of(0), along_of(1), along_of(2)};
  const double largest = values[2];
  const auto excess = [&](double mu) {  // |(mu - A)^-1 b|^2 - 1; positive at an eigenvalue, where mu is too low
    double sum = -1.0;
    for (size_t k = 0; k < 3; ++k) {
      if (!(mu > values[k])) return 1.0;
      const double solved = along[k] / (mu - values[k]);
      sum += solved * solved;
    }
    return sum;
  };
  double low = largest, high = largest + norm(b);  // |(mu - A)^-1 b| <= |b| / (mu - largest)
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (excess(middle) <= 0.0 ? high : low) = middle;
  }
  double bound = high + c;
  for (size_t k = 0; k < 3; ++k) bound += high > values[k] ? along[k] * along[k] / (high - values[k]) : 0.0;
  return bound;
}

double worst_parity_variance(const SensorArray& array, double g_mps2) noexcept {
  if (array.size() <= 3 || array.perfectly_known()) return 0.0;
  const ParityBasis basis = parity_basis(array, array.all());
  const double variance = worst_sum(array, g_mps2, [&basis](int i, int j) {
    double projected = 0.0;
    for (int k = 0; k < basis.rows; ++k) projected += basis.weight[at(k)][at(i)] * basis.weight[at(k)][at(j)];
    return projected;
  });
  // The largest eigenvalue is at most their sum, and its share of it where all are one.
  const bool alike = basis.rows > 1 && parity_rows_alike(array);
  return variance * (alike ? kLikeRows * kLikeRows / basis.rows : 1.0);
}

double worst_vector_variance(const SensorArray& array, double g_mps2) noexcept {
  const LeastSquares map = least_squares(array, array.all());
  if (!map.valid) return kInfinity;
  if (array.perfectly_known()) return 0.0;
  double misfit = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    const double own = array.uncertainty().misfit_mps2[at(i)];
    misfit += dot(map.column[at(i)], map.column[at(i)]) * own * own;
  }
  return misfit + worst_sum(array, g_mps2, [&map](int i, int j) { return dot(map.column[at(i)], map.column[at(j)]); });
}

/// All errors of parity together have a covariance M of 4x4 blocks; with D = M - I (x) G, -|D| <= D <= |D| (Frobenius),
/// so that |D| within kAlike of the smallest eigenvalue of G puts M between (1 -+ kAlike) I (x) G.
bool parity_rows_alike(const SensorArray& array) noexcept {
  if (array.size() <= 4 || array.perfectly_known()) return true;
  const ParityBasis basis = parity_basis(array, array.all());
  Form mean{};
  for (int k = 0; k < basis.rows; ++k) {
    const Form own = between(array, basis, k, k, kG0_mps2);
    for (size_t e = 0; e < mean.size(); ++e) mean[e] += own[e] / basis.rows;
  }
  double square = 0.0;
  for (int k = 0; k < basis.rows; ++k) {
    for (int l = 0; l <= k; ++l) {
      const Form one = between(array, basis, k, l, kG0_mps2);
      for (size_t e = 0; e < one.size(); ++e) {
        const double off = one[e] - (k == l ? mean[e] : 0.0);
        square += (k == l ? 1.0 : 2.0) * off * off;
      }
    }
  }
  // Positive definite with that much taken off: no eigenvalue of the mean is smaller.
  for (size_t e = 0; e < mean.size(); e += 5) mean[e] -= std::sqrt(square) / kAlike;
  return basis.rows > 0 && cholesky_factor(mean.data(), 4, 4);
}

double roys_root(int rows) noexcept {
  // Of W'W with `rows` degrees of freedom, by de Bruijn's Pfaffian of incomplete gamma functions.
  constexpr std::array<double, 21> kRoot = {3.854901, 4.289386, 4.609488, 4.869577, 5.109807, 5.320689, 5.514451,
                                            5.694751, 5.864097, 6.024298, 6.176712, 6.322386, 6.462153, 6.596685,
                                            6.726535, 6.852165, 6.973964, 7.092265, 7.207356, 7.319487, 7.428876};
  static_assert(kCapacity - 3 <= static_cast<int>(kRoot.size()), "no more sensors than the table has");
  if (rows < 1 || rows > static_cast<int>(kRoot.size())) return kInfinity;
  return kRoot[at(rows - 1)];
}

}  // namespace PLUMB_ABI
}  // namespace plumb
