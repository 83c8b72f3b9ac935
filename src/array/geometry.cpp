#include "plumb/array/geometry.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "linear.hpp"
#include "plumb/core/detail/numbers.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

using array_detail::Rows;

/// Members of a set as a list, with the weight of each row relative to the one of least noise.
struct Selection {
  std::array<int, kCapacity> sensor{};
  std::array<double, kCapacity> weight{};  ///< sigma_min / sigma_i, exactly 1 where all sigmas agree
  double sigma_min = 1.0;
  int count = 0;
};

enum class Weights : std::uint8_t { whitened, geometric };

Selection select(const SensorArray& array, SensorSet used, Weights weights) noexcept {
  Selection out;
  double sigma_min = std::numeric_limits<double>::infinity();
  for (int i = 0; i < array.size(); ++i) {
    if (!used.has(i)) continue;
    out.sensor[at(out.count++)] = i;
    if (array.sigma_mps2(i) < sigma_min) sigma_min = array.sigma_mps2(i);
  }
  if (weights == Weights::whitened) out.sigma_min = sigma_min;
  for (int r = 0; r < out.count; ++r) {
    const double sigma = array.sigma_mps2(out.sensor[at(r)]);
    out.weight[at(r)] = weights == Weights::whitened ? sigma_min / sigma : 1.0;
  }
  return out;
}

Rows weighted_rows(const SensorArray& array, const Selection& s) noexcept {
  Rows rows;
  for (int r = 0; r < s.count; ++r) rows.add(scaled(array.axis(s.sensor[at(r)]), s.weight[at(r)]));
  return rows;
}

/// Upper triangular factor and its inverse, row by row.
struct Triangle {
  Mat3 inverse{};
  bool regular = false;
};

/// Takes from column q its share along the unit column p and returns that share.
double project_out(Rows& m, std::size_t p, std::size_t q) noexcept {
  const double share = array_detail::column_dot(m, p, q);
  for (int i = 0; i < m.count; ++i) m.row[at(i)][q] -= share * m.row[at(i)][p];
  return share;
}

/// Q R of the rows; `m` becomes Q. Gram-Schmidt with every projection done twice, which keeps Q
/// orthonormal to rounding, so that the residual stays orthogonal to H where H'H would lose half the digits.
Triangle factor(Rows& m) noexcept {
  Mat3 r{};
  for (std::size_t q = 0; q < 3; ++q) {
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t p = 0; p < q; ++p) r[3 * p + q] += project_out(m, p, q);
    }
    const double length = std::sqrt(array_detail::column_dot(m, q, q));
    if (!(length > 0.0) || !std::isfinite(length)) return Triangle{};
    r[3 * q + q] = length;
    for (int i = 0; i < m.count; ++i) m.row[at(i)][q] /= length;
  }
  Triangle t;
  t.inverse[0] = 1.0 / r[0];
  t.inverse[4] = 1.0 / r[4];
  t.inverse[8] = 1.0 / r[8];
  t.inverse[1] = -r[1] * t.inverse[4] / r[0];
  t.inverse[5] = -r[5] * t.inverse[8] / r[4];
  t.inverse[2] = -(r[1] * t.inverse[5] + r[2] * t.inverse[8]) / r[0];
  t.regular = true;
  return t;
}

/// R^-1 R^-T scaled: the covariance of the estimate.
Mat3 covariance_of(const Mat3& u, double variance) noexcept {
  const Vec3 a = {u[0], u[1], u[2]};
  const Vec3 b = {0.0, u[4], u[5]};
  const Vec3 c = {0.0, 0.0, u[8]};
  const double ab = dot(a, b) * variance;
  const double ac = dot(a, c) * variance;
  const double bc = dot(b, c) * variance;
  return {dot(a, a) * variance, ab, ac, ab, dot(b, b) * variance, bc, ac, bc, dot(c, c) * variance};
}

LeastSquares solve(const SensorArray& array, SensorSet used, Weights weights) noexcept {
  LeastSquares out;
  if (rank_of(array, used) < 3) return out;
  const Selection s = select(array, used, weights);
  Rows q = weighted_rows(array, s);
  const Triangle t = factor(q);
  if (!t.regular) return out;  // sigmas so far apart that the weighted rows have lost a direction
  out.covariance = covariance_of(t.inverse, s.sigma_min * s.sigma_min);
  for (const double c : out.covariance) {
    if (!std::isfinite(c)) return LeastSquares{};
  }
  for (int r = 0; r < s.count; ++r) {
    out.column[at(s.sensor[at(r)])] = scaled(times(t.inverse, q.row[at(r)]), s.weight[at(r)]);
  }
  out.valid = true;
  out.used = used & array.all();
  return out;
}

/// Householder reflections that bring three columns to triangular form.
struct Reflections {
  std::array<std::array<double, kCapacity>, 3> v{};
  std::array<double, 3> beta{};  ///< 2 / v'v, zero where nothing had to be reflected
};

Reflections triangularise(Rows& m) noexcept {
  Reflections out;
  for (int k = 0; k < 3; ++k) {
    const std::size_t c = at(k);
    double tail = 0.0;
    for (int i = k; i < m.count; ++i) tail += m.row[at(i)][c] * m.row[at(i)][c];
    const double length = std::copysign(std::sqrt(tail), m.row[c][c]);
    if (!(std::fabs(length) > 0.0)) continue;
    double square = 0.0;
    for (int i = k; i < m.count; ++i) {
      const double vi = m.row[at(i)][c] + (i == k ? length : 0.0);
      out.v[c][at(i)] = vi;
      square += vi * vi;
    }
    out.beta[c] = 2.0 / square;
    for (std::size_t column = c; column < 3; ++column) {
      double share = 0.0;
      for (int i = k; i < m.count; ++i) share += out.v[c][at(i)] * m.row[at(i)][column];
      share *= out.beta[c];
      for (int i = k; i < m.count; ++i) m.row[at(i)][column] -= share * out.v[c][at(i)];
    }
  }
  return out;
}

/// Column j of the orthogonal factor, signed so that its first coefficient of weight is positive.
std::array<double, kCapacity> orthogonal_column(const Reflections& h, int j, int n) noexcept {
  constexpr double kOfWeight = 0.1;  // a unit vector of 24 entries has one of at least 0.204
  std::array<double, kCapacity> q{};
  q[at(j)] = 1.0;
  for (int k = 2; k >= 0; --k) {
    double share = 0.0;
    for (int i = k; i < n; ++i) share += h.v[at(k)][at(i)] * q[at(i)];
    share *= h.beta[at(k)];
    for (int i = k; i < n; ++i) q[at(i)] -= share * h.v[at(k)][at(i)];
  }
  for (int i = 0; i < n; ++i) {
    if (std::fabs(q[at(i)]) < kOfWeight) continue;
    if (q[at(i)] < 0.0) {
      for (double& entry : q) entry = -entry;
    }
    break;
  }
  return q;
}

ParityBasis parity(const SensorArray& array, SensorSet used, Weights weights) noexcept {
  ParityBasis out;
  if (rank_of(array, used) < 3) return out;
  const Selection s = select(array, used, weights);
  Rows m = weighted_rows(array, s);
  const Reflections h = triangularise(m);
  out.rows = s.count - 3;
  for (int r = 0; r < out.rows; ++r) {
    const std::array<double, kCapacity> q = orthogonal_column(h, r + 3, s.count);
    for (int i = 0; i < s.count; ++i) {
      const int sensor = s.sensor[at(i)];
      const double unit = weights == Weights::whitened ? array.sigma_mps2(sensor) : 1.0;
      out.weight[at(r)][at(sensor)] = q[at(i)] / unit;
    }
  }
  return out;
}

Vec3 singular_values_of(const SensorArray& array, SensorSet used) noexcept {
  return array_detail::singular_values(weighted_rows(array, select(array, used, Weights::geometric)));
}

SensorSet axes_near_plane(const SensorArray& array, SensorSet used, const Vec3& normal) noexcept {
  SensorSet out;
  for (int k = 0; k < array.size(); ++k) {
    if (used.has(k) && std::fabs(dot(array.axis(k), normal)) <= kPlaneTolerance) out = out.with(k);
  }
  return out;
}

/// The most that `count` makes of the axes of `set` within kPlaneTolerance of one plane.
template <class Count>
int most_in_one_plane(const SensorArray& array, SensorSet set, Count&& count) noexcept {
  int most = 0;
  for (int i = 0; i < array.size(); ++i) {
    for (int j = i + 1; j < array.size(); ++j) {
      // Planes of all pairs, in use or not: were a plane forgotten with one of its two sensors, c could
      // fall by more than one, and losing a sensor would raise the grade.
      const Vec3 normal = cross(array.axis(i), array.axis(j));
      const double sine = norm(normal);
      // A parallel pair spans no plane; each of the two spans one with every other axis, and that counts both.
      if (sine < array_detail::kRankTolerance) continue;
      const int here = count(axes_near_plane(array, set, scaled(normal, 1.0 / sine)));
      if (here > most) most = here;
    }
  }
  return most;
}

double nearest_angle(const SensorArray& array) noexcept {
  double nearest = kPi / 2.0;
  for (int i = 0; i < array.size(); ++i) {
    for (int j = i + 1; j < array.size(); ++j) {
      const Vec3& a = array.axis(i);
      const Vec3& b = array.axis(j);
      const double angle = angle_of(norm(cross(a, b)), std::fabs(dot(a, b)));
      if (angle < nearest) nearest = angle;
    }
  }
  return nearest;
}

double common_bias_visibility(const SensorArray& array) noexcept {
  const ParityBasis basis = parity(array, array.all(), Weights::geometric);
  double square = 0.0;
  for (int r = 0; r < basis.rows; ++r) {
    double sum = 0.0;
    for (const double w : basis.weight[at(r)]) sum += w;
    square += sum * sum;
  }
  return std::sqrt(square / array.size());
}

}  // namespace

int rank_of(const SensorArray& array, SensorSet used) noexcept {
  // A triple that votes settles it without singular values: the squares of its three add up to 3, so the smallest is at
  // least |det| / 1.5, far above the tolerance, and a further row never lowers it.
  static_assert(kMinTripleDet / 1.5 > 1e3 * array_detail::kRankTolerance, "a margin that rounding does not reach");
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    if (t.votes && used.contains(t.set())) return 3;
  }
  const Vec3 s = singular_values_of(array, used);
  int rank = 0;
  for (const double value : s) rank += value >= array_detail::kRankTolerance ? 1 : 0;
  return rank;
}

Vec3 LeastSquares::estimate(const Readings& y) const noexcept {
  Vec3 x{};
  // One that is not used is not read: it may be NaN, and 0 * NaN is NaN.
  std::uint32_t left = used.bits;
  for (std::size_t i = 0; left != 0 && i < column.size(); ++i, left >>= 1U) {
    if ((left & 1U) != 0) x = plus(x, scaled(column[i], y[i]));
  }
  return x;
}

LeastSquares least_squares(const SensorArray& array, SensorSet used) noexcept {
  return solve(array, used, Weights::whitened);
}

Mat3 triple_map(const SensorArray& array, int triple) noexcept {
  if (triple < 0 || triple >= array.triple_count()) return Mat3{};
  const Triple& t = array.triple(triple);
  if (std::isinf(t.condition)) return Mat3{};
  const auto w = array_detail::inverse_columns(array.axis(t.sensors[0]), array.axis(t.sensors[1]),
                                               array.axis(t.sensors[2]), t.det);
  return {w[0][0], w[1][0], w[2][0], w[0][1], w[1][1], w[2][1], w[0][2], w[1][2], w[2][2]};
}

ParityBasis parity_basis(const SensorArray& array, SensorSet used) noexcept {
  return parity(array, used, Weights::whitened);
}

SensorSet of_direction(const SensorArray& array, SensorSet set, const Vec3& axis) noexcept {
  constexpr double kCosine = 0.984807753012208;  // of 10 deg
  SensorSet out;
  for (int i = 0; i < array.size(); ++i) {
    if (set.has(i) && std::fabs(dot(array.axis(i), axis)) >= kCosine) out = out.with(i);
  }
  return out;
}

bool spans_space(const SensorArray& array, SensorSet used) noexcept {
  const SensorSet set = used & array.all();
  return rank_of(array, set) == 3 &&
         most_in_one_plane(array, set, [](SensorSet near) { return near.size(); }) < set.size();
}

int coplanarity(const SensorArray& array, SensorSet used) noexcept {
  const SensorSet set = used & array.all();
  const SensorUnits& units = array.units();
  if (rank_of(array, set) < 3) return units.count(set);
  return most_in_one_plane(array, set, [&](SensorSet near) { return units.units_within(near, set).size(); });
}

int confirmed_grade(const SensorArray& array, SensorSet used) noexcept {
  return confirmed_grade(array.units().count(used & array.all()), coplanarity(array, used));
}

int provisional_grade(const SensorArray& array, SensorSet used) noexcept {
  return provisional_grade(array.units().count(used & array.all()), coplanarity(array, used));
}

SensorSet critical_sensors(const SensorArray& array, SensorSet used) noexcept {
  const SensorSet set = used & array.all();
  SensorSet critical;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    if (!spans_space(array, set.without(i))) critical = critical.with(i);
  }
  return critical;
}

FiguresOfMerit figures_of_merit(const SensorArray& array) noexcept {
  FiguresOfMerit out;
  if (array.size() == 0) return out;
  const LeastSquares fit = solve(array, array.all(), Weights::geometric);
  const Vec3 s = singular_values_of(array, array.all());
  out.gdop = std::sqrt(fit.covariance[0] + fit.covariance[4] + fit.covariance[8]);
  out.condition = s[0] / s[2];
  out.nearest_angle_rad = nearest_angle(array);
  out.min_triple_det = std::numeric_limits<double>::infinity();
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    if (std::fabs(t.det) < out.min_triple_det) out.min_triple_det = std::fabs(t.det);
    if (t.condition > out.max_triple_condition) out.max_triple_condition = t.condition;
    if (!t.votes) ++out.near_singular_triples;
  }
  out.common_bias_visibility = common_bias_visibility(array);
  out.units = array.units().size();
  out.coplanarity = coplanarity(array, array.all());
  out.confirmed_grade = confirmed_grade(out.units, out.coplanarity);
  out.provisional_grade = provisional_grade(out.units, out.coplanarity);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
