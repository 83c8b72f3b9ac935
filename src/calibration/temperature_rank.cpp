/// What the stations of a fit over temperature can and cannot see: rank, condition, null directions by name.
///
/// The rank is judged on Chebyshev polynomials over the *stations'* temperatures, all orders in the prior units of the
/// zeroth: whether a cubic is determined where it was recorded does not depend on how far it is to be extrapolated. The
/// condition is that over the span of use, where just this shows.
#include <cmath>

#include "plumb/numeric/symmetric_eigen.hpp"
#include "temperature_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {
namespace {

using Rotations = std::array<JointVector, 3>;

/// An entry below this part of a null direction is no handle to tell it from the others by.
constexpr double kPivot = 0.02;
double inner(const JointVector& a, const JointVector& b, int size) noexcept {
  double sum = 0.0;
  for (int k = 0; k < size; ++k) sum += a[at(k)] * b[at(k)];
  return sum;
}

/// The common rotations in prior units, orthonormal.
Rotations gauge_basis(const Joint& joint, const Parameters& theta) noexcept {
  Rotations out{};
  const int n = joint.sensors(), size = joint.parameters();
  for (int q = 0; q < 3; ++q) {
    Vec3 e{};
    e[at(q)] = 1.0;
    Parameters turned = datasheet_parameters(joint.sheet);
    for (int i = 0; i < n; ++i) {
      const Vec3 d = cross(row_of(theta, i), e);
      for (int p = 0; p < 3; ++p) turned[at(4 * i + p)] += d[at(p)];
    }
    const Parameters x = prior_units(joint.sheet, turned);
    JointVector& v = out[at(q)];
    for (int i = 0; i < n; ++i) {
      for (int p = 0; p < 3; ++p) v[at(joint.per_sensor() * i + p)] = x[at(4 * i + p)];
    }
    for (int r = 0; r < q; ++r) {
      const double shared = inner(out[at(r)], v, size);
      for (int k = 0; k < size; ++k) v[at(k)] -= shared * out[at(r)][at(k)];
    }
    const double length = std::sqrt(inner(v, v, size));
    for (int k = 0; k < size && length > 0.0; ++k) v[at(k)] /= length;
  }
  return out;
}

double information_along(const double* information, const JointVector& v, int size) noexcept {
  double sum = 0.0;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) sum += v[at(i)] * information[i * size + j] * v[at(j)];
  }
  return sum;
}

int order_of(int p) noexcept { return p < 4 ? 0 : (p - 2) / 2; }

/// Brings the null directions, columns of `vectors`, into reduced form: each is led by a parameter that no other has,
/// of as high an order as can be. What a single sensor leaves open then stands alone.
class NullSearch {
 public:
  NullSearch(const Joint& joint, double* vectors, int columns) noexcept
      : joint_(joint), v_(vectors), size_(joint.parameters()), columns_(columns) {}

  /// Takes the common rotations out and keeps as many columns as are left then, orthonormal, the longest first.
  void without(const Rotations& gauge, int count) noexcept {
    for (int c = 0; c < columns_; ++c) {
      for (int q = 0; q < count; ++q) {
        double shared = 0.0;
        for (int k = 0; k < size_; ++k) shared += entry(k, c) * gauge[at(q)][at(k)];
        for (int k = 0; k < size_; ++k) entry(k, c) -= shared * gauge[at(q)][at(k)];
      }
    }
    for (int d = 0; d < columns_ - count; ++d) {
      int longest = d;
      for (int c = d; c < columns_; ++c) {
        if (product(c, c) > product(longest, longest)) longest = c;
      }
      const double length = std::sqrt(product(longest, longest));
      for (int k = 0; k < size_ && length > 0.0; ++k) {
        const double kept = entry(k, d);
        entry(k, d) = entry(k, longest) / length;
        if (longest != d) entry(k, longest) = kept;
      }
      for (int c = d + 1; c < columns_; ++c) {
        const double shared = product(c, d);
        for (int k = 0; k < size_; ++k) entry(k, c) -= shared * entry(k, d);
      }
    }
    columns_ -= count;
  }

  void run(TemperatureReport& report) noexcept {
    int found = 0;
    for (int order = joint_.order; order >= 0; --order) {
      while (found < columns_ && lead(order, found)) ++found;
    }
    for (int c = 0; c < found && c < kMaxNullDirections; ++c) write(c, report.null[at(c)]);
  }

 private:
  double& entry(int k, int c) noexcept { return v_[k * size_ + c]; }

  double product(int a, int b) noexcept {
    double sum = 0.0;
    for (int k = 0; k < size_; ++k) sum += entry(k, a) * entry(k, b);
    return sum;
  }

  /// Makes the largest entry of the order among the columns from `found` on the leader of column `found`.
  bool lead(int order, int found) noexcept {
    int row = -1, column = -1;
    double least = order > 0 ? kPivot : 0.0;
    for (int k = 0; k < size_; ++k) {
      if (order_of(k % joint_.per_sensor()) != order) continue;
      for (int c = found; c < columns_; ++c) {
        if (std::fabs(entry(k, c)) > least) {
          least = std::fabs(entry(k, c));
          row = k;
          column = c;
        }
      }
    }
    if (row < 0) return false;
    const double leader = entry(row, column);
    for (int k = 0; k < size_; ++k) {
      const double kept = entry(k, found);
      entry(k, found) = entry(k, column) / leader;
      if (column != found) entry(k, column) = kept;
    }
    for (int c = 0; c < columns_; ++c) {
      const double factor = entry(row, c);
      for (int k = 0; k < size_ && c != found; ++k) entry(k, c) -= factor * entry(k, found);
    }
    return true;
  }

  void write(int c, TemperatureNull& out) noexcept {
    out = TemperatureNull{};
    const int per = joint_.per_sensor();
    double most = 0.0;
    for (int i = 0; i < joint_.sensors(); ++i) {
      const Vec3 w = {entry(per * i, c), entry(per * i + 1, c), entry(per * i + 2, c)};
      const Vec3& h = joint_.sheet.sensor[at(i)].row.axis;
      const double along = dot(w, h);
      insert({ParameterKind::scale, 0, i, along}, out);
      insert({ParameterKind::axis, 0, i, norm(minus(w, scaled(h, along)))}, out);
      insert({ParameterKind::bias, 0, i, entry(per * i + 3, c)}, out);
      for (int j = 1; j <= joint_.order; ++j) {
        insert({ParameterKind::scale, j, i, entry(per * i + 2 + 2 * j, c)}, out);
        insert({ParameterKind::bias, j, i, entry(per * i + 3 + 2 * j, c)}, out);
      }
    }
    most = std::fabs(out.term[0].amount);
    while (out.terms > 1 && std::fabs(out.term[at(out.terms - 1)].amount) < kNullTermShare * most) --out.terms;
    for (int k = out.terms; k < kMaxTemperatureTerms; ++k) out.term[at(k)] = TemperatureTerm{};
  }

  static void insert(const TemperatureTerm& term, TemperatureNull& out) noexcept {
    int place = out.terms;
    while (place > 0 && std::fabs(out.term[at(place - 1)].amount) < std::fabs(term.amount)) --place;
    if (place == kMaxTemperatureTerms) return;
    if (out.terms < kMaxTemperatureTerms) ++out.terms;
    for (int k = out.terms - 1; k > place; --k) out.term[at(k)] = out.term[at(k - 1)];
    out.term[at(place)] = term;
  }

  const Joint& joint_;
  double* v_;
  int size_;
  int columns_;
};

/// A map of one sensor's parameters, row-major with stride kJointPerSensor.
using Map = std::array<double, at(kJointPerSensor* kJointPerSensor)>;

/// A matrix entry of the map.
constexpr std::size_t cell(int p, int q) noexcept { return at(p * kJointPerSensor + q); }

/// From polynomials over `span` in the prior units of order 0 to the parameters of the fit in their own prior units. A
/// constant change c of s, which is no parameter, is one of W, of all b_j, and of all s_j back.
Map map_of(const Joint& joint, const JointState& state, int i, const ChebyshevSpan& span) noexcept {
  Map out{};
  for (int p = 0; p < 4; ++p) out[cell(p, p)] = 1.0;
  const DatasheetSensor& s = joint.sheet.sensor[at(i)];
  const Cubic &scale_sigma = joint.scale_sigma[at(i)], &bias_sigma = joint.bias_sigma[at(i)];
  const Vec3 w = row_of(state.theta, i);
  const double along = dot(s.row.axis, w), across = 1.0 / s.prior.axis_rad;
  const Vec3 stretch = plus(scaled(w, across), scaled(s.row.axis, along * (1.0 / s.prior.scale - across)));
  for (int j = 1; j <= joint.order; ++j) {
    Cubic unit{};
    unit[at(j)] = 1.0;
    const Cubic powers = powers_from_chebyshev(unit, span, span.middle());
    const Cubic r = chebyshev_from_powers(powers, joint.use_degc, span.middle());
    const int scale = 2 + 2 * j, bias = scale + 1;
    const double change = r[0] * s.prior.scale;
    for (int p = 0; p < 3; ++p) out[cell(p, scale)] = change * stretch[at(p)];
    out[cell(3, scale)] = change * (state.theta[at(4 * i + 3)] + state.bias[at(i)][0]) / s.prior.bias_mps2;
    out[cell(3, bias)] = r[0];
    for (int k = 1; k <= joint.order; ++k) {
      const double back = change * state.scale[at(i)][at(k)];
      out[cell(2 + 2 * k, scale)] = (r[at(k)] * s.prior.scale - back) / scale_sigma[at(k)];
      out[cell(3 + 2 * k, scale)] = change * state.bias[at(i)][at(k)] / bias_sigma[at(k)];
      out[cell(3 + 2 * k, bias)] = r[at(k)] * s.prior.bias_mps2 / bias_sigma[at(k)];
    }
  }
  return out;
}

/// Replaces a vector of one sensor, entries `step` apart, by the transpose of the map times it.
void times_transpose(const Map& map, int per, double* v, int step) noexcept {
  std::array<double, kJointPerSensor> out{};
  for (int p = 0; p < per; ++p) {
    for (int q = 0; q < per; ++q) out[at(q)] += map[cell(p, q)] * v[p * step];
  }
  for (int p = 0; p < per; ++p) v[p * step] = out[at(p)];
}

/// The information about polynomials over `span`, both triangles, in `work.scratch`.
void translate(const Joint& joint, const JointState& state, const ChebyshevSpan& span, TemperatureWork& work) noexcept {
  const int size = joint.parameters(), per = joint.per_sensor();
  double* const to = work.scratch.data();
  for (int k = 0; k < size * size; ++k) to[k] = work.information[at(k)];
  for (int i = 0; i < joint.sensors(); ++i) {
    const Map map = map_of(joint, state, i, span);
    for (int k = 0; k < size; ++k) times_transpose(map, per, to + at(k) * at(size) + at(per * i), 1);
    for (int k = 0; k < size; ++k) times_transpose(map, per, to + at(per * i) * at(size) + at(k), size);
  }
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < i; ++j) to[j * size + i] = to[i * size + j];
  }
}

int count_above(const JointVector& values, int size, double floor) noexcept {
  int rank = 0;
  while (rank < size && values[at(size - 1 - rank)] > floor * values[at(size - 1)]) ++rank;
  return rank;
}

}  // namespace

bool find_rank(const JointAnalysis& a, TemperatureWork& work, TemperatureReport& report) noexcept {
  const Joint& joint = a.joint;
  const int size = joint.parameters();
  double* const matrix = work.scratch.data();
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < i; ++j) work.information[at(j * size + i)] = work.information[at(i * size + j)];
  }
  const TemperatureLevels& levels = report.levels;
  const double middle = 0.5 * (levels.lowest_degc + levels.highest_degc);
  const double half = std::fmax(levels.highest_degc - middle, 0.5 * kLevelsApart_degc);
  translate(joint, a.state, {middle - half, middle + half}, work);
  const Rotations gauge = gauge_basis(joint, a.state.theta);
  Vec3 along{};
  for (int q = 0; q < 3; ++q) along[at(q)] = information_along(matrix, gauge[at(q)], size);
  JointVector values{};
  if (!symmetric_eigenvalues(matrix, size, size, values.data())) return false;
  report.rank = count_above(values, size, a.floor);
  report.gauge = 0;
  for (int q = 0; q < 3; ++q) report.gauge += along[at(q)] <= a.floor * values[at(size - 1)] ? 1 : 0;
  if (report.gauge > size - report.rank) report.gauge = size - report.rank;
  report.null_directions = size - report.rank - report.gauge;
  if (report.null_directions > 0) {
    translate(joint, a.state, {middle - half, middle + half}, work);
    if (!symmetric_eigen(matrix, size, size, values.data(), work.vectors.data())) return false;
    NullSearch search(joint, work.vectors.data(), size - report.rank);
    search.without(gauge, report.gauge);
    search.run(report);
  }
  translate(joint, a.state, joint.use_degc, work);
  if (!symmetric_eigenvalues(matrix, size, size, values.data())) return false;
  const double least = report.rank > 0 ? values[at(size - report.rank)] : 0.0;
  report.condition = least > 0.0 ? std::sqrt(values[at(size - 1)] / least) : 0.0;
  return true;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
