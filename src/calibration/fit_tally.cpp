#include "fit_tally.hpp"

#include <cmath>

#include "plumb/calibration/observability.hpp"
#include "plumb/numeric/symmetric_eigenvalues.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

/// A ratio of variances with fewer degrees of freedom below the line is chance.
constexpr double kRestFreedom = 10.0;

/// Of chi^2, what goes where row k is omitted: (M e)_k^2 / M_kk, M the projector.
double explained_by(const StationSolver& s, int k) noexcept {
  const double own = s.projector(k, k);
  const double projected = s.projected(k);
  return own > kOwnResidual * s.weight[at(k)] ? projected * projected / own : 0.0;
}

/// Spherical harmonics of degree 0 to 2, normalised so that their Gram matrix over the sphere is 1.
std::array<double, kHarmonics> harmonics_of(const Vec3& u) noexcept {
  constexpr double s3 = 1.7320508075688772, s5 = 2.2360679774997897, s15 = 3.8729833462074169;
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

using Gram = std::array<double, std::size_t{kHarmonics} * kHarmonics>;  // lower triangle

void add_to(Gram& gram, const Vec3& direction) noexcept {
  const std::array<double, kHarmonics> y = harmonics_of(direction);
  for (int i = 0; i < kHarmonics; ++i) {
    for (int j = 0; j <= i; ++j) gram[at(i * kHarmonics + j)] += y[at(i)] * y[at(j)];
  }
}

/// Of the mean over the stations.
double least_eigenvalue(const Gram& sums, int stations) noexcept {
  if (stations == 0) return 0.0;
  constexpr int kStride = 12;
  std::array<double, std::size_t{kHarmonics} * kStride> gram{};
  for (int i = 0; i < kHarmonics; ++i) {
    for (int j = 0; j <= i; ++j) {
      gram[at(i * kStride + j)] = sums[at(i * kHarmonics + j)] / stations;
      gram[at(j * kStride + i)] = gram[at(i * kStride + j)];
    }
  }
  std::array<double, kHarmonics> values{};
  const bool found = symmetric_eigenvalues(gram.data(), kHarmonics, kStride, values.data());
  return found ? std::fmax(values[0], 0.0) : 0.0;
}

/// Squared length of the part of the readings that no vector explains; every row weighs the same, as in an orthonormal
/// parity basis.
double squared_parity(const StationSolver& s) noexcept {
  bool alike = true;
  double sum = 0.0;
  for (int k = 0; k < s.rows; ++k) {
    alike = alike && s.weight[at(k)] == s.weight[0];
    sum += s.parity[at(k)] * s.parity[at(k)];
  }
  if (alike) return sum;
  Symmetric3 h{};
  Vec3 c{};
  for (int k = 0; k < s.rows; ++k) {
    add_outer(h, s.row[at(k)], 1.0);
    c = plus(c, scaled(s.row[at(k)], s.reading[at(k)]));
  }
  const Vec3 x = solve(h, c);
  sum = 0.0;
  for (int k = 0; k < s.rows; ++k) {
    const double e = s.reading[at(k)] - dot(s.row[at(k)], x);
    sum += e * e;
  }
  return sum;
}

double root_mean(double sum, int count) noexcept {
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

}  // namespace

int blamed(const StationSolver& station, double& share) noexcept {
  share = 0.0;
  if (station.rows <= 3) return -1;
  int most = 0;
  for (int k = 1; k < station.rows; ++k) {
    if (explained_by(station, k) > explained_by(station, most)) most = k;
  }
  share = explained_by(station, most) / station.chi2;
  return station.sensor[at(most)];
}

void Harmonics::add(const Vec3& direction) noexcept { add_to(gram_, direction); }

void FitTally::add(const StationSolver& s, double g_mps2) noexcept {
  for (int k = 0; k < s.rows; ++k) {
    const std::size_t i = at(s.sensor[at(k)]);
    const double e = s.residual(k);
    squared_residual_[i] += e * e;
    ++seen_[i];
    if (s.rows > 3) {
      explained_[i] += explained_by(s, k);
      alone_[i] += 1.0;
    }
  }
  const double excess = norm(s.estimate) - g_mps2;
  squared_norm_ += excess * excess;
  if (s.rows > 3) {
    squared_parity_ += squared_parity(s);
    chi2_ += s.chi2;
  }
  direction_variance_ += s.direction_variance();
  if (harmonics_ != nullptr) harmonics_->add(s.direction);
  ++stations_;
  rows_ += s.rows;
}

void FitTally::write(int n, FitFigures& report) const noexcept {
  report.stations = stations_;
  for (int i = 0; i < n; ++i) {
    report.residual_rms_mps2[at(i)] = root_mean(squared_residual_[at(i)], seen_[at(i)]);
    report.residual_share[at(i)] = chi2_ > 0.0 ? explained_[at(i)] / chi2_ : 0.0;
  }
  report.norm_rms_mps2 = root_mean(squared_norm_, stations_);
  report.parity_rms_mps2 = root_mean(squared_parity_, rows_ - 3 * stations_);
}

double Harmonics::excitation(int stations) const noexcept { return least_eigenvalue(gram_, stations); }

/// Mean square of what is the sensor's own, against the mean square of the rest in the degrees of freedom that the fit
/// has left.
int FitTally::highest_variance(int n, int freedom, double& excess) const noexcept {
  excess = 0.0;
  int most = -1;
  for (int i = 0; i < n; ++i) {
    const double rest_freedom = freedom - alone_[at(i)], rest = chi2_ - explained_[at(i)];
    if (!(alone_[at(i)] > 0.0) || !(rest_freedom >= kRestFreedom) || !(rest > 0.0)) continue;
    const double ratio = std::sqrt(explained_[at(i)] / alone_[at(i)] / (rest / rest_freedom));
    if (ratio > excess) {
      excess = ratio;
      most = i;
    }
  }
  return most;
}

bool FitTally::beyond_chance(int sensor, int freedom, double excess) const noexcept {
  constexpr double kChance = 3.0;  // one sided 1e-3, before the choice of the sensor
  const double own = alone_[at(sensor)], rest = freedom - own;
  const double z = std::log(excess) - 0.5 * (1.0 / rest - 1.0 / own);
  return z > kChance * std::sqrt(0.5 * (1.0 / own + 1.0 / rest));
}

/// What is omitted with a sensor is its error against what the others say of it, theirs included. With the mean of
/// M_ii, (n - 2) / n, that is v_i + v_o (1 / M - 1) in units of 1 / M, v_o the variance of the others.
double FitTally::variance_factor(int sensor, int n, int freedom) const noexcept {
  const double own = alone_[at(sensor)], rest = freedom - own;
  const double blowup = static_cast<double>(n) / (n - 2);
  const double others = (chi2_ - explained_[at(sensor)]) / rest;
  return explained_[at(sensor)] / own * blowup - others * (blowup - 1.0);
}

}  // namespace fit

double excitation_of(const Vec3* direction, int count) noexcept {
  fit::Gram gram{};
  for (int k = 0; k < count; ++k) fit::add_to(gram, direction[k]);
  return fit::least_eigenvalue(gram, count);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
