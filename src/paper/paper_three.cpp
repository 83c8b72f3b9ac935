#include "paper_three.hpp"

#include <cmath>
#include <limits>

#include "paper_points.hpp"
#include "plumb/numeric/cholesky.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace paper {
namespace {

constexpr int kNine = kPaperRank;
/// Where the monomials of pairs are: 3 is that of the first reading squared.
constexpr std::array<std::array<int, 3>, 3> kPair = {{{3, 4, 5}, {4, 6, 7}, {5, 7, 8}}};
/// Least pivot over the largest, in squares: below it the general step decides what is rounding.
constexpr double kTooUneven = 1e-8;

/// Replaces the matrix by its Cholesky factor; false where it is uneven.
bool factor_even(double* matrix, int stride) noexcept {
  if (!cholesky_factor(matrix, kNine, stride)) return false;
  double least = matrix[0], most = matrix[0];
  for (int k = 1; k < kNine; ++k) {
    const double pivot = matrix[at(k * stride + k)];
    least = pivot < least ? pivot : least;
    most = pivot > most ? pivot : most;
  }
  return least * least > kTooUneven * most * most;
}

/// Of two symmetric matrices, from their lower triangles.
double trace_of_product(const double* a, const double* b, int stride) noexcept {
  double sum = 0.0;
  for (int i = 0; i < kNine; ++i) {
    const std::size_t row = at(i * stride), own = row + at(i);
    for (std::size_t k = row; k < own; ++k) sum += 2.0 * a[k] * b[k];
    sum += a[own] * b[own];
  }
  return sum;
}

}  // namespace

ThreeSensorStep::Column ThreeSensorStep::monomials(const Vec3& u) noexcept {
  return {u[0], u[1], u[2], u[0] * u[0], u[0] * u[1], u[0] * u[2], u[1] * u[1], u[1] * u[2], u[2] * u[2], 1.0};
}

/// Coefficients of a times (slope u + constant) of one sensor, times `prior`, in their places; the others stay zero.
/// The constant one follows from the nine.
void ThreeSensorStep::product(const Affine& a, int sensor, double slope, double constant, double prior,
                              Column& out) noexcept {
  for (int k = 0; k < kSensors; ++k) {
    const double own = prior * a.slope[at(k)];
    out[at(k)] = own * constant;
    out[at(kPair[at(sensor)][at(k)])] = own * slope;
  }
  out[at(sensor)] += prior * a.constant * slope;
}

bool ThreeSensorStep::begin(const Problem& problem) noexcept {
  const PaperError& error = problem.error;
  if (error.sensors() != kSensors) return false;
  g_mps2_ = std::sqrt(error.g_squared_);
  moments_.fill(0.0);
  PaperError::Prepared start = error.prepare(error.start());
  for (int s = 0; s < problem.count; ++s) {
    const Station& station = problem.stations[s];
    if (!error.usable(station)) continue;
    if (!start.tempered || start.temperature_degc != station.temperature_degc) {
      const bool first = !start.tempered;
      error.temper(station.temperature_degc, start);
      const Vec3 drift = {start.drift[0], start.drift[1], start.drift[2]};
      if (first) drift_ = drift;
      if (drift != drift_) return false;
    }
    Vec3 u;
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = (station.mean[at(error.sensor_[i])] * start.gain[i] - drift_[i]) / g_mps2_;
    }
    const Column f = monomials(u);
    add_square(f.data(), kNine + 1, moments_.data(), kStride);
  }
  return true;
}

double ThreeSensorStep::look(const Problem& problem, const PaperParameters& theta) noexcept {
  const PaperError& error = problem.error;
  PaperError::Prepared now = error.prepare(theta);
  if (!now.finite) return std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < column_.size(); ++i) {
    if (now.ratio[i] == 0.0) return std::numeric_limits<double>::quiet_NaN();  // less than the least double
    column_[i] = now.column[i];
    inverse_[i] = now.inverse[i];
    scale_[i] = g_mps2_ / now.ratio[i];
    offset_[i] = drift_[i] / now.ratio[i];
    shrink_[i] = now.ratio[i] / g_mps2_;
  }
  const double g_squared = error.g_squared_;
  Column slope{};
  double sum = 0.0;
  int used = 0;
  for (int s = 0; s < problem.count; ++s) {
    const Station& station = problem.stations[s];
    if (!error.usable(station)) continue;
    if (!now.tempered || now.temperature_degc != station.temperature_degc) {
      error.temper(station.temperature_degc, now);
      now_ = {now.drift[0], now.drift[1], now.drift[2]};
    }
    const auto direct = [&](std::size_t i) { return station.mean[at(error.sensor_[i])] * now.gain[i]; };
    const Vec3 y = {direct(0), direct(1), direct(2)};
    const Vec3 r = minus(y, now_), w = minus(y, offset_);
    const Vec3 u = {w[0] * shrink_[0], w[1] * shrink_[1], w[2] * shrink_[2]};
    const Vec3 x = plus(plus(scaled(column_[0], r[0]), scaled(column_[1], r[1])), scaled(column_[2], r[2]));
    const double e = dot(x, x) - g_squared;
    const Vec3 weighted = scaled(u, e);
    slope[0] += weighted[0];
    slope[1] += weighted[1];
    slope[2] += weighted[2];
    slope[3] += weighted[0] * u[0];
    slope[4] += weighted[0] * u[1];
    slope[5] += weighted[0] * u[2];
    slope[6] += weighted[1] * u[1];
    slope[7] += weighted[1] * u[2];
    slope[8] += weighted[2] * u[2];
    slope[9] += e;
    sum += e * e;
    ++used;
  }
  slope_ = slope;
  return used > 0 ? sum / used : std::numeric_limits<double>::quiet_NaN();
}

/// Every derivative of the error as a quadratic of u, and where they vanish.
void ThreeSensorStep::set_coefficients(const Problem& problem) noexcept {
  const PaperError& error = problem.error;
  const PaperParameters& prior = error.prior();
  std::array<Vec3, kSensors> slope{};  // of x by u
  Vec3 x{}, origin{};                  // at u = 0; u where x vanishes
  for (int i = 0; i < kSensors; ++i) {
    const double rest = offset_[at(i)] - now_[at(i)];
    slope[at(i)] = scaled(column_[at(i)], scale_[at(i)]);
    x = plus(x, scaled(column_[at(i)], rest));
    origin[at(i)] = -rest * shrink_[at(i)];
  }
  origin_ = monomials(origin);
  const auto along = [&slope, &x](const Vec3& direction) {
    const Vec3 w = scaled(direction, -2.0);
    return Affine{{dot(w, slope[0]), dot(w, slope[1]), dot(w, slope[2])}, dot(w, x)};
  };
  for (int i = 0; i < kSensors; ++i) {
    const Affine own = along(column_[at(i)]), row = along(error.map_[at(i)]);
    const int factor = kSensors + i;
    product(own, i, 0.0, 1.0, prior[at(i)], coefficient_[at(i)]);
    product(own, i, scale_[at(i)] * inverse_[at(i)], offset_[at(i)] * inverse_[at(i)], prior[at(factor)],
            coefficient_[at(factor)]);
    for (int j = 0; j < kSensors; ++j) {
      if (j == i) continue;
      const int m = error.misalignment(i, j);
      product(row, j, scale_[at(j)], offset_[at(j)] - now_[at(j)], prior[at(m)], coefficient_[at(m)]);
    }
  }
}

/// F'F, its monomials counted from where x vanishes, and K K'.
void ThreeSensorStep::set_squares(const Problem& problem) noexcept {
  set_coefficients(problem);
  parameters_.fill(0.0);
  for (const Column& c : coefficient_) add_square(c.data(), kNine, parameters_.data(), kStride);
  const double* sum = moments_.data() + at(kNine * kStride);
  for (int a = 0; a < kNine; ++a) {
    for (int b = 0; b <= a; ++b) {
      const std::size_t k = at(a * kStride + b);
      stations_[k] = moments_[k] - sum[a] * origin_[at(b)] - origin_[at(a)] * (sum[b] - sum[kNine] * origin_[at(b)]);
    }
  }
}

bool ThreeSensorStep::factorise() noexcept {
  return factor_even(stations_.data(), kStride) && factor_even(parameters_.data(), kStride);
}

bool ThreeSensorStep::step(const Problem& problem, PaperParameters& out) noexcept {
  set_squares(problem);
  if (!factorise()) return false;
  Column along = slope_;
  for (int k = 0; k < kNine; ++k) along[at(k)] -= origin_[at(k)] * slope_[kNine];
  cholesky_solve(stations_.data(), kNine, kStride, along.data());
  cholesky_solve(parameters_.data(), kNine, kStride, along.data());
  out.fill(0.0);
  for (int p = 0; p < kSize; ++p) {
    double sum = 0.0;
    for (int k = 0; k < kNine; ++k) sum -= coefficient_[at(p)][at(k)] * along[at(k)];
    out[at(p)] = sum * problem.error.prior()[at(p)];
  }
  return true;
}

/// The eigenvalues of F'F K K' are those of J'J, nine of them: their sum is above the largest, the sum of their
/// inverses above that of the least.
bool ThreeSensorStep::shows_all(const Problem& problem, double floor) noexcept {
  set_squares(problem);
  const double sum = trace_of_product(stations_.data(), parameters_.data(), kStride);
  if (!factorise()) return false;
  cholesky_inverse(stations_.data(), kNine, kStride);
  cholesky_inverse(parameters_.data(), kNine, kStride);
  const double inverses = trace_of_product(stations_.data(), parameters_.data(), kStride);
  return floor * floor * sum * inverses < 1.0;
}

}  // namespace paper
}  // namespace PLUMB_ABI
}  // namespace plumb
