#include "plumb/calibration/null_directions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit_internal.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

constexpr int kBasis = kMaxNullDirections + 3;  // and three rotations
/// A combination counts as made of some values if these carry this part of its square: the fitted axes lie a few
/// degrees beside the nominal ones, so "scale" and "axis" are distinguished no better.
constexpr double kCarried = 0.98;
/// And as new if this part of its square is not made of the gauge and of those already found.
constexpr double kNew = 0.2;
/// Axis terms are one rotation of all if it explains this part of their square.
constexpr double kRotation = 0.95;

/// Values of sensors: bit k of `kinds` stands for ParameterKind k.
struct Support {
  unsigned kinds = 0;
  SensorSet sensors;
};

/// The part of a direction that one kind of value of one sensor carries: three numbers, unused ones zero.
Vec3 part_of(const Datasheet& datasheet, const fit::Parameters& v, int kind, int i) noexcept {
  if (kind == 0) return {v[at(4 * i + 3)], 0.0, 0.0};
  const Vec3& h = datasheet.sensor[at(i)].row.axis;
  const Vec3 w = fit::row_of(v, i);
  const double along = dot(w, h);
  if (kind == 1) return {along, 0.0, 0.0};
  return minus(w, scaled(h, along));
}

/// Coefficients over the basis.
using Coefficients = std::array<double, kBasis>;
using Square = std::array<double, std::size_t{kBasis} * kBasis>;

double inner_product(const Coefficients& a, const Coefficients& b, int m) noexcept {
  double sum = 0.0;
  for (int k = 0; k < m; ++k) sum += a[at(k)] * b[at(k)];
  return sum;
}

/// Finds sparse members of the span of null directions and gauge.
class Search {
 public:
  Search(const Datasheet& datasheet, const FitReport& report) noexcept : sheet_(datasheet), p_(4 * datasheet.size) {
    for (int q = 0; q < 3; ++q) {
      // With a roll axis in the fit, only the rotation about it is free.
      if (report.gauge == 3 || (report.gauge == 1 && q == 2)) add_basis(rotation(q));
    }
    known_ = size_;
    const int given = std::clamp(report.null_directions, 0, kMaxNullDirections);
    for (int d = 0; d < given; ++d) add_basis(report.null_direction[at(d)].component);
    wanted_ = size_ - known_;
    for (int k = 0; k < known_; ++k) found_[at(k)][at(k)] = 1.0;
  }

  int run(NullCombinations& out) noexcept {
    out_ = &out;
    const SensorSet all = SensorSet::first(sheet_.size);
    // From one value of one sensor to its three kinds; then the same over all sensors; then pairs; then everything.
    constexpr unsigned kKinds[] = {1U, 2U, 4U, 3U, 5U, 6U, 7U};
    for (const unsigned kinds : kKinds) {
      for (int i = 0; i < sheet_.size; ++i) look_at({kinds, SensorSet::of(i)});
    }
    for (std::size_t k = 0; k + 1 < std::size(kKinds); ++k) look_at({kKinds[k], all});
    for (int i = 0; i < sheet_.size; ++i) {
      for (int j = 0; j < i; ++j) look_at({7U, SensorSet::of(i) | SensorSet::of(j)});
    }
    look_at({7U, all});
    return count_;
  }

 private:
  /// Common rotation about axis q in prior units, for axes as nominal.
  fit::Parameters rotation(int q) const noexcept {
    fit::Parameters out{};
    Vec3 e{};
    e[at(q)] = 1.0;
    for (int i = 0; i < sheet_.size; ++i) {
      const DatasheetSensor& s = sheet_.sensor[at(i)];
      const Vec3 d = cross(s.row.axis, e);
      for (int p = 0; p < 3 && s.prior.axis_rad > 0.0; ++p) out[at(4 * i + p)] = d[at(p)] / s.prior.axis_rad;
    }
    return out;
  }

  /// Gram-Schmidt, twice for rounding; what adds nothing is omitted.
  void add_basis(fit::Parameters v) noexcept {
    const double before = length_of(v);
    for (int pass = 0; pass < 2; ++pass) {
      for (int b = 0; b < size_; ++b) {
        double shared = 0.0;
        for (int k = 0; k < p_; ++k) shared += v[at(k)] * basis_[at(b)][at(k)];
        for (int k = 0; k < p_; ++k) v[at(k)] -= shared * basis_[at(b)][at(k)];
      }
    }
    const double length = length_of(v);
    if (!(length > 1e-3 * before)) return;
    for (int k = 0; k < p_; ++k) basis_[at(size_)][at(k)] = v[at(k)] / length;
    ++size_;
  }

  double length_of(const fit::Parameters& v) const noexcept {
    double sum = 0.0;
    for (int k = 0; k < p_; ++k) sum += v[at(k)] * v[at(k)];
    return std::sqrt(sum);
  }

  /// Square of the part that `support` carries, as a form in the coefficients.
  void fill_form(const Support& support, Square& form) const noexcept {
    form = {};
    std::array<Vec3, kBasis> part{};
    for (int i = 0; i < sheet_.size; ++i) {
      if (!support.sensors.has(i)) continue;
      for (int kind = 0; kind < 3; ++kind) {
        if ((support.kinds >> static_cast<unsigned>(kind) & 1U) == 0U) continue;
        for (int a = 0; a < size_; ++a) part[at(a)] = part_of(sheet_, basis_[at(a)], kind, i);
        for (int a = 0; a < size_; ++a) {
          for (int b = 0; b < size_; ++b) form[at(a * kBasis + b)] += dot(part[at(a)], part[at(b)]);
        }
      }
    }
  }

  /// Takes all new combinations that the support carries.
  void look_at(const Support& support) noexcept {
    if (count_ >= wanted_) return;
    Square form{}, vectors{};
    Coefficients values{};
    fill_form(support, form);
    if (!symmetric_eigen(form.data(), size_, kBasis, values.data(), vectors.data())) return;
    int first = size_;
    while (first > 0 && values[at(first - 1)] >= kCarried) --first;
    for (int round = first; round < size_ && count_ < wanted_; ++round) {
      if (!take_newest(vectors, first)) return;
    }
  }

  /// Of the span of columns `first`.. the member that has least to do with what is known.
  bool take_newest(const Square& vectors, int first) noexcept {
    const int columns = size_ - first;
    std::array<Coefficients, kBasis> rest{};
    for (int c = 0; c < columns; ++c) {
      for (int k = 0; k < size_; ++k) rest[at(c)][at(k)] = vectors[at(k * kBasis + first + c)];
      remove_known(rest[at(c)]);
    }
    Square form{}, mix{};
    Coefficients values{};
    for (int a = 0; a < columns; ++a) {
      for (int b = 0; b < columns; ++b) form[at(a * kBasis + b)] = inner_product(rest[at(a)], rest[at(b)], size_);
    }
    if (!symmetric_eigen(form.data(), columns, kBasis, values.data(), mix.data())) return false;
    if (!(values[at(columns - 1)] > kNew)) return false;
    Coefficients member{};
    for (int k = 0; k < size_; ++k) {
      for (int c = 0; c < columns; ++c)
        member[at(k)] += mix[at(c * kBasis + columns - 1)] * vectors[at(k * kBasis + first + c)];
    }
    write(member);
    remove_known(member);
    const double length = std::sqrt(inner_product(member, member, size_));
    for (int k = 0; k < size_; ++k) found_[at(known_)][at(k)] = member[at(k)] / length;
    ++known_;
    return true;
  }

  void remove_known(Coefficients& c) const noexcept {
    for (int k = 0; k < known_; ++k) {
      const double shared = inner_product(c, found_[at(k)], size_);
      for (int l = 0; l < size_; ++l) c[at(l)] -= shared * found_[at(k)][at(l)];
    }
  }

  void write(const Coefficients& member) noexcept {
    NullCombination& out = (*out_)[at(count_++)];
    out = NullCombination{};
    fit::Parameters& v = out.direction.component;
    for (int b = 0; b < size_; ++b) {
      for (int k = 0; k < p_; ++k) v[at(k)] += member[at(b)] * basis_[at(b)][at(k)];
    }
    list_terms(out);
    find_rotation(out);
  }

  void list_terms(NullCombination& out) const noexcept {
    for (int i = 0; i < sheet_.size; ++i) {
      for (int kind = 0; kind < 3; ++kind) {
        const Vec3 part = part_of(sheet_, out.direction.component, kind, i);
        NullTerm& term = out.term[at(out.terms++)];
        term = {static_cast<ParameterKind>(kind), i, kind == 2 ? norm(part) : part[0], Vec3{}};
        if (kind == 2 && term.amount > 0.0) {
          term.turn = scaled(cross(sheet_.sensor[at(i)].row.axis, part), 1.0 / term.amount);
        }
      }
    }
    for (int k = 1; k < out.terms; ++k) {  // by insertion: std::sort is recursive, and these are few
      for (int l = k; l > 0 && std::fabs(out.term[at(l)].amount) > std::fabs(out.term[at(l - 1)].amount); --l)
        std::swap(out.term[at(l)], out.term[at(l - 1)]);
    }
    const double least = kNullTermShare * std::fabs(out.term[0].amount);
    int kept = out.terms;
    while (kept > 1 && !(std::fabs(out.term[at(kept - 1)].amount) > least)) --kept;
    for (int k = kept; k < out.terms; ++k) out.term[at(k)] = NullTerm{};
    out.terms = kept;
  }

  /// Whether the axes of all sensors turn together, by least squares on dW_i = turn x W_i in natural units.
  void find_rotation(NullCombination& out) const noexcept {
    fit::Symmetric3 inertia{};
    Vec3 moment{};
    double square = 0.0;
    for (int i = 0; i < sheet_.size; ++i) {
      const Vec3& h = sheet_.sensor[at(i)].row.axis;
      const Vec3 d = scaled(part_of(sheet_, out.direction.component, 2, i), sheet_.sensor[at(i)].prior.axis_rad);
      fit::add_outer(inertia, h, -1.0);
      inertia[0] += 1.0;
      inertia[3] += 1.0;
      inertia[5] += 1.0;
      moment = plus(moment, cross(h, d));
      square += dot(d, d);
    }
    const Vec3 turn = fit::solve(inertia, moment);
    const double length = norm(turn);
    double named = 0.0;
    for (int k = 0; k < out.terms; ++k) named += out.term[at(k)].kind == ParameterKind::axis ? 1.0 : 0.0;
    if (!(length > 0.0) || named < 3.0 || !(dot(turn, moment) >= kRotation * square)) return;
    out.rotates_all = true;
    out.rotation = scaled(turn, 1.0 / length);
  }

  const Datasheet& sheet_;
  int p_;
  int size_ = 0;    ///< of the basis
  int known_ = 0;   ///< gauge and combinations found
  int wanted_ = 0;  ///< combinations
  int count_ = 0;
  std::array<fit::Parameters, kBasis> basis_{};
  std::array<Coefficients, kBasis> found_{};  ///< orthonormal
  NullCombinations* out_ = nullptr;
};

}  // namespace

int null_combinations(const Datasheet& datasheet, const FitReport& report, NullCombinations& out) noexcept {
  if (datasheet.size < 1 || datasheet.size > kCapacity) return 0;
  Search search(datasheet, report);
  return search.run(out);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
