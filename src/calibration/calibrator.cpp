/// The iteration: damped Gauss-Newton on the sphere-projected residuals, in prior units.
#include <cmath>

#include "fit_internal.hpp"
#include "plumb/numeric/cholesky.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

using fit::at;

constexpr int kMaxMisfitRounds = 4;
/// Chi^2 this near to its degrees of freedom is left alone: its own scatter is far larger.
constexpr double kMisfitTolerance = 0.01;
/// A rise of the cost within its own rounding is not a rise.
constexpr double kCostTolerance = 1e-9;
/// Rises in a row that are let pass. Where stations are few the optimum lies in a narrow curved valley: a
/// step along it first rises, the next falls back into the valley further on. Damping would crawl.
constexpr int kPatience = 4;
/// A frozen parameter that is zero has neither size nor prior to measure its rounding by.
constexpr double kFrozenFloor = 1e-9;
constexpr double kFirstDamping = 1e-3;
constexpr double kMaxDamping = 1e9;

bool acceptable(const Datasheet& datasheet, const GravityReference& gravity) noexcept {
  if (datasheet.size < 3 || datasheet.size > kCapacity) return false;
  if (!std::isfinite(gravity.g_mps2) || !(gravity.g_mps2 > 0.0)) return false;
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    if (!(s.row.sigma_mps2 > 0.0) || !std::isfinite(s.row.sigma_mps2)) return false;
    // Zero is allowed: it freezes the parameter.
    if (!(s.prior.bias_mps2 >= 0.0) || !(s.prior.scale >= 0.0) || !(s.prior.axis_rad >= 0.0)) return false;
    if (!std::isfinite(s.prior.bias_mps2 + s.prior.scale + s.prior.axis_rad)) return false;
  }
  return true;
}

double squared_length(const fit::Parameters& v, int n) noexcept {
  double sum = 0.0;
  for (int k = 0; k < n; ++k) sum += v[at(k)] * v[at(k)];
  return sum;
}

}  // namespace

const char* to_string(StopReason reason) noexcept {
  switch (reason) {
    case StopReason::none: return "none";
    case StopReason::converged: return "converged";
    case StopReason::iteration_limit: return "iteration_limit";
    case StopReason::no_descent: return "no_descent";
    case StopReason::not_finite: return "not_finite";
  }
  return "unknown";
}

Calibrator::Calibrator(const Datasheet& datasheet, const GravityReference& gravity, const FitOptions& options) noexcept
    : datasheet_(datasheet), gravity_(gravity), options_(options) {
  if (!acceptable(datasheet_, gravity_)) stop_ = StopReason::not_finite;
}

fit::Parameters Calibrator::parameters() const noexcept {
  return fit::natural(datasheet_, fit::prior_roots(datasheet_), theta_);
}

/// Eq (12), with the prior sigma as floor: a bias near zero has no relative accuracy. A common rotation does
/// not count: no station sees it, the prior draws it in slowly where it pulls hard, and `finish` settles it.
bool Calibrator::settled(const fit::Parameters& natural) const noexcept {
  const fit::PriorRoots roots = fit::prior_roots(datasheet_);
  fit::Parameters moved = fit::times_roots(roots, datasheet_.size, step_);
  fit::remove_rotation(natural, datasheet_.size, moved);
  for (int i = 0; i < datasheet_.size; ++i) {
    const fit::PriorRoot& root = roots[at(i)];
    const Vec3 x = {root.axes[0], root.axes[1], root.axes[2]};
    const Vec3 y = {root.axes[1], root.axes[3], root.axes[4]};
    const Vec3 z = {root.axes[2], root.axes[4], root.axes[5]};
    const std::array<double, 4> sigma = {norm(x), norm(y), norm(z), root.bias};
    for (int p = 0; p < 4; ++p) {
      const std::size_t k = at(4 * i + p);
      const double floor = std::fmax(std::fmax(std::fabs(natural[k]), sigma[at(p)]), kFrozenFloor);
      if (!(std::fabs(moved[k]) <= options_.stop_relative * floor)) return false;
    }
  }
  return true;
}

/// Moment estimate of the noise that the datasheet does not know, from the residuals at convergence.
/// True where the weights have changed so much that the fit must go on. Leaves `normal_` destroyed.
bool Calibrator::misfit_changed(double chi2, double weighted_chi2, int rows, int stations) noexcept {
  const int n4 = 4 * datasheet_.size;
  if (!options_.estimate_misfit || misfit_rounds_ >= kMaxMisfitRounds) return false;
  // Even if the data had determined every observable parameter, no excess: spare the inverse.
  if (misfit_mps2_ == 0.0 && chi2 <= rows - 2 * stations - (n4 - 3)) return false;
  cholesky_inverse(normal_.data(), n4, n4);
  double from_prior = 0.0;
  for (int k = 0; k < n4; ++k) from_prior += normal_[at(k * n4 + k)];
  const double freedom = rows - 2 * stations - (n4 - from_prior);
  if (!(freedom >= 1.0) || !(weighted_chi2 > 0.0)) return false;
  const double excess = chi2 / freedom - 1.0;
  if (std::fabs(excess) <= kMisfitTolerance || (misfit_mps2_ == 0.0 && excess <= 0.0)) return false;
  // Newton on 1 / chi^2(variance), which is a straight line where all weights are equal.
  const double variance = misfit_mps2_ * misfit_mps2_ + excess * chi2 / weighted_chi2;
  misfit_mps2_ = variance > 0.0 ? std::sqrt(variance) : 0.0;
  ++misfit_rounds_;
  fresh_ = true;
  return true;
}

void Calibrator::iterate(const Station* stations, int count) noexcept {
  if (done()) return;
  const int n = datasheet_.size;
  const int n4 = 4 * n;
  const fit::Problem problem = {datasheet_, gravity_.g_mps2, stations, stations == nullptr ? 0 : count};
  const fit::PriorRoots roots = fit::prior_roots(datasheet_);
  const double variance = misfit_mps2_ * misfit_mps2_;
  fit::Parameters rhs;
  fit::Parameters natural = fit::natural(datasheet_, roots, theta_);
  fit::Sums sums = fit::accumulate(problem, natural, variance, scratch_.data(), rhs);
  double cost = sums.chi2 + squared_length(theta_, n4);
  const bool finite = sums.finite && std::isfinite(cost);
  if (fresh_ ? !finite : !(finite && cost <= cost_ + kCostTolerance * (1.0 + cost_))) {
    ++rises_;
  } else {
    rises_ = 0;
    cost_ = cost;
    best_ = theta_;
    damping_ = damping_ > kFirstDamping ? 0.1 * damping_ : 0.0;
  }
  if (fresh_ && !finite) {
    stop_ = StopReason::not_finite;
  } else if (!finite || rises_ > kPatience) {
    theta_ = best_;
    rises_ = 0;
    damping_ = damping_ > 0.0 ? 10.0 * damping_ : kFirstDamping;
    natural = fit::natural(datasheet_, roots, theta_);
    sums = fit::accumulate(problem, natural, variance, scratch_.data(), rhs);
    if (damping_ > kMaxDamping) stop_ = StopReason::no_descent;
  }
  fresh_ = false;
  ++iterations_;
  if (done()) return;
  fit::expand(scratch_.data(), roots, n, normal_.data());
  for (int k = 0; k < n4; ++k) normal_[at(k * n4 + k)] = (normal_[at(k * n4 + k)] + 1.0) * (1.0 + damping_);
  step_ = fit::times_roots(roots, n, rhs);
  for (int k = 0; k < n4; ++k) step_[at(k)] -= theta_[at(k)];
  if (!cholesky_factor(normal_.data(), n4, n4)) {
    stop_ = StopReason::not_finite;
    return;
  }
  cholesky_solve(normal_.data(), n4, n4, step_.data());
  for (int k = 0; k < n4; ++k) theta_[at(k)] += step_[at(k)];
  if (damping_ < 1.0 && settled(natural) && !misfit_changed(sums.chi2, sums.weighted_chi2, sums.rows, sums.stations)) {
    stop_ = StopReason::converged;
  } else if (iterations_ >= options_.max_iterations) {
    stop_ = StopReason::iteration_limit;
  }
}

Expected<Calibration> calibrate(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                                int count, const FitOptions& options, FitReport* report) noexcept {
  Calibrator calibrator(datasheet, gravity, options);
  // `iterate` stops by itself at max_iterations; the bound here holds for a nonsensical one too.
  constexpr int kBound = 10000;
  for (int k = 0; k < kBound && !calibrator.done(); ++k) calibrator.iterate(stations, count);
  return calibrator.finish(stations, count, report);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
