/// What the fit leaves: residuals by sensor, norm, parity, chi^2, and how well the attitudes excite it.
#include <cmath>

#include "fit_internal.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {
namespace {

constexpr int kHarmonics = 9;
using Gram = std::array<double, std::size_t{kHarmonics} * kHarmonics>;

/// Spherical harmonics of degree 0 to 2, normalised so that their Gram matrix over the sphere is 1. The
/// length of the vector sees the parameters through these nine alone (calibration note 4).
std::array<double, kHarmonics> harmonics_of(const Vec3& u) noexcept {
  const double s3 = std::sqrt(3.0), s5 = std::sqrt(5.0), s15 = std::sqrt(15.0);
  return {1.0,
          s3 * u[0],
          s3 * u[1],
          s3 * u[2],
          s15 * u[0] * u[1],
          s15 * u[1] * u[2],
          s15 * u[0] * u[2],
          0.5 * s5 * (3.0 * u[2] * u[2] - 1.0),
          0.5 * s15 * (u[0] * u[0] - u[1] * u[1])};
}

void add_harmonics(Gram& gram, const Vec3& gravity, double g_mps2) noexcept {
  const std::array<double, kHarmonics> y = harmonics_of(scaled(gravity, 1.0 / g_mps2));
  for (int i = 0; i < kHarmonics; ++i) {
    for (int j = 0; j < kHarmonics; ++j) gram[at(i * kHarmonics + j)] += y[at(i)] * y[at(j)];
  }
}

double least_eigenvalue(Gram gram, int stations) noexcept {
  for (double& entry : gram) entry /= static_cast<double>(stations);
  std::array<double, kHarmonics> values{};
  Gram vectors;
  if (!symmetric_eigen(gram.data(), kHarmonics, kHarmonics, values.data(), vectors.data())) return 0.0;
  return std::fmax(values[0], 0.0);
}

/// Squared length of the part of the readings that no vector explains; every row weighs the same, as in
/// an orthonormal parity basis.
double squared_parity(const StationRows& rows, const Parameters& theta) noexcept {
  Symmetric3 h{};
  Vec3 c{};
  for (int k = 0; k < rows.rows; ++k) {
    const int i = rows.sensor[at(k)];
    const Vec3 w = row_of(theta, i);
    add_outer(h, w, 1.0);
    c = plus(c, scaled(w, rows.reading[at(k)] - theta[at(4 * i + 3)]));
  }
  const Vec3 x = solve(h, c);
  double sum = 0.0;
  for (int k = 0; k < rows.rows; ++k) {
    const int i = rows.sensor[at(k)];
    const double e = rows.reading[at(k)] - dot(row_of(theta, i), x) - theta[at(4 * i + 3)];
    sum += e * e;
  }
  return sum;
}

/// The sums behind the figures of the report.
struct Tally {
  std::array<double, kCapacity> squared_residual{};
  std::array<int, kCapacity> seen{};
  double squared_norm = 0.0;
  double squared_parity = 0.0;
  double chi2 = 0.0;
  double direction_variance = 0.0;
  int stations = 0;
  int rows = 0;
  Gram gram{};
};

void add_station(const Problem& problem, const Parameters& theta, const StationRows& rows, const StationFit& station,
                 Tally& tally) noexcept {
  for (int k = 0; k < rows.rows; ++k) {
    const std::size_t i = at(rows.sensor[at(k)]);
    tally.squared_residual[i] += station.residual[at(k)] * station.residual[at(k)];
    ++tally.seen[i];
  }
  const double excess = norm(station.estimate) - problem.g_mps2;
  tally.squared_norm += excess * excess;
  if (rows.rows > 3) tally.squared_parity += squared_parity(rows, theta);
  tally.direction_variance += station.direction_variance;
  add_harmonics(tally.gram, station.gravity, problem.g_mps2);
  ++tally.stations;
  tally.rows += rows.rows;
}

double root_mean(double sum, int count) noexcept {
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

void write(const Tally& tally, int n, FitReport& report) noexcept {
  report.stations = tally.stations;
  for (int i = 0; i < n; ++i) {
    report.residual_rms_mps2[at(i)] = root_mean(tally.squared_residual[at(i)], tally.seen[at(i)]);
  }
  report.norm_rms_mps2 = root_mean(tally.squared_norm, tally.stations);
  report.parity_rms_mps2 = root_mean(tally.squared_parity, tally.rows - 3 * tally.stations);
  report.chi2 = tally.chi2;
  report.excitation = tally.stations > 0 ? least_eigenvalue(tally.gram, tally.stations) : 0.0;
}

}  // namespace

ResidualSummary describe_residuals(const Problem& problem, const Parameters& theta, FitReport& report) noexcept {
  ResidualSummary summary;
  Tally tally;
  StationRows rows;
  StationFit station;
  const double misfit_variance = report.misfit_mps2 * report.misfit_mps2;
  for (int s = 0; s < problem.count; ++s) {
    const Loaded loaded = load_rows(problem.datasheet, problem.stations[s], misfit_variance, rows);
    if (loaded == Loaded::skipped) continue;
    if (loaded == Loaded::not_finite) return summary;
    fit_station(rows, theta, problem.g_mps2, station);
    if (!station.finite) return summary;
    add_station(problem, theta, rows, station, tally);
    if (misfit_variance > 0.0) {
      // Chi^2 is told against the datasheet's noise alone, with the direction that this noise would choose.
      if (load_rows(problem.datasheet, problem.stations[s], 0.0, rows) != Loaded::used) return summary;
      fit_station(rows, theta, problem.g_mps2, station);
      if (!station.finite) return summary;
    }
    tally.chi2 += station.chi2;
  }
  write(tally, problem.datasheet.size, report);
  summary.finite = true;
  summary.rows = tally.rows;
  summary.direction_variance =
      tally.stations > 0 ? tally.direction_variance / static_cast<double>(tally.stations) : 0.0;
  return summary;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
