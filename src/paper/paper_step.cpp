#include "paper_step.hpp"

#include <cmath>
#include <limits>

#include "plumb/numeric/cholesky.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"
#include "plumb/numeric/symmetric_eigenvalues.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace paper {
namespace {

/// A singular value below this times the largest is rounding, and its direction is left alone.
constexpr double kRounding = 1e-6;
/// Noise feigns singular values relative to the largest of about its own size relative to gravity: 1 to 3 times that
/// for four to eight sensors.
constexpr double kFeigned = 10.0;
/// The nine directions are found by subspace iteration from the nine first pivots where the tenth is so much weaker (in
/// squares, over the ninth): in one step, or in two. By all eigenvectors elsewhere.
constexpr double kVeryFarBelow = 1e-6;
constexpr double kFarBelow = 1e-4;
constexpr double kNothing = 1e-12;   ///< or there is no tenth
constexpr double kEven = 1e-2;       ///< ninth over first pivot, in squares: their products need no care
constexpr double kTooUneven = 1e-8;  ///< the nine themselves are near rounding

/// Half the gradient of the sum of squares, and half its Hessian (lower triangle), second derivatives of the error
/// included.
void assemble_full(const Problem& problem, const PaperParameters& theta, Workspace& work) noexcept {
  work.size = problem.error.parameters();
  work.stride = work.size;
  work.gradient.fill(0.0);
  for (int k = 0; k < work.size * work.size; ++k) work.matrix[at(k)] = 0.0;
  PaperParameters slope;
  for (int s = 0; s < problem.count; ++s) {
    if (!problem.error.usable(problem.stations[s])) continue;
    const double e = problem.error(theta, problem.stations[s], &slope);
    for (int a = 0; a < work.size; ++a) {
      work.gradient[at(a)] += e * slope[at(a)];
      for (int b = 0; b <= a; ++b) work.entry(a, b) += slope[at(a)] * slope[at(b)];
    }
    problem.error.add_curvature(theta, problem.stations[s], e, work.matrix.data());
  }
}

/// matrix = factor factor' by Cholesky with diagonal pivots, as far as there is anything left to factor.
void factorise(Workspace& work) noexcept {
  PaperParameters left{};
  double first = 0.0;
  for (int k = 0; k < work.size; ++k) left[at(k)] = work.entry(k, k);
  const int most = work.size < kFactorColumns ? work.size : kFactorColumns;
  work.rest = 0.0;
  for (work.columns = 0; work.columns < most; ++work.columns) {
    const int c = work.columns;
    if (c == kPaperRank) {
      for (int k = 0; k < work.size; ++k) work.rest += left[at(k)];
      if (!(work.rest > kNothing * work.pivot[kPaperRank - 1])) return;
    }
    int pivot = 0;
    for (int k = 1; k < work.size; ++k) {
      if (left[at(k)] > left[at(pivot)]) pivot = k;
    }
    if (c == 0) first = left[at(pivot)];
    // Written so that a NaN ends it too.
    if (!(left[at(pivot)] > std::numeric_limits<double>::epsilon() * first)) return;
    work.pivot[at(c)] = left[at(pivot)];
    const double length = std::sqrt(left[at(pivot)]);
    for (int k = 0; k < work.size; ++k) {
      double sum = k > pivot ? work.entry(k, pivot) : work.entry(pivot, k);
      for (int j = 0; j < c; ++j) sum -= work.root(k, j) * work.root(pivot, j);
      work.root(k, c) = sum / length;
      left[at(k)] -= work.root(k, c) * work.root(k, c);
    }
    left[at(pivot)] = 0.0;
  }
}

/// factor' factor, whose eigenvalues are those of J'J that are not zero.
void set_gram(Workspace& work) noexcept {
  const int r = work.columns;
  for (int a = 0; a < r; ++a) {
    for (int b = 0; b <= a; ++b) work.gram[at(a * r + b)] = 0.0;
  }
  for (int k = 0; k < work.size; ++k) {
    for (int a = 0; a < r; ++a) {
      const double own = work.root(k, a);
      for (int b = 0; b <= a; ++b) work.gram[at(a * r + b)] += own * work.root(k, b);
    }
  }
  for (int a = 0; a < r; ++a) {
    for (int b = 0; b < a; ++b) work.gram[at(b * r + a)] = work.gram[at(a * r + b)];
  }
}

using Column = std::array<double, kFactorColumns>;
using Nine = std::array<Column, kPaperRank>;

double inner(const Column& a, const Column& b, int r) noexcept {
  double sum = 0.0;
  for (int k = 0; k < r; ++k) sum += a[at(k)] * b[at(k)];
  return sum;
}

/// gram times y.
Column times_gram(const Workspace& work, const Column& y) noexcept {
  const int r = work.columns;
  Column out{};
  for (int k = 0; k < r; ++k) {
    for (int a = 0; a < r; ++a) out[at(a)] += work.gram[at(k * r + a)] * y[at(k)];
  }
  return out;
}

/// The nine strongest directions from the nine pivots; false where that would be slow. The tenth fades by `rest` over
/// the ninth pivot a step, from the root of that; 1e-9 is to be left. The first step is the Gram matrix itself.
bool strongest(const Workspace& work, Nine& y) noexcept {
  const int r = work.columns;
  if (r < kPaperRank) return false;
  const double ninth = work.pivot[kPaperRank - 1];
  if (!(work.rest <= kFarBelow * ninth) || !(ninth > kTooUneven * work.pivot[0])) return false;
  for (int c = 0; c < kPaperRank; ++c) {
    for (int k = 0; k < r; ++k) y[at(c)][at(k)] = work.gram[at(c * r + k)];
  }
  const bool again = work.rest > kVeryFarBelow * ninth;
  for (int c = 0; c < kPaperRank && again; ++c) y[at(c)] = times_gram(work, y[at(c)]);
  if (!again && ninth > kEven * work.pivot[0]) return true;
  for (int c = 0; c < kPaperRank; ++c) {
    for (int b = 0; b < c; ++b) {
      const double shared = inner(y[at(b)], y[at(c)], r);
      for (int k = 0; k < r; ++k) y[at(c)][at(k)] -= shared * y[at(b)][at(k)];
    }
    const double length = std::sqrt(inner(y[at(c)], y[at(c)], r));
    if (!(length > 0.0)) return false;
    for (int k = 0; k < r; ++k) y[at(c)][at(k)] /= length;
  }
  return true;
}

/// Y (Y' gram^2 Y)^-1 Y' slope, Y the nine strongest directions.
bool along_strongest(const Workspace& work, const Column& slope, Column& along) noexcept {
  Nine y, image;
  if (!strongest(work, y)) return false;
  const int r = work.columns;
  std::array<double, std::size_t{kPaperRank} * kPaperRank> matrix{};
  std::array<double, kPaperRank> share{};
  for (int a = 0; a < kPaperRank; ++a) {
    image[at(a)] = times_gram(work, y[at(a)]);
    share[at(a)] = inner(y[at(a)], slope, r);
    for (int b = 0; b <= a; ++b) matrix[at(a * kPaperRank + b)] = inner(image[at(a)], image[at(b)], r);
  }
  if (!cholesky_factor(matrix.data(), kPaperRank, kPaperRank)) return false;
  cholesky_solve(matrix.data(), kPaperRank, kPaperRank, share.data());
  along.fill(0.0);
  for (int a = 0; a < kPaperRank; ++a) {
    for (int c = 0; c < r; ++c) along[at(c)] += y[at(a)][at(c)] * share[at(a)];
  }
  return true;
}

/// gram^-2 slope where the nine columns are all there is.
bool along_nine(const Workspace& work, const Column& slope, Column& along) noexcept {
  if (work.columns != kPaperRank || !(work.pivot[kPaperRank - 1] > kTooUneven * work.pivot[0])) return false;
  std::array<double, std::size_t{kPaperRank} * kPaperRank> matrix{};
  for (std::size_t k = 0; k < matrix.size(); ++k) matrix[k] = work.gram[k];
  if (!cholesky_factor(matrix.data(), kPaperRank, kPaperRank)) return false;
  along = slope;
  cholesky_solve(matrix.data(), kPaperRank, kPaperRank, along.data());
  cholesky_solve(matrix.data(), kPaperRank, kPaperRank, along.data());
  return true;
}

/// The same by all eigenvectors; destroys the Gram matrix.
bool along_eigenvectors(Workspace& work, const Column& slope, Column& along) noexcept {
  const int r = work.columns;
  if (!symmetric_eigen(work.gram.data(), r, r, work.values.data(), work.vectors.data())) return false;
  along.fill(0.0);
  for (int v = r - 1; v >= 0 && v >= r - kPaperRank; --v) {
    const double value = work.values[at(v)];
    if (!(value > kRounding * kRounding * work.values[at(r - 1)])) break;
    double share = 0.0;
    for (int c = 0; c < r; ++c) share += work.vectors[at(c * r + v)] * slope[at(c)];
    for (int c = 0; c < r; ++c) along[at(c)] += work.vectors[at(c * r + v)] * (share / value / value);
  }
  return true;
}

}  // namespace

double assemble(const Problem& problem, const PaperParameters& theta, Workspace& work) noexcept {
  work.size = problem.error.parameters();
  work.stride = (work.size + 3) / 4 * 4;
  const double cost = problem.error.gauss_newton(theta, problem.stations, problem.count, work.matrix.data(),
                                                 work.stride, work.gradient);
  const PaperParameters& by = problem.error.prior();
  for (int a = 0; a < work.size; ++a) {
    work.gradient[at(a)] *= by[at(a)];
    for (int b = 0; b <= a; ++b) work.entry(a, b) *= by[at(a)] * by[at(b)];
  }
  return cost;
}

/// From the matrix and gradient of `assemble`. Eigenvectors of J'J are factor y / sqrt(value), so that the step is
/// -factor y (y' factor' gradient) / value^2.
bool minimum_norm_step(const Problem& problem, Workspace& work) noexcept {
  factorise(work);
  const int r = work.columns;
  if (r == 0) return false;
  set_gram(work);
  Column slope{}, along;
  for (int k = 0; k < work.size; ++k) {
    for (int c = 0; c < r; ++c) slope[at(c)] += work.root(k, c) * work.gradient[at(k)];
  }
  if (!along_nine(work, slope, along) && !along_strongest(work, slope, along) &&
      !along_eigenvectors(work, slope, along)) {
    return false;
  }
  for (int k = 0; k < work.size; ++k) {
    double sum = 0.0;
    for (int c = 0; c < r; ++c) sum -= work.root(k, c) * along[at(c)];
    work.step[at(k)] = sum * problem.error.prior()[at(k)];
  }
  return true;
}

/// The matrix, filled from its lower triangle, is eliminated with row pivots; no other safeguard.
bool plain_inverse_step(const Problem& problem, const PaperParameters& theta, Workspace& work) noexcept {
  assemble_full(problem, theta, work);
  const int n = work.size;
  for (int a = 0; a < n; ++a) {
    work.step[at(a)] = -work.gradient[at(a)];
    for (int b = 0; b < a; ++b) work.entry(b, a) = work.entry(a, b);
  }
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int a = c + 1; a < n; ++a) {
      if (std::fabs(work.entry(a, c)) > std::fabs(work.entry(pivot, c))) pivot = a;
    }
    if (work.entry(pivot, c) == 0.0) return false;
    for (int b = 0; b < n && pivot != c; ++b) {
      const double kept = work.entry(c, b);
      work.entry(c, b) = work.entry(pivot, b);
      work.entry(pivot, b) = kept;
    }
    const double kept = work.step[at(c)];
    work.step[at(c)] = work.step[at(pivot)];
    work.step[at(pivot)] = kept;
    for (int a = c + 1; a < n; ++a) {
      const double share = work.entry(a, c) / work.entry(c, c);
      for (int b = c + 1; b < n; ++b) work.entry(a, b) -= share * work.entry(c, b);
      work.step[at(a)] -= share * work.step[at(c)];
    }
  }
  for (int a = n - 1; a >= 0; --a) {
    for (int b = a + 1; b < n; ++b) work.step[at(a)] -= work.entry(a, b) * work.step[at(b)];
    work.step[at(a)] /= work.entry(a, a);
  }
  return true;
}

double rank_floor(double noise) noexcept { return std::fmax(kRounding, kFeigned * noise); }

/// From the matrix of `assemble`.
int rank_of(double noise, Workspace& work) noexcept {
  factorise(work);
  const int r = work.columns;
  if (r == 0) return 0;
  set_gram(work);
  if (!symmetric_eigenvalues(work.gram.data(), r, r, work.values.data())) return 0;
  const double floor = rank_floor(noise);
  int rank = 0;
  for (int v = 0; v < r; ++v) {
    if (work.values[at(v)] > floor * floor * work.values[at(r - 1)]) ++rank;
  }
  return rank;
}

}  // namespace paper
}  // namespace PLUMB_ABI
}  // namespace plumb
