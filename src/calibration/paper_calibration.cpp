/// The iteration of the paper's fit: minimum-norm steps of fixed rank, or the plain inverse.
#include "plumb/calibration/paper_calibration.hpp"

#include <cmath>
#include <limits>

#include "fit_internal.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

using fit::at;

/// A singular value below this times the largest is rounding, and its direction is left alone.
constexpr double kRounding = 1e-6;
/// Noise feigns singular values relative to the largest of about its own size relative to gravity: 1 to 3 times that
/// for four to eight sensors.
constexpr double kFeigned = 10.0;
/// At one temperature J'J has rank 3(n+1) <= 4n: every derivative is linear in x times (1 or a reading). What several
/// temperatures add beyond 4n is far smaller, and far from the nine directions that count.
constexpr int kFactorColumns = 4 * kPaperCapacity;

/// All that the iteration needs; the large part of the stack that `paper_calibrate` uses.
struct Workspace {
  int size = 0;                                                                   ///< parameters
  std::array<double, std::size_t{kPaperParameters} * kPaperParameters> matrix{};  ///< row-major, stride `size`
  std::array<double, std::size_t{kPaperParameters} * kFactorColumns> factor{};    ///< stride kFactorColumns
  std::array<double, std::size_t{kFactorColumns} * kFactorColumns> gram{};        ///< stride `columns`
  std::array<double, std::size_t{kFactorColumns} * kFactorColumns> vectors{};     ///< the same
  std::array<double, kFactorColumns> values{};                                    ///< ascending
  int columns = 0;
  PaperParameters gradient{};
  PaperParameters step{};

  double& entry(int i, int j) noexcept { return matrix[at(i * size + j)]; }
  double& root(int i, int j) noexcept { return factor[at(i * kFactorColumns + j)]; }
};

struct Problem {
  const PaperError& error;
  const Station* stations;
  int count;
};

enum class Curvature : std::uint8_t { gauss_newton, full };

/// Half the gradient of the sum of squares, and half its Hessian (lower triangle), with or without the second
/// derivatives of the error.
void assemble(const Problem& problem, const PaperParameters& theta, Curvature curvature, Workspace& work) noexcept {
  work.size = problem.error.parameters();
  work.gradient.fill(0.0);
  work.matrix.fill(0.0);
  PaperParameters slope;
  for (int s = 0; s < problem.count; ++s) {
    if (!problem.error.usable(problem.stations[s])) continue;
    const double e = problem.error(theta, problem.stations[s], &slope);
    for (int a = 0; a < work.size; ++a) {
      work.gradient[at(a)] += e * slope[at(a)];
      for (int b = 0; b <= a; ++b) work.entry(a, b) += slope[at(a)] * slope[at(b)];
    }
    if (curvature == Curvature::full) problem.error.add_curvature(theta, problem.stations[s], e, work.matrix.data());
  }
}

void scale(const PaperParameters& by, Workspace& work) noexcept {
  for (int a = 0; a < work.size; ++a) {
    work.gradient[at(a)] *= by[at(a)];
    for (int b = 0; b <= a; ++b) work.entry(a, b) *= by[at(a)] * by[at(b)];
  }
}

/// matrix = factor factor' by Cholesky with diagonal pivots, as far as there is anything left to factor.
void factorise(Workspace& work) noexcept {
  PaperParameters left{};
  double first = 0.0;
  for (int k = 0; k < work.size; ++k) left[at(k)] = work.entry(k, k);
  const int most = work.size < kFactorColumns ? work.size : kFactorColumns;
  for (work.columns = 0; work.columns < most; ++work.columns) {
    const int c = work.columns;
    int pivot = 0;
    for (int k = 1; k < work.size; ++k) {
      if (left[at(k)] > left[at(pivot)]) pivot = k;
    }
    if (c == 0) first = left[at(pivot)];
    // Written so that a NaN ends it too.
    if (!(left[at(pivot)] > std::numeric_limits<double>::epsilon() * first)) return;
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

/// Eigenvalues of J'J that are not zero, those of factor' factor, and the eigenvectors of the latter. False where there
/// are none or they are not finite.
bool decompose(const Problem& problem, const PaperParameters& theta, Workspace& work) noexcept {
  assemble(problem, theta, Curvature::gauss_newton, work);
  scale(problem.error.prior(), work);
  factorise(work);
  const int r = work.columns;
  for (int a = 0; a < r; ++a) {
    for (int b = 0; b <= a; ++b) {
      double sum = 0.0;
      for (int k = 0; k < work.size; ++k) sum += work.root(k, a) * work.root(k, b);
      work.gram[at(a * r + b)] = sum;
      work.gram[at(b * r + a)] = sum;
    }
  }
  return r > 0 && symmetric_eigen(work.gram.data(), r, r, work.values.data(), work.vectors.data());
}

/// Eigenvectors of J'J are factor y / sqrt(value), so that the step is -factor y (y' factor' gradient) / value^2.
bool minimum_norm_step(const Problem& problem, const PaperParameters& theta, Workspace& work) noexcept {
  if (!decompose(problem, theta, work)) return false;
  const int r = work.columns;
  std::array<double, kFactorColumns> slope{};
  for (int c = 0; c < r; ++c) {
    for (int k = 0; k < work.size; ++k) slope[at(c)] += work.root(k, c) * work.gradient[at(k)];
  }
  std::array<double, kFactorColumns> along{};
  for (int v = r - 1; v >= 0 && v >= r - kPaperRank; --v) {
    const double value = work.values[at(v)];
    if (!(value > kRounding * kRounding * work.values[at(r - 1)])) break;
    double share = 0.0;
    for (int c = 0; c < r; ++c) share += work.vectors[at(c * r + v)] * slope[at(c)];
    for (int c = 0; c < r; ++c) along[at(c)] += work.vectors[at(c * r + v)] * (share / value / value);
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
  assemble(problem, theta, Curvature::full, work);
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

/// Left side of the stop rule. A frozen parameter that stays where it is has not changed, whatever its size.
double change_between(const PaperParameters& now, const PaperParameters& before, const PaperParameters& prior,
                      int size) noexcept {
  double largest = 0.0;
  for (int k = 0; k < size; ++k) {
    const double moved = std::fabs(now[at(k)] - before[at(k)]);
    if (moved == 0.0) continue;
    const double mean = 0.5 * std::fabs(now[at(k)] + before[at(k)]);
    const double floor = std::fmax(std::fmax(mean, prior[at(k)]), std::numeric_limits<double>::min());
    largest = std::fmax(largest, moved / floor);
  }
  return largest;
}

void note(const PaperParameters& theta, double cost, double change, PaperTrace* trace) noexcept {
  if (trace == nullptr || trace->size > kMaxPaperIterations) return;
  PaperIteration& entry = trace->iteration[at(trace->size++)];
  entry.parameter = theta;
  entry.cost = cost;
  entry.change = change;
}

Error check_options(const PaperOptions& o) noexcept {
  if (!(o.damping > 0.0 && o.damping <= 1.0)) return Error{Errc::out_of_range, 0, o.damping, 1.0};
  if (!(o.stop > 0.0) || !std::isfinite(o.stop)) return Error{Errc::out_of_range, 1, o.stop, 0.0};
  if (o.max_iterations < 1 || o.max_iterations > kMaxPaperIterations) {
    return Error{Errc::out_of_range, 2, static_cast<double>(o.max_iterations), kMaxPaperIterations};
  }
  return Error{};
}

Error check_stations(const Problem& problem) noexcept {
  int usable = 0;
  for (int s = 0; s < problem.count; ++s) {
    if (!problem.error.usable(problem.stations[s])) continue;
    const double error = problem.error(problem.error.start(), problem.stations[s]);
    if (!std::isfinite(error)) return Error{Errc::not_finite, s, error, 0.0};
    ++usable;
  }
  if (usable < kPaperRank) return Error{Errc::too_few_stations, -1, static_cast<double>(usable), kPaperRank};
  return Error{};
}

/// Standard deviation of a station mean relative to gravity, all sensors and stations together.
double relative_noise(const Datasheet& datasheet, const Problem& problem, double g_mps2) noexcept {
  double sum = 0.0;
  int terms = 0;
  for (int s = 0; s < problem.count; ++s) {
    if (!problem.error.usable(problem.stations[s])) continue;
    for (int i = 0; i < datasheet.size; ++i) {
      if (!problem.error.used().has(i)) continue;
      const double sigma = datasheet.sensor[at(i)].row.sigma_mps2;
      sum += sigma * sigma / problem.stations[s].count;
      ++terms;
    }
  }
  return terms > 0 ? std::sqrt(sum / terms) / g_mps2 : 0.0;
}

int rank_at(const Problem& problem, const PaperParameters& theta, double noise, Workspace& work) noexcept {
  if (!decompose(problem, theta, work)) return 0;
  const double floor = std::fmax(kRounding, kFeigned * noise);
  int rank = 0;
  for (int v = 0; v < work.columns; ++v) {
    if (work.values[at(v)] > floor * floor * work.values[at(work.columns - 1)]) ++rank;
  }
  return rank;
}

/// From the start to the stop; fills what `out` says of the way and leaves `theta` at the end.
void iterate(const Problem& problem, const PaperOptions& options, Workspace& work, PaperParameters& theta,
             PaperFit& out, PaperTrace* trace) noexcept {
  const int size = problem.error.parameters();
  out.start_cost = out.cost = problem.error.cost(theta, problem.stations, problem.count);
  note(theta, out.cost, 0.0, trace);
  while (out.stop == StopReason::none) {
    const bool solved = options.step == PaperStep::minimum_norm ? minimum_norm_step(problem, theta, work)
                                                                : plain_inverse_step(problem, theta, work);
    PaperParameters next = theta;
    for (int k = 0; k < size; ++k) next[at(k)] += options.damping * work.step[at(k)];
    const double cost = solved ? problem.error.cost(next, problem.stations, problem.count) : 0.0;
    const double change = change_between(next, theta, problem.error.prior(), size);
    if (!solved || !std::isfinite(cost) || !std::isfinite(change)) {
      out.stop = StopReason::not_finite;
      break;
    }
    theta = next;
    out.cost = cost;
    ++out.iterations;
    note(theta, cost, change, trace);
    if (change < options.stop) {
      out.stop = StopReason::converged;
    } else if (out.iterations >= options.max_iterations) {
      out.stop = StopReason::iteration_limit;
    }
  }
  out.converged = out.stop == StopReason::converged;
}

}  // namespace

Expected<void> paper_calibrate(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                               int count, SensorSet used, const PaperOptions& options, PaperFit& out,
                               PaperTrace* trace) noexcept {
  const Error bad_option = check_options(options);
  if (bad_option.code != Errc::ok) return tl::unexpected<Error>(bad_option);
  const Expected<PaperError> error = PaperError::make(datasheet, gravity, used);
  if (!error) return tl::unexpected<Error>(error.error());
  const Problem problem = {*error, stations, stations == nullptr ? 0 : count};
  const Error bad_station = check_stations(problem);
  if (bad_station.code != Errc::ok) return tl::unexpected<Error>(bad_station);
  out = PaperFit{};
  out.used = used;
  out.model = datasheet.model();
  if (trace != nullptr) trace->size = 0;
  Workspace work;
  PaperParameters theta = error->start();
  iterate(problem, options, work, theta, out, trace);
  out.rank = rank_at(problem, theta, relative_noise(datasheet, problem, gravity.g_mps2), work);
  error->store(theta, out.model);
  return {};
}

Expected<void> paper_calibrate_all(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                                   int count, const PaperOptions& options, PaperCalibration& out) noexcept {
  const int n = datasheet.size;
  if (n > kPaperCapacity) return fail(Errc::too_many_sensors, -1, static_cast<double>(n), kPaperCapacity);
  const Expected<void> all =
      paper_calibrate(datasheet, gravity, stations, count, SensorSet::first(n), options, out.all);
  if (!all) return all;
  out.triples = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        PaperFit& fit = out.triple[at(out.triples++)];
        const SensorSet used = SensorSet::of(i).with(j).with(k);
        if (paper_calibrate(datasheet, gravity, stations, count, used, options, fit)) continue;
        fit = PaperFit{};
        fit.used = used;
        fit.model = datasheet.model();
      }
    }
  }
  return {};
}

}  // namespace PLUMB_ABI
}  // namespace plumb
