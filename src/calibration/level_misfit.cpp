/// A sensor that bends over temperature as no polynomial of the fit does: the mean of its residuals at one temperature
/// level.
#include <cmath>

#include "fit_report.hpp"
#include "plumb/calibration/temperature_fit.hpp"
#include "plumb/numeric/tails.hpp"
#include "station_solver.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

/// By chance alone some mean of some sensor at some level is named in so many fits.
constexpr double kChance = 1e-4;
/// Stations beyond one a level that tell how much a sensor scatters within its levels.
constexpr double kScatterFreedom = 10.0;

/// Of the outlier limit. With the whole of it 2 % of healthy recordings with 5 % spikes are refused, with half none.
constexpr double kVote = 0.5;

struct Means {
  std::array<double, kCapacity> pull{}, weight{}, square{};
  std::array<int, kCapacity> stations{};
};

struct Solvers {
  Screening screening;
  StationSolver own, with_misfit;
};

/// Where a bend is steep, its own stations are those rejected: they pull half as much as a station may that is not, so
/// that a few stray ones decide nothing.
double vote_of_one_aside(StationSolver& with_misfit, const Station& station) noexcept {
  with_misfit.solve(station);  // as without the misfit it could be
  if (!(with_misfit.chi2 > with_misfit.limit_squared)) return 1.0;
  return kVote * std::sqrt(with_misfit.limit_squared / with_misfit.chi2);
}

/// Sums over the stations of one level. The residual of a reading is (M e)_k / M_kk with weight M_kk, M the projector
/// across the fitted direction.
Means means_of(Solvers& solvers, const Problem& problem, const Station* all, double lowest_degc) noexcept {
  Means out;
  StationSolver& solver = solvers.own;
  for (int s = 0; s < problem.count; ++s) {
    Station station = problem.stations[s];
    if (!(station.temperature_degc >= lowest_degc && station.temperature_degc < lowest_degc + kLevelsApart_degc)) {
      continue;
    }
    const bool aside = station.count != all[s].count || solvers.screening.out(station);
    station.count = all[s].count;
    if (solver.solve(station) != Loaded::used) continue;
    const double vote = aside ? vote_of_one_aside(solvers.with_misfit, station) : 1.0;
    for (int k = 0; k < solver.rows; ++k) {
      const double weight = solver.projector(k, k), pull = vote * solver.projected(k);
      if (!(weight > kOwnResidual * solver.weight[at(k)])) continue;
      const std::size_t i = at(solver.sensor[at(k)]);
      out.pull[i] += pull;
      out.weight[i] += weight;
      out.square[i] += pull * pull / weight;
      ++out.stations[i];
    }
  }
  return out;
}

}  // namespace

LevelMisfit level_misfit(const Problem& problem, const Parameters& theta, const Station* all,
                         double misfit_variance) noexcept {
  LevelMisfit out;
  const TemperatureLevels levels = temperature_levels(all, problem.count);
  if (levels.count < 2) return out;
  const int n = problem.datasheet.size;
  Solvers solvers = {Screening(problem), StationSolver(problem, theta, 0.0),
                     StationSolver(problem, theta, misfit_variance)};
  std::array<LevelMisfit, kCapacity> most{};
  std::array<double, kCapacity> scatter{}, freedom{};
  for (int level = 0; level < levels.count; ++level) {
    const Means m = means_of(solvers, problem, all, levels.begin_degc[at(level)]);
    for (int i = 0; i < n; ++i) {
      if (m.stations[at(i)] < 2) continue;
      const double mean = m.pull[at(i)] / m.weight[at(i)], sigma = 1.0 / std::sqrt(m.weight[at(i)]);
      scatter[at(i)] += m.square[at(i)] - mean * m.pull[at(i)];
      freedom[at(i)] += m.stations[at(i)] - 1.0;
      if (!(std::fabs(mean) > most[at(i)].sigmas() * sigma)) continue;
      most[at(i)] = {i, levels.degc[at(level)], mean, sigma, {}};
    }
  }
  // A fit bends towards its stations, so that a mean scatters by less than its sigma, never more: the bound holds.
  const double chance = kChance / (n * levels.count);
  for (int i = 0; i < n; ++i) {
    if (freedom[at(i)] < kScatterFreedom) continue;
    // A sensor that is unruly within its levels too has means that are. The misfit of the fit does not say it: a bend
    // is part of that.
    most[at(i)].sigma_mps2 *= std::sqrt(std::fmax(scatter[at(i)] / freedom[at(i)], 1.0));
    const double z = most[at(i)].sigmas();
    if (z > out.sigmas() && chi2_tail(z * z, 1) < chance) out = most[at(i)];
  }
  for (int i = 0; i < n && out.sensor >= 0; ++i) {
    const double z = most[at(i)].sigmas(), best = out.sigmas();
    if (z * z > best * best - kSeparable) out.suspects = out.suspects.with(i);
  }
  return out;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
