/// The iteration: damped Gauss-Newton on the sphere-projected residuals, in prior units.
#include <cmath>

#include "fit_limits.hpp"
#include "plumb/numeric/cholesky.hpp"
#include "station_solver.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

using namespace fit::limits;

/// A frozen parameter that is zero has neither size nor prior to measure its rounding by.
constexpr double kFrozenFloor = 1e-9;

bool usual_prior(double sigma) noexcept { return sigma == 0.0 || fit::usual(sigma); }

}  // namespace

bool fit::acceptable(const Datasheet& datasheet, double g_mps2) noexcept {
  if (datasheet.size < 3 || datasheet.size > kCapacity) return false;
  if (!usual(g_mps2)) return false;
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    if (!usual(s.row.sigma_mps2)) return false;
    if (!usual_prior(s.prior.bias_mps2) || !usual_prior(s.prior.scale) || !usual_prior(s.prior.axis_rad)) return false;
  }
  return true;
}

bool fit::all_free(const Datasheet& datasheet) noexcept {
  for (int i = 0; i < datasheet.size; ++i) {
    const Prior& prior = datasheet.sensor[at(i)].prior;
    if (!(prior.bias_mps2 > 0.0 && prior.scale > 0.0 && prior.axis_rad > 0.0)) return false;
  }
  return true;
}

namespace {

double squared_norm(const fit::Parameters& v, int n) noexcept {
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

const char* to_string(FitStart start) noexcept {
  switch (start) {
    case FitStart::automatic: return "automatic";
    case FitStart::datasheet: return "datasheet";
    case FitStart::closed_form: return "closed form";
  }
  return "unknown";
}

bool fit::unit_axis(const Vec3& axis) noexcept { return std::fabs(norm(axis) - 1.0) <= kAxisLengthTolerance; }

fit::Problem fit::problem_of(const Datasheet& datasheet, double g_mps2, const FitOptions& options,
                             const StationList& stations) noexcept {
  Problem problem = {datasheet, g_mps2, stations, stations.size(), {}, nullptr};
  problem.roll.axis = options.roll_axis;
  problem.roll.wobble_rad = options.roll_axis_deviation_rad;
  find_roll_groups(problem, problem.roll);
  problem.roll.used = problem.roll.used && unit_axis(options.roll_axis);
  return problem;
}

Calibrator::Calibrator(const Datasheet& datasheet, const GravityReference& gravity, const FitOptions& options) noexcept
    : datasheet_(datasheet), gravity_(gravity), options_(options) {
  if (!fit::acceptable(datasheet_, gravity_.g_mps2)) stop_ = StopReason::not_finite;
}

void Calibrator::resume(const Datasheet& datasheet, const FitOptions& options) noexcept {
  datasheet_ = datasheet;
  options_ = options;
  if (!fit::acceptable(datasheet_, gravity_.g_mps2)) stop_ = StopReason::not_finite;
}

/// Not inlined: the roots need no room while the sums are made.
[[gnu::noinline]] fit::Parameters Calibrator::parameters() const noexcept {
  return fit::natural(datasheet_, fit::prior_roots(datasheet_), theta_);
}

/// Eq (12), with the prior sigma as floor: a bias near zero has no relative accuracy. A common rotation does
/// not count: no station sees it, the prior draws it in slowly where it pulls hard, and `finish` settles it.
bool Calibrator::settled(const fit::Problem& problem, const fit::Parameters& natural, double relative) const noexcept {
  const fit::PriorRoots roots = fit::prior_roots(datasheet_);
  fit::Parameters moved = fit::times_roots(roots, datasheet_.size, step_);
  fit::remove_rotation(natural, datasheet_.size, problem.roll, moved);
  return fit::small_step(roots, datasheet_.size, natural, moved, relative);
}

bool fit::small_step(const PriorRoots& roots, int n, const Parameters& natural, const Parameters& moved,
                     double relative) noexcept {
  for (int i = 0; i < n; ++i) {
    const PriorRoot& root = roots[at(i)];
    const Vec3 x = {root.axes[0], root.axes[1], root.axes[2]};
    const Vec3 y = {root.axes[1], root.axes[3], root.axes[4]};
    const Vec3 z = {root.axes[2], root.axes[4], root.axes[5]};
    const std::array<double, 4> sigma = {norm(x), norm(y), norm(z), root.bias};
    for (int p = 0; p < 4; ++p) {
      const std::size_t k = at(4 * i + p);
      const double floor = std::fmax(std::fmax(std::fabs(natural[k]), sigma[at(p)]), kFrozenFloor);
      if (!(std::fabs(moved[k]) <= relative * floor)) return false;
    }
  }
  return true;
}

/// Moment estimate of the noise that the datasheet does not know, from the residuals at convergence.
/// True where the weights have changed so much that the fit must go on. Leaves `factor` destroyed.
bool Calibrator::misfit_changed(const fit::Sums& sums, double* factor) noexcept {
  const int n4 = 4 * datasheet_.size;
  if (!options_.estimate_misfit || misfit_rounds_ >= kMaxMisfitRounds) return false;
  // Even if the data had determined every observable parameter, no excess: spare the inverse.
  if (misfit_mps2_ == 0.0 && sums.chi2 <= sums.rows - 2 * sums.stations - (n4 - 3)) return false;
  cholesky_inverse(factor, n4, n4);
  double from_prior = 0.0;
  for (int k = 0; k < n4; ++k) from_prior += factor[k * n4 + k];
  const double freedom = sums.rows - 2 * sums.stations - (n4 - from_prior);
  if (!(freedom >= 1.0) || !(sums.weighted_chi2 > 0.0)) return false;
  const double excess = sums.chi2 / freedom - 1.0;
  if (std::fabs(excess) <= kMisfitTolerance || (misfit_mps2_ == 0.0 && excess <= 0.0)) return false;
  // Newton on 1 / chi^2(variance), which is a straight line where all weights are equal.
  const double variance = misfit_mps2_ * misfit_mps2_ + excess * sums.chi2 / sums.weighted_chi2;
  misfit_mps2_ = variance > 0.0 ? std::sqrt(variance) : 0.0;
  ++misfit_rounds_;
  fresh_ = true;
  return true;
}

/// Takes a cost for the best so far, or counts the rises; false where it is time to go back and damp.
bool Calibrator::goes_down(double cost, bool finite) noexcept {
  if (fresh_ ? !finite : !(finite && cost <= cost_ + kCostTolerance * (1.0 + cost_))) {
    ++rises_;
    return finite && rises_ <= kMostRises;
  }
  rises_ = 0;
  cost_ = cost;
  best_ = theta_;
  damping_ = damping_ > kFirstDamping ? 0.1 * damping_ : 0.0;
  return true;
}

void Calibrator::find_start(const Station* stations, int count) noexcept {
  phase_ = Phase::squares;
  if (options_.start == FitStart::datasheet || !fit::all_free(datasheet_)) return;
  fit::Parameters natural;
  if (!fit::closed_form(fit::problem_of(datasheet_, gravity_.g_mps2, options_, {stations, count}), natural)) return;
  theta_ = fit::prior_units(datasheet_, natural);
  started_ = FitStart::closed_form;
}

/// Sets the weights of one step that looks for outliers. True where they have come to rest.
template <class Axes>
bool Calibrator::weigh(const fit::Problem& problem, const fit::Parameters& natural) noexcept {
  const double before = misfit_mps2_ * misfit_mps2_;
  const double share = phase_ == Phase::huber ? kFirstShare : 1.0;
  const double variance = fit::median_misfit<typename Axes::Count>(problem, natural, before, freedom_, share);
  misfit_mps2_ = std::sqrt(variance);
  ++robust_steps_;
  fresh_ = true;  // another cost: nothing to compare with
  return std::fabs(variance - before) <= kMisfitSettled * variance;
}

/// After a step: whether the phase is over, and what comes next. True where the whole fit is.
template <class Axes>
bool Calibrator::advance(const fit::Problem& problem, const fit::Parameters& natural, const fit::Sums& sums,
                         bool weights_settled, [[maybe_unused]] double* factor) noexcept {
  const bool loosely = settled(problem, natural, kLooselySettled);
  if (phase_ == Phase::huber || phase_ == Phase::tukey) {
    const int most = phase_ == Phase::huber ? kHuberSteps : kHuberSteps + kTukeySteps;
    if ((!loosely || !weights_settled) && robust_steps_ < most) return false;
    if (phase_ == Phase::huber) {
      phase_ = Phase::tukey;
      robust_steps_ = kHuberSteps;
      return false;
    }
    screen_ = parameters();
    screen_misfit_mps2_ = misfit_mps2_;
    misfit_mps2_ = 0.0;
    fresh_ = true;
    phase_ = Phase::screened;
    return false;
  }
  if (phase_ == Phase::squares && !looked_ && options_.reject_outliers && loosely && sums.worst > 1.0) {
    looked_ = true;
    freedom_ = sums.rows - 2 * sums.stations - (4 * datasheet_.size - 3);
    if (freedom_ >= kScreenFreedom && fit::stands_out<typename Axes::Count>(problem, natural, freedom_)) {
      phase_ = Phase::huber;
      return false;
    }
  }
  if (!settled(problem, natural, options_.stop_relative)) return false;
  if constexpr (Axes::kKeepsFactor) {
    return !misfit_changed(sums, factor);
  } else {
    return true;
  }
}

/// Solves the normal equations and moves. Takes the information of the data; leaves the factor of the damped one.
template <class Axes>
bool Calibrator::step_from(const fit::Problem& problem, const fit::Parameters& natural, const fit::Parameters& rhs,
                           const double* blocks, const fit::Room& room, const typename Axes::Matrix& normal) noexcept {
  const int n = datasheet_.size;
  const int n4 = 4 * n;
  const fit::PriorRoots roots = fit::prior_roots(datasheet_);
  fit::expand(blocks, room.roll, roots, n, normal);
  for (int k = 0; k < n4; ++k) normal(k, k) = (normal(k, k) + 1.0) * (1.0 + damping_);
  step_ = fit::times_roots(roots, n, rhs);
  for (int k = 0; k < n4; ++k) step_[at(k)] -= theta_[at(k)];
  if (!normal.factor()) return false;
  normal.solve(step_.data());
  if (Axes::kTurnsTogether && fit::all_free(datasheet_)) {
    // A common rotation costs the data nothing, but only as a rotation: taken along its tangent it would stretch. Where
    // the data do not see it, the prior alone has it.
    fit::Parameters change = fit::times_roots(roots, n, step_);
    const Vec3 turn = fit::remove_rotation(natural, n, problem.roll, change);
    fit::Parameters moved = natural;
    for (int k = 0; k < n4; ++k) moved[at(k)] += change[at(k)];
    if (problem.roll.used) {
      fit::turn_all(turn, n, moved);
    } else {
      fit::turn_to_prior(datasheet_, kPriorTurns, moved);
    }
    theta_ = fit::prior_units(datasheet_, moved);
  } else {
    for (int k = 0; k < n4; ++k) theta_[at(k)] += step_[at(k)];
  }
  return true;
}

/// The sums at theta; where they have risen for good, those at the best theta so far, with more damping.
[[gnu::noinline]] fit::Sums Calibrator::accumulate_best(const fit::Problem& problem, fit::Parameters& natural,
                                                        double* blocks, fit::Parameters& rhs,
                                                        const fit::Room& room) noexcept {
  const fit::Loss loss = phase_ == Phase::huber   ? fit::Loss::huber
                         : phase_ == Phase::tukey ? fit::Loss::tukey
                                                  : fit::Loss::squares;
  const double variance = misfit_mps2_ * misfit_mps2_;
  fit::Sums sums = fit::accumulate(problem, natural, variance, loss, blocks, rhs, room);
  const double cost = sums.chi2 + squared_norm(theta_, 4 * datasheet_.size);
  const bool finite = sums.finite && std::isfinite(cost);
  const bool down = goes_down(cost, finite);
  if (fresh_ && !finite) {
    stop_ = StopReason::not_finite;
    bad_station_ = sums.bad_station;
  } else if (!down) {
    theta_ = best_;
    rises_ = 0;
    damping_ = damping_ > 0.0 ? 10.0 * damping_ : kFirstDamping;
    natural = parameters();
    sums = fit::accumulate(problem, natural, variance, loss, blocks, rhs, room);
    if (damping_ > kMaxDamping) stop_ = StopReason::no_descent;
  }
  fresh_ = false;
  return sums;
}

/// A step whose factor is not used afterwards: half of the matrix will do.
[[gnu::noinline]] bool Calibrator::step_alone(const fit::Problem& problem, const fit::Parameters& natural,
                                              const fit::Parameters& rhs, const double* blocks) noexcept {
  std::array<double, std::size_t{kFitParameters} * (kFitParameters + 1) / 2> information{};
  return step_from<fit::HeldAxes>(problem, natural, rhs, blocks, fit::Room{},
                                  {information.data(), 4 * datasheet_.size});
}

/// The sums, and the step to which they lead; false where there is none. Nothing happens once the fit is over.
template <class Axes>
[[gnu::noinline]] bool Calibrator::solve(const fit::Problem& problem, fit::Parameters& natural, fit::Sums& sums,
                                         const fit::Room& room) noexcept {
  fit::Parameters rhs;
  fit::Blocks blocks;
  sums = accumulate_best(problem, natural, blocks.data(), rhs, room);
  ++iterations_;
  if (done()) return true;
  if constexpr (Axes::kKeepsFactor) {
    return step_from<Axes>(problem, natural, rhs, blocks.data(), room, {room.factor, 4 * datasheet_.size});
  } else {
    return step_alone(problem, natural, rhs, blocks.data());
  }
}

template <class Axes>
void Calibrator::iterate_over(const fit::Problem& problem, const fit::Room& room) noexcept {
  fit::Parameters natural = parameters();
  const bool looking = phase_ == Phase::huber || phase_ == Phase::tukey;
  const bool weights_settled = !looking || weigh<Axes>(problem, natural);
  fit::Sums sums;
  const bool moved = solve<Axes>(problem, natural, sums, room);
  if (done()) return;
  if (!moved) {
    stop_ = StopReason::not_finite;
  } else if (damping_ < 1.0 && advance<Axes>(problem, natural, sums, weights_settled, room.factor)) {
    stop_ = StopReason::converged;
  } else if (iterations_ >= options_.max_iterations) {
    stop_ = StopReason::iteration_limit;
  }
}

void Calibrator::iterate(const Station* stations, int count) noexcept {
  if (done()) return;
  if (phase_ == Phase::start) {
    find_start(stations, count);
    if (started_ == FitStart::closed_form) return;
  }
  fit::Problem problem = fit::problem_of(datasheet_, gravity_.g_mps2, options_, {stations, count});
  const fit::Screen screen = {screen_, screen_misfit_mps2_ * screen_misfit_mps2_};
  if (phase_ == Phase::screened) problem.screen = &screen;
  fit::RollSums roll;
  fit::Screening screening(problem);
  Information factor;
  iterate_over<fit::FreeAxes>(problem, {&roll, &screening, factor.data()});
}

void Calibrator::iterate_held(const StationList& stations) noexcept {
  if (done()) return;
  if (stations.size() > fit::kMostCounted) {
    stop_ = StopReason::not_finite;
    return;
  }
  if (phase_ == Phase::start) phase_ = Phase::squares;  // a held axis has no closed form
  StationList used = stations;
  screen_out(used);
  iterate_over<fit::HeldAxes>({datasheet_, gravity_.g_mps2, used, used.size(), {}, nullptr}, fit::Room{});
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
