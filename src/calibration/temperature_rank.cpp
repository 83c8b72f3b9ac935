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

using numbers::at;

namespace fit {
namespace {

using Rotations = std::array<JointVector, 3>;

/// An entry below this part of a null direction is no handle to tell it from the others by.
constexpr double kPivot = 0.02;
double joint_inner(const JointVector& a, const JointVector& b, int size) noexcept {
  double sum = 0.0;
  for (int k = 0; k < size; ++k) sum += a[at(k)] * b[at(k)];
  return sum;
}

/// The common rotations in prior units, orthonormal.
Rotations joint_gauge_basis(const Joint& joint, const Parameters& theta) noexcept {
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
      const double shared = joint_inner(out[at(r)], v, size);
      for (int k = 0; k < size; ++k) v[at(k)] -= shared * out[at(r)][at(k)];
    }
    const double length = std::sqrt(joint_inner(v, v, size));
    for (int k = 0; k < size && length > 0.0; ++k) v[at(k)] /= length;
  }
  return out;
}

double joint_information_along(const double* information, const JointVector& v, int size) noexcept {
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
    if (found < kMaxNullDirections) leader_[at(found)] = row;
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
    const int sensor = leader_[at(c)] / per, p = leader_[at(c)] % per;
    const ParameterKind kind = p % 2 == 0 ? ParameterKind::scale : ParameterKind::bias;
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
    const double most = std::fabs(out.term[0].amount);
    while (out.terms > 1 && std::fabs(out.term[at(out.terms - 1)].amount) < kNullTermShare * most) --out.terms;
    for (int k = out.terms; k < kMaxTemperatureTerms; ++k) out.term[at(k)] = TemperatureTerm{};
    // A component of W alone is neither a scale nor an axis.
    if (p >= 3) put_first({kind, order_of(p), sensor, 1.0}, out);
  }

  static void put_first(const TemperatureTerm& leader, TemperatureNull& out) noexcept {
    int place = 0;
    while (place < out.terms) {
      const TemperatureTerm& t = out.term[at(place)];
      if (t.kind == leader.kind && t.order == leader.order && t.sensor == leader.sensor) break;
      ++place;
    }
    if (place == out.terms && out.terms < kMaxTemperatureTerms) ++out.terms;
    if (place == kMaxTemperatureTerms) --place;
    for (int k = place; k > 0; --k) out.term[at(k)] = out.term[at(k - 1)];
    out.term[0] = leader;
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
  std::array<int, kMaxNullDirections> leader_{};  ///< row
};

/// The fit in the polynomials by which the rank is judged.
struct RankBasis {
  RankBasis(const Joint& fitted, const JointState& at_end, const ChebyshevSpan& span) noexcept
      : joint(fitted.datasheet, span, fitted.order), state(at_end) {
    for (int i = 0; i < joint.sensors(); ++i) {
      const DatasheetSensor& s = joint.sheet.sensor[at(i)];
      for (int j = 1; j <= joint.order; ++j) {
        joint.scale_sigma[at(i)][at(j)] = s.prior.scale;
        joint.bias_sigma[at(i)][at(j)] = s.prior.bias_mps2;
      }
      // SF_0 s (W g + b + beta) is to be the same with another SF_0, and s of another mean.
      const auto translated = [&](const Cubic& c) {
        return chebyshev_from_powers(powers_from_chebyshev(c, fitted.use_degc, span.middle()), span, span.middle());
      };
      Cubic &scale = state.scale[at(i)], &bias = state.bias[at(i)];
      scale = translated(scale);
      bias = translated(bias);
      const double mean = scale[0];
      const double stretch = mean * fitted.sheet.sensor[at(i)].coefficients.scale[0] / s.coefficients.scale[0];
      for (double& c : scale) c /= mean;
      for (double& c : bias) c *= stretch;
      for (int p = 0; p < 4; ++p) state.theta[at(4 * i + p)] *= stretch;
    }
  }

  Joint joint;
  JointState state;
};

int count_above(const JointVector& values, int size, double floor) noexcept {
  int rank = 0;
  while (rank < size && values[at(size - 1 - rank)] > floor * values[at(size - 1)]) ++rank;
  return rank;
}

void mirror_joint(double* m, int size) noexcept {
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < i; ++j) m[j * size + i] = m[i * size + j];
  }
}

/// Over the span of use, all orders in prior units of the zeroth.
bool note_condition(const JointAnalysis& a, TemperatureWork& work, TemperatureReport& report) noexcept {
  const Joint& joint = a.joint;
  const int size = joint.parameters(), per = joint.per_sensor();
  JointVector unit{};
  for (int i = 0; i < joint.sensors(); ++i) {
    const Prior& prior = joint.sheet.sensor[at(i)].prior;
    for (int p = 0; p < 4; ++p) unit[at(per * i + p)] = 1.0;
    for (int j = 1; j <= joint.order; ++j) {
      unit[at(per * i + 2 + 2 * j)] = prior.scale / joint.scale_sigma[at(i)][at(j)];
      unit[at(per * i + 3 + 2 * j)] = prior.bias_mps2 / joint.bias_sigma[at(i)][at(j)];
    }
  }
  double* const matrix = work.scratch.data();
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j <= i; ++j) matrix[i * size + j] = unit[at(i)] * work.information[at(i * size + j)] * unit[at(j)];
  }
  mirror_joint(matrix, size);
  JointVector values{};
  if (!symmetric_eigenvalues(matrix, size, size, values.data())) return false;
  const double least = report.rank > 0 ? values[at(size - report.rank)] : 0.0;
  report.condition = least > 0.0 ? std::sqrt(values[at(size - 1)] / least) : 0.0;
  return true;
}

}  // namespace

bool find_rank(const JointAnalysis& a, TemperatureWork& work, TemperatureReport& report) noexcept {
  const TemperatureLevels& levels = report.levels;
  const double middle = 0.5 * (levels.lowest_degc + levels.highest_degc);
  const double half = std::fmax(levels.highest_degc - middle, 0.5 * kLevelsApart_degc);
  const RankBasis basis(a.joint, a.state, {middle - half, middle + half});
  const Joint& joint = basis.joint;
  const int size = joint.parameters();
  double* const matrix = work.scratch.data();
  double* const copy = work.vectors.data();
  JointSums sums;
  reduce_all(joint, basis.state, a.stations, a.count, a.scratch);
  const Problem problem = {joint.sheet, a.g_mps2, {a.scratch, a.count}, a.count, {}, nullptr};
  accumulate(joint, basis.state, problem, a.misfit_variance, Loss::squares, matrix, sums);
  reduce_all(a.joint, a.state, a.stations, a.count, a.scratch);
  mirror_joint(matrix, size);
  const Rotations gauge = joint_gauge_basis(joint, basis.state.theta);
  Vec3 along{};
  for (int q = 0; q < 3; ++q) along[at(q)] = joint_information_along(matrix, gauge[at(q)], size);
  JointVector values{};
  for (int k = 0; k < size * size; ++k) copy[k] = matrix[k];
  if (!symmetric_eigenvalues(copy, size, size, values.data())) return false;
  report.rank = count_above(values, size, a.floor);
  report.gauge = 0;
  for (int q = 0; q < 3; ++q) report.gauge += along[at(q)] <= a.floor * values[at(size - 1)] ? 1 : 0;
  if (report.gauge > size - report.rank) report.gauge = size - report.rank;
  report.null_directions = size - report.rank - report.gauge;
  if (report.null_directions > 0) {
    if (!symmetric_eigen(matrix, size, size, values.data(), work.vectors.data())) return false;
    NullSearch search(joint, work.vectors.data(), size - report.rank);
    search.without(gauge, report.gauge);
    search.run(report);
  }
  return note_condition(a, work, report);
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
