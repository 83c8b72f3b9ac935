#include "station_solver.hpp"

#include <cmath>
#include <limits>

#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;
using numbers::kInfinity;

namespace fit {
namespace {

/// Gauss-Newton on the sphere converges as fast as |x| is near G: after a step below this (squared) the error is far
/// below 1e-4 rad, and the residuals, projected across the tangents, feel its square.
constexpr int kDirectionSteps = 12;
constexpr double kDirectionStop = 1e-8;

/// det(H'H) of the rows of a station, relative to equal axes: |det| of a triple above about 1e-3.
constexpr double kIndependent = 1e-6;

const Parameters kNoParameters{};

}  // namespace

SensorSet usable_channels(const Datasheet& datasheet, const Station& station) noexcept {
  SensorSet usable = station.delivered & SensorSet::first(datasheet.size);
  for (int i = 0; i < datasheet.size; ++i) {
    const double full_scale = datasheet.sensor[at(i)].full_scale_raw;
    if (full_scale > 0.0 && std::fabs(station.mean[at(i)]) >= full_scale) usable = usable.without(i);
  }
  return usable;
}

bool independent(const Datasheet& datasheet, SensorSet delivered) noexcept {
  Symmetric3 h{};
  int rows = 0;
  for (int i = 0; i < datasheet.size; ++i) {
    if (!delivered.has(i)) continue;
    add_outer(h, datasheet.sensor[at(i)].row.axis, 1.0);
    ++rows;
  }
  const double mean = static_cast<double>(rows) / 3.0;
  return rows >= 3 && det(h) > kIndependent * mean * mean * mean;
}

int usable_stations(const Problem& problem) noexcept {
  const SensorSet all = SensorSet::first(problem.datasheet.size);
  int usable = 0;
  for (int s = 0; s < problem.count; ++s) {
    if (problem.stations[s].count == 0) continue;
    const SensorSet channels = usable_channels(problem.datasheet, problem.stations[s]);
    if (channels == all || independent(problem.datasheet, channels)) ++usable;
  }
  return usable;
}

StationSolver::StationSolver(const Problem& problem, const Parameters& theta, double misfit_variance) noexcept
    : problem_(problem), theta_(theta), misfit_variance_(misfit_variance), inverse_g_(1.0 / problem.g_mps2) {
  for (int i = 0; i < problem.datasheet.size; ++i) {
    if (problem.datasheet.sensor[at(i)].full_scale_raw > 0.0) clips_ = true;
  }
}

void StationSolver::set_rows(SensorSet delivered, std::uint32_t count) noexcept {
  delivered_ = delivered;
  count_ = count;
  const Datasheet& datasheet = problem_.datasheet;
  independent_ = delivered == SensorSet::first(datasheet.size) || independent(datasheet, delivered);
  if (!independent_) return;
  const double share = 1.0 / static_cast<double>(count);
  Symmetric3 h{};
  rows = 0;
  for (int i = 0; i < datasheet.size; ++i) {
    if (!delivered.has(i)) continue;
    const std::size_t k = at(rows++);
    const double sigma = datasheet.sensor[at(i)].row.sigma_mps2;
    sensor[k] = i;
    weight[k] = 1.0 / (sigma * sigma * share + misfit_variance_);
    row[k] = row_of(theta_, i);
    add_outer(h, row[k], weight[k]);
  }
  limit_squared = outlier_limit(freedom()) * outlier_limit(freedom());
  const double determinant = det(h);
  const double inverse = determinant > 0.0 ? 1.0 / determinant : 0.0;
  spread = adjugate(h);
  for (double& entry : spread) entry *= inverse;
  for (int k = 0; k < rows; ++k) {
    map_[at(k)] = scaled(times(spread, row[at(k)]), weight[at(k)]);
    for (int l = 0; l <= k; ++l) {
      shared_[at(k * (k + 1) / 2 + l)] = (k == l ? weight[at(k)] : 0.0) - weight[at(l)] * dot(map_[at(k)], row[at(l)]);
    }
  }
}

void StationSolver::set_temperature(double temperature_degc) noexcept {
  temperature_degc_ = temperature_degc;
  tempered_ = true;
  const Datasheet& datasheet = problem_.datasheet;
  const double sign = datasheet.reads == Reads::gravity ? 1.0 : -1.0;
  for (int i = 0; i < datasheet.size; ++i) {
    const SensorCoefficients& c = datasheet.sensor[at(i)].coefficients;
    const double t = temperature_degc - c.reference_degc;
    const double scale = cubic(c.scale, t);
    // A scale of zero has no reading: infinite, and found out with everything else that is not finite.
    gain_[at(i)] = scale != 0.0 ? sign / scale : kInfinity;
    offset_[at(i)] = sign * cubic(c.bias, t) + theta_[at(4 * i + 3)];
  }
}

/// Minimises (x - G u)' A^-1 (x - G u) over the unit vectors u, from the direction of x. Every step is tangent to the
/// sphere: its square is all that lengthens u.
void StationSolver::find_direction() noexcept {
  Vec3 u = scaled(estimate, 1.0 / norm(estimate));
  const Vec3 target = scaled(estimate, inverse_g_);
  for (int step = 0; step < kDirectionSteps; ++step) {
    const Vec3 a = times(spread, u);
    const Vec3 off = minus(target, u);
    const double level = dot(u, a);
    if (level == 0.0) break;  // `solve` finds it out
    const Vec3 tangent = minus(off, scaled(a, dot(u, off) / level));
    const double square = dot(tangent, tangent);
    const bool last = !(square > kDirectionStop);
    // The root, as a series where that is exact.
    u = scaled(plus(u, tangent), last ? 1.0 - square * (0.5 - 0.375 * square) : 1.0 / std::sqrt(1.0 + square));
    if (last) break;
  }
  direction = u;
}

Loaded StationSolver::read(const Station& station) noexcept {
  if (station.count == 0) return Loaded::skipped;
  const SensorSet delivered = clips_ ? usable_channels(problem_.datasheet, station)
                                     : station.delivered & SensorSet::first(problem_.datasheet.size);
  if (count_ != station.count || delivered_ != delivered) set_rows(delivered, station.count);
  if (!independent_) return Loaded::skipped;
  if (!tempered_ || temperature_degc_ != station.temperature_degc) set_temperature(station.temperature_degc);
  Vec3 x{};
  for (int k = 0; k < rows; ++k) {
    const std::size_t i = at(sensor[at(k)]);
    const double y = station.mean[i] * gain_[i] - offset_[i];
    reading[at(k)] = y;
    x = plus(x, scaled(map_[at(k)], y));
  }
  estimate = x;
  const double square = dot(x, x);
  return std::isfinite(square) && square > 0.0 ? Loaded::used : Loaded::not_finite;
}

Loaded StationSolver::solve(const Station& station) noexcept {
  const Loaded loaded = read(station);
  if (loaded != Loaded::used) return loaded;
  find_direction();
  gravity = scaled(direction, problem_.g_mps2);
  along = dot(direction, times(spread, direction));
  if (!(along > 0.0)) return Loaded::not_finite;
  const double deviation = 1.0 / std::sqrt(along);
  norm_residual = (dot(direction, estimate) - problem_.g_mps2) * deviation;
  double sum = norm_residual * norm_residual;
  for (int k = 0; k < rows; ++k) {
    const double p = reading[at(k)] - dot(row[at(k)], estimate);
    parity[at(k)] = p;
    normal[at(k)] = dot(map_[at(k)], direction) * deviation;
    sum += weight[at(k)] * p * p;
  }
  chi2 = sum;
  return std::isfinite(chi2) ? Loaded::used : Loaded::not_finite;
}

double StationSolver::direction_variance() const noexcept {
  const Vec3 a = times(spread, direction);
  return (spread[0] + spread[3] + spread[5] - dot(a, a) / along) / (problem_.g_mps2 * problem_.g_mps2);
}

double huber_limit(int freedom) noexcept {
  constexpr double kAboveMean = 0.586;  // the limit is 2 for two dimensions
  return freedom > 1 ? std::sqrt(static_cast<double>(freedom)) + kAboveMean : 1.345;
}

double outlier_limit(int freedom) noexcept { return freedom > 1 ? 3.0 * huber_limit(freedom) : 4.685; }

double pull_of(Loss loss, double chi2, int freedom) noexcept {
  if (loss == Loss::huber) {
    const double limit = huber_limit(freedom);
    return chi2 > limit * limit ? limit / std::sqrt(chi2) : 1.0;
  }
  if (loss == Loss::tukey) {
    const double limit = outlier_limit(freedom);
    const double rest = 1.0 - chi2 / (limit * limit);
    return rest > 0.0 ? rest * rest : 0.0;
  }
  return 1.0;
}

void note_station(const StationSolver& s, double pull, Sums& sums) noexcept {
  ++sums.stations;
  sums.rows += s.rows;
  sums.chi2 += pull * s.chi2;
  if (s.chi2 > sums.worst * s.limit_squared) sums.worst = s.chi2 / s.limit_squared;
  for (int k = 0; k < s.rows; ++k) {
    const double projected = s.projected(k);
    sums.weighted_chi2 += projected * projected;
  }
}

Screening::Screening(const Problem& problem) noexcept
    : solver(problem, problem.screen != nullptr ? problem.screen->theta : kNoParameters,
             problem.screen != nullptr ? problem.screen->misfit_variance : 0.0),
      active_(problem.screen != nullptr) {}

bool Screening::out(const Station& station) noexcept {
  if (!active_ || solver.solve(station) != Loaded::used) return false;
  return solver.chi2 > solver.limit_squared;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
