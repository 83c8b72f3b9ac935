#include "temperature_descent.hpp"

#include <cmath>

#include "fit_limits.hpp"
#include "plumb/numeric/cholesky.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

using namespace limits;

constexpr int kMostIterations = 10000;

}  // namespace

Descent::Descent(const Joint& joint, double g_mps2, const FitOptions& options, const Station* stations, int count,
                 Station* scratch, TemperatureWork& work) noexcept
    : joint_(joint),
      g_mps2_(g_mps2),
      options_(options),
      stations_(stations),
      count_(count),
      scratch_(scratch),
      work_(work),
      state_(joint.nominal),
      best_(joint.nominal) {
  for (int k = 0; k < count; ++k) scratch[k].count = stations[k].count;
  reduce_all(joint_, state_, stations_, count_, scratch_);
}

Problem Descent::problem() const noexcept { return {joint_.sheet, g_mps2_, {scratch_, count_}, count_, {}, nullptr}; }

Loss Descent::loss() const noexcept {
  if (phase_ == Phase::huber) return Loss::huber;
  return phase_ == Phase::tukey ? Loss::tukey : Loss::squares;
}

void Descent::turn_to_datasheet() noexcept { fit::turn_to_datasheet(joint_.sheet, Roll{}, state_.theta); }

/// True where the weights of a step that looks for outliers have come to rest.
bool Descent::weigh() noexcept {
  const double before = misfit_;
  const double share = phase_ == Phase::huber ? kFirstShare : 1.0;
  misfit_ = median_misfit<int>(problem(), state_.theta, before, freedom_, share);
  ++robust_steps_;
  fresh_ = true;
  return std::fabs(misfit_ - before) <= kMisfitSettled * misfit_;
}

void Descent::sum() noexcept {
  accumulate(joint_, state_, problem(), misfit_, loss(), work_.information.data(), sums_);
}

bool Descent::goes_down(double cost) noexcept {
  const bool finite = sums_.sums.finite && std::isfinite(cost);
  if (fresh_ ? !finite : !(finite && cost <= cost_ + kCostTolerance * (1.0 + cost_))) {
    ++rises_;
    return finite && rises_ <= kMostRises;
  }
  rises_ = 0;
  cost_ = cost;
  best_ = state_;
  damping_ = damping_ > kFirstDamping ? 0.1 * damping_ : 0.0;
  return true;
}

bool Descent::step() noexcept {
  const int n = joint_.sensors(), size = joint_.parameters(), per = joint_.per_sensor();
  double* const normal = work_.information.data();
  for (int k = 0; k < size; ++k) normal[k * size + k] = (normal[k * size + k] + 1.0) * (1.0 + damping_);
  const JointVector x = joint_prior_units(joint_, state_);
  for (int k = 0; k < size; ++k) step_[at(k)] = sums_.rhs[at(k)] - x[at(k)];
  if (!cholesky_factor(normal, size, size)) return false;
  cholesky_solve(normal, size, size, step_.data());
  Parameters change{};
  for (int i = 0; i < n; ++i) {
    for (int p = 0; p < 4; ++p) change[at(4 * i + p)] = step_[at(per * i + p)];
  }
  moved_ = times_roots(joint_.roots, n, change);
  remove_rotation(state_.theta, n, Roll{}, moved_);
  for (int k = 0; k < 4 * n; ++k) state_.theta[at(k)] += moved_[at(k)];
  turn_to_prior(joint_.sheet, kPriorTurns, state_.theta);
  add_terms(joint_, step_, state_);
  return true;
}

bool Descent::settled(double relative) const noexcept {
  const int per = joint_.per_sensor();
  for (int k = 0; k < joint_.parameters(); ++k) {
    if (k % per >= 4 && !(std::fabs(step_[at(k)]) <= relative)) return false;
  }
  return small_step(joint_.roots, joint_.sensors(), state_.theta, moved_, relative);
}

/// Moment estimate of the noise that the datasheet does not know. True where the fit must go on. `information` holds
/// the factor of the normal equations, and is destroyed.
bool Descent::misfit_changed() noexcept {
  const Sums& s = sums_.sums;
  const int size = joint_.parameters();
  if (!options_.estimate_misfit || misfit_rounds_ >= kMaxMisfitRounds) return false;
  if (misfit_ == 0.0 && s.chi2 <= s.rows - 2 * s.stations - (size - 3)) return false;
  cholesky_inverse(work_.information.data(), size, size);
  double from_prior = 0.0;
  for (int k = 0; k < size; ++k) from_prior += work_.information[at(k * size + k)];
  const double freedom = s.rows - 2 * s.stations - (size - from_prior);
  if (!(freedom >= 1.0) || !(s.weighted_chi2 > 0.0)) return false;
  const double excess = s.chi2 / freedom - 1.0;
  if (std::fabs(excess) <= kMisfitTolerance || (misfit_ == 0.0 && excess <= 0.0)) return false;
  misfit_ = std::fmax(misfit_ + excess * s.chi2 / s.weighted_chi2, 0.0);
  ++misfit_rounds_;
  fresh_ = true;
  return true;
}

void Descent::set_outliers_aside() noexcept {
  const Problem all = problem();
  StationSolver solver(all, state_.theta, misfit_);
  for (int k = 0; k < count_; ++k) {
    if (solver.solve(scratch_[k]) != Loaded::used || !(solver.chi2 > solver.limit_squared)) continue;
    if (outliers_ < kMaxOutliers) {
      Outlier& outlier = outlier_[outliers_];
      outlier.station = k;
      outlier.standardised = std::sqrt(solver.chi2);
      outlier.sensor = blamed(solver, outlier.share);
    }
    ++outliers_;
    scratch_[k].count = 0;
  }
}

void Descent::note_outliers(FitReport& report) const noexcept {
  report.outliers = outliers_;
  for (int k = 0; k < outliers_ && k < kMaxOutliers; ++k) report.outlier[at(k)] = outlier_[k];
}

/// After a step: whether the phase is over, and what comes next. True where the whole fit is.
bool Descent::advance(bool weights_settled) noexcept {
  const bool loosely = settled(kLooselySettled);
  if (phase_ == Phase::huber || phase_ == Phase::tukey) {
    const int most = phase_ == Phase::huber ? kHuberSteps : kHuberSteps + kTukeySteps;
    if ((!loosely || !weights_settled) && robust_steps_ < most) return false;
    if (phase_ == Phase::huber) {
      phase_ = Phase::tukey;
      robust_steps_ = kHuberSteps;
      return false;
    }
    set_outliers_aside();
    misfit_ = 0.0;
    fresh_ = true;
    phase_ = Phase::screened;
    return false;
  }
  if (phase_ == Phase::squares && !looked_ && options_.reject_outliers && loosely && sums_.sums.worst > 1.0) {
    looked_ = true;
    freedom_ = sums_.sums.rows - 2 * sums_.sums.stations - (joint_.parameters() - 3);
    if (freedom_ >= kScreenFreedom && stands_out<int>(problem(), state_.theta, freedom_)) {
      phase_ = Phase::huber;
      return false;
    }
  }
  return settled(options_.stop_relative) && !misfit_changed();
}

void Descent::iterate() noexcept {
  const bool looking = phase_ == Phase::huber || phase_ == Phase::tukey;
  const bool weights_settled = !looking || weigh();
  sum();
  const JointVector x = joint_prior_units(joint_, state_);
  double cost = sums_.sums.chi2;
  for (int k = 0; k < joint_.parameters(); ++k) cost += x[at(k)] * x[at(k)];
  if (!goes_down(cost)) {
    if (fresh_) {  // a sum that has nothing to be compared with is refused where it is no number
      stop_ = StopReason::not_finite;
      bad_station_ = sums_.sums.bad_station;
      return;
    }
    state_ = best_;
    rises_ = 0;
    damping_ = damping_ > 0.0 ? 10.0 * damping_ : kFirstDamping;
    if (damping_ > kMaxDamping) {
      stop_ = StopReason::no_descent;
      return;
    }
    reduce_all(joint_, state_, stations_, count_, scratch_);
    sum();
  }
  fresh_ = false;
  ++iterations_;
  if (!step()) {
    stop_ = StopReason::not_finite;
    return;
  }
  reduce_all(joint_, state_, stations_, count_, scratch_);
  if (damping_ < 1.0 && advance(weights_settled)) {
    stop_ = StopReason::converged;
  } else if (iterations_ >= options_.max_iterations) {
    stop_ = StopReason::iteration_limit;
  }
}

void Descent::run() noexcept {
  for (int k = 0; k < kMostIterations && stop_ == StopReason::none; ++k) iterate();
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
