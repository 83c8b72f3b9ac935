#include "plumb/calibration/temperature_fit.hpp"

#include <cmath>

#include "plumb/numeric/cholesky.hpp"
#include "plumb/numeric/tails.hpp"
#include "temperature_descent.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// Temperatures at which the shape of a scale factor is looked at.
constexpr int kShapePoints = 14;
/// A tool whose temperature follows from its inclination this well has no second variable.
constexpr double kFollows_degc = 0.5 * kLevelsApart_degc;
constexpr double kFollowsShare = 0.1;
constexpr int kFollowTerms = 4;
constexpr int kFollowStations = 16;

bool free_terms(const Datasheet& datasheet, int order) noexcept {
  if (!fit::all_free(datasheet)) return false;
  for (int i = 0; i < datasheet.size; ++i) {
    const Prior& prior = datasheet.sensor[at(i)].prior;
    for (int j = 0; j < order; ++j) {
      if (!(prior.scale_t[at(j)] > 0.0) || !std::isfinite(prior.scale_t[at(j)])) return false;
      if (!(prior.bias_t_mps2[at(j)] > 0.0) || !std::isfinite(prior.bias_t_mps2[at(j)])) return false;
    }
  }
  return true;
}

/// Whether a cubic in the inclination (its cosine) says the temperature within a few degC and to a tenth of its
/// variance.
bool follows_inclination(const fit::Problem& problem, const fit::Parameters& theta, const Vec3& axis,
                         const ChebyshevSpan& use) noexcept {
  std::array<double, at(kFollowTerms * kFollowTerms)> normal{};
  Cubic rhs{};
  double square = 0.0, sum = 0.0;
  int stations = 0;
  fit::StationSolver solver(problem, theta, 0.0);
  for (int k = 0; k < problem.count; ++k) {
    if (solver.solve(problem.stations[k]) != fit::Loaded::used) continue;
    const Cubic t = chebyshev_values(dot(solver.direction, axis));
    const double y = problem.stations[k].temperature_degc - use.middle();
    for (int p = 0; p < kFollowTerms; ++p) {
      for (int q = 0; q <= p; ++q) normal[at(p * kFollowTerms + q)] += t[at(p)] * t[at(q)];
      rhs[at(p)] += t[at(p)] * y;
    }
    square += y * y;
    sum += y;
    ++stations;
  }
  if (stations < kFollowStations) return false;
  for (int p = 0; p < kFollowTerms; ++p) normal[at(p * kFollowTerms + p)] += 1e-9 * stations;
  Cubic solution = rhs;
  const double spread = square - sum * sum / stations;
  if (!cholesky_factor(normal.data(), kFollowTerms, kFollowTerms)) return false;
  cholesky_solve(normal.data(), kFollowTerms, kFollowTerms, solution.data());
  for (std::size_t p = 0; p < solution.size(); ++p) square -= solution[p] * rhs[p];
  return square <= kFollows_degc * kFollows_degc * stations && square <= kFollowsShare * spread;
}

/// One fit of one order.
class Attempt {
 public:
  Attempt(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations, int count,
          const FitOptions& options, Station* scratch, TemperatureWork& work, TemperatureReport& told,
          FitReport& report) noexcept
      : datasheet_(datasheet),
        gravity_(gravity),
        stations_(stations),
        count_(count),
        options_(options),
        scratch_(scratch),
        work_(work),
        told_(told),
        report_(report),
        whole_(datasheet, told.use_degc, kMaxTemperatureOrder) {}

  Expected<Calibration> run(int order) noexcept {
    const fit::Joint joint(datasheet_, told_.use_degc, order);
    fit::Descent descent(joint, gravity_.g_mps2, options_, stations_, count_, scratch_, work_);
    descent.run();
    report_.start = FitStart::datasheet;
    report_.iterations = told_.iterations = descent.iterations();
    report_.stop = descent.stop();
    report_.parameters = told_.parameters = joint.parameters();
    report_.misfit_mps2 = std::sqrt(descent.misfit_variance());
    told_.order = order;
    const Error diverged = {Errc::diverged, descent.bad_station(), descent.cost(), 0.0};
    if (descent.stop() == StopReason::not_finite) return tl::unexpected<Error>(diverged);
    descent.turn_to_datasheet();
    fit::Harmonics harmonics;
    fit::Fitted fitted(&harmonics);
    fitted.theta = descent.state().theta;
    if (!describe(joint, descent, fitted)) return tl::unexpected<Error>(diverged);
    if (told_.levels.count <= order) {
      told_.missing = missing_levels(told_.levels, told_.use_degc, order + 1, told_.missing_degc);
      return fail(Errc::too_few_levels, -1, told_.levels.count, order + 1);
    }
    Expected<Calibration> out = compose(joint, descent.state(), fitted);
    if (out) {
      fit::Problem problem = descent.problem();
      problem.roll.axis = scaled(options_.roll_axis, 1.0 / norm(options_.roll_axis));
      report_.inclination_sigma_rad = fit::inclination_sigma(problem, fitted.theta, out->array);
      out->report.inclination_sigma_rad = report_.inclination_sigma_rad;
    }
    if (descent.stop() != StopReason::converged) return tl::unexpected<Error>(diverged);
    const Error wrong = judge(joint, descent, fitted);
    if (wrong.code != Errc::ok) return tl::unexpected<Error>(wrong);
    if (out) out->report.noise_mps2 = report_.noise_mps2;
    return out;
  }

 private:
  bool describe(const fit::Joint& joint, const fit::Descent& descent, fit::Fitted& fitted) noexcept {
    const fit::Problem problem = descent.problem();
    const fit::JointState& state = descent.state();
    fit::JointSums sums;
    descent.note_outliers(report_);
    fit::note_common_scale(joint.sheet, state.theta, report_);
    double* const information = work_.information.data();
    fit::accumulate(joint, state, problem, 0.0, fit::Loss::squares, information, sums);
    report_.chi2 = sums.sums.chi2;
    fit::accumulate(joint, state, problem, descent.misfit_variance(), fit::Loss::squares, information, sums,
                    &fitted.tally);
    if (!sums.sums.finite || !std::isfinite(report_.chi2)) return false;
    fitted.tally.write(joint.sensors(), report_);
    report_.excitation = fitted.tally.excitation();
    if (told_.levels.count > 1 && follows_inclination(problem, state.theta, options_.roll_axis, told_.use_degc))
      told_.follows_inclination = true;
    const fit::JointAnalysis analysis = {
        joint,     state,  gravity_.g_mps2, descent.misfit_variance(), fit::rank_floor(fitted.tally),
        stations_, count_, scratch_};
    if (!fit::analyse(analysis, work_, told_, report_)) return false;
    report_.rank = told_.rank;
    report_.gauge = told_.gauge;
    report_.condition = told_.condition;
    report_.degrees_of_freedom = sums.sums.rows - 2 * report_.stations - told_.rank;
    const int freedom = report_.degrees_of_freedom;
    report_.p_value = freedom >= 1 ? chi2_tail(report_.chi2, freedom) : 1.0;
    report_.level_misfit = fit::level_misfit(problem, state.theta, stations_, descent.misfit_variance());
    double factor = 1.0;
    if (options_.estimate_misfit) {
      factor = fit::note_loud_sensor(problem, fitted.tally, report_);
    } else if (freedom >= 1 && report_.chi2 > freedom) {
      factor = report_.chi2 / freedom;
    }
    widen(factor, joint, information);
    return doubt_higher_orders(joint, descent, factor);
  }

  /// What the orders above that of the fit may do is not nothing: the covariance is that of a fit of the third order
  /// that found nothing in them, where the prior speaks wherever the stations do not.
  bool doubt_higher_orders(const fit::Joint& joint, const fit::Descent& descent, double factor) noexcept {
    double* const information = work_.information.data();
    const fit::JointState& state = descent.state();
    if (joint.order < kMaxTemperatureOrder) {
      fit::JointSums sums;
      fit::accumulate(whole_, state, descent.problem(), descent.misfit_variance(), fit::Loss::squares, information,
                      sums);
      if (!fit::to_posterior(whole_, state.theta, information)) return false;
      for (int k = 0; k < whole_.parameters() * whole_.parameters(); ++k) information[k] *= factor;
    }
    fit::note_forecast(whole_, state, gravity_.g_mps2, report_.misfit_mps2, work_, told_);
    return true;
  }

  /// What the residuals say of the noise widens every sigma alike.
  void widen(double factor, const fit::Joint& joint, double* covariance) noexcept {
    for (int k = 0; k < joint.parameters() * joint.parameters(); ++k) covariance[k] *= factor;
    for (int k = 0; k < 4 * joint.sensors(); ++k) report_.sigma[at(k)] *= std::sqrt(factor);
    for (int i = 0; i < joint.sensors(); ++i) {
      for (TemperatureCoefficient& c : told_.sensor[at(i)].scale) c.sigma *= std::sqrt(factor);
      for (TemperatureCoefficient& c : told_.sensor[at(i)].bias) c.sigma *= std::sqrt(factor);
    }
  }

  Expected<Calibration> compose(const fit::Joint& joint, const fit::JointState& state,
                                const fit::Fitted& fitted) noexcept {
    const ChebyshevSpan seen = confirmed_span(stations_, count_, told_.levels);
    report_.temperature_min_degc = seen.lowest;
    report_.temperature_max_degc = seen.highest;
    const ChebyshevSpan span = {seen.lowest - kLevelMargin_degc, seen.highest + kLevelMargin_degc};
    told_.inflation = fit::covering_covariance(whole_, state, span, work_);
    if (!(told_.inflation > 0.0)) return fail(Errc::diverged);
    Expected<Calibration> out(tl::in_place);
    const Error error =
        fit::compose(fit::with_polynomials(joint, state), gravity_, fitted.theta, work_.vectors.data(), report_, *out);
    if (error.code != Errc::ok) out = tl::unexpected<Error>(error);
    return out;
  }

  /// The scale factor that leaves its bound at some temperature of the span of use, apart from its mean.
  Error bent(const fit::JointState& state) const noexcept {
    for (int i = 0; i < datasheet_.size; ++i) {
      for (int k = 0; k < kShapePoints; ++k) {
        const Cubic t = chebyshev_values(2.0 * k / (kShapePoints - 1.0) - 1.0);
        double shape = 0.0;
        for (std::size_t j = 0; j < t.size(); ++j) shape += state.scale[at(i)][j] * t[j];
        const double off = std::fabs(shape - 1.0);
        if (!(off <= options_.max_scale_change)) return {Errc::implausible, i, off, options_.max_scale_change};
      }
    }
    return {};
  }

  Error judge(const fit::Joint& joint, const fit::Descent& descent, const fit::Fitted& fitted) noexcept {
    const int needed = joint.parameters() - 3;
    if (options_.require_full_rank && told_.rank < needed) {
      return {Errc::unobservable, -1, static_cast<double>(told_.rank), static_cast<double>(needed)};
    }
    const fit::Problem problem = descent.problem();
    Error wrong = fit::judge_figures(problem, options_, fitted, report_);
    if (wrong.code == Errc::ok) wrong = bent(descent.state());
    if (wrong.code == Errc::ok) return wrong;
    const Error twins = fit::twin_channels(problem);
    return twins.code != Errc::ok ? twins : wrong;
  }

  const Datasheet& datasheet_;
  const GravityReference& gravity_;
  const Station* stations_;
  int count_;
  const FitOptions& options_;
  Station* scratch_;
  TemperatureWork& work_;
  TemperatureReport& told_;
  FitReport& report_;
  fit::Joint whole_;  ///< of every order that there may be
};

Error refused_options(const TemperatureOptions& options) noexcept {
  const int highest = kMaxTemperatureOrder;
  if (options.order < kAutomaticOrder || options.order > highest) {
    return {Errc::out_of_range, 2, static_cast<double>(options.order), static_cast<double>(highest)};
  }
  if (options.max_order < 0 || options.max_order > highest) {
    return {Errc::out_of_range, 2, static_cast<double>(options.max_order), static_cast<double>(highest)};
  }
  const ChebyshevSpan& use = options.use_degc;
  const bool given = use.lowest != use.highest;
  if (given && !(use.highest - use.lowest >= kLevelsApart_degc)) {
    return {Errc::out_of_range, 3, use.highest - use.lowest, kLevelsApart_degc};
  }
  if (given && !(use.lowest >= kPlausibleMin_degc)) return {Errc::out_of_range, 3, use.lowest, kPlausibleMin_degc};
  if (given && !(use.highest <= kPlausibleMax_degc)) return {Errc::out_of_range, 3, use.highest, kPlausibleMax_degc};
  return {};
}

/// The span of use, or that of the stations: never without width, so that what is missing can be found out.
ChebyshevSpan span_of(const TemperatureOptions& options, const TemperatureLevels& levels) noexcept {
  if (options.use_degc.lowest != options.use_degc.highest) return options.use_degc;
  const double middle = 0.5 * (levels.lowest_degc + levels.highest_degc);
  const double half = std::fmax(levels.highest_degc - middle, 0.5 * kLevelsApart_degc);
  return {middle - half, middle + half};
}

}  // namespace

Datasheet with_temperature_of(const Datasheet& datasheet, const Calibration& calibration) noexcept {
  Datasheet out = datasheet;
  for (int i = 0; i < datasheet.size && i < calibration.model.size; ++i) {
    SensorCoefficients& c = out.sensor[at(i)].coefficients;
    const SensorCoefficients& now = calibration.model.sensor[at(i)];
    if (c.scale[0] == 0.0 || now.scale[0] == 0.0) continue;  // no sensor: nothing to carry over
    const double length = now.scale[0] / c.scale[0];
    for (std::size_t k = 1; k < c.scale.size(); ++k) {
      c.scale[k] = now.scale[k] / length;
      c.bias[k] = now.bias[k] * length;
    }
  }
  return out;
}

Expected<Calibration> calibrate_over_temperature(const Datasheet& datasheet, const GravityReference& gravity,
                                                 const Station* stations, int count, const TemperatureOptions& options,
                                                 Station* scratch, TemperatureWork& work, TemperatureReport* report,
                                                 FitReport* fit_report) noexcept {
  TemperatureReport own;
  FitReport own_fit;
  TemperatureReport& told = report != nullptr ? *report : own;
  FitReport& r = fit_report != nullptr ? *fit_report : own_fit;
  told = TemperatureReport{};
  r = FitReport{};
  const Error odd = refused_options(options);
  if (odd.code != Errc::ok) return tl::unexpected<Error>(odd);
  told.levels = temperature_levels(stations, stations == nullptr ? 0 : count);
  told.use_degc = span_of(options, told.levels);
  const bool automatic = options.order == kAutomaticOrder;
  told.rolls = fit::problem_of(datasheet, gravity.g_mps2, options.fit, {stations, count}).roll.used;
  if (told.rolls && options.order > 0) return fail(Errc::out_of_range, 5, static_cast<double>(options.order), 0.0);
  const int supported = told.rolls                                  ? 0
                        : told.levels.count - 1 < options.max_order ? told.levels.count - 1
                                                                    : options.max_order;
  for (int order = automatic ? supported : options.order; order > 0; --order) {
    if (!free_terms(datasheet, order)) return fail(Errc::out_of_range, 4);
    told.follows_time = one_way(stations, count);
    FitReport attempt;
    const Error wrong = fit::refused_input(datasheet, gravity, options.fit, stations, count, attempt);
    r = attempt;
    if (wrong.code != Errc::ok) return tl::unexpected<Error>(wrong);
    if (!fit::acceptable(datasheet, gravity.g_mps2)) return fail(Errc::diverged);
    Expected<Calibration> out =
        Attempt(datasheet, gravity, stations, count, options.fit, scratch, work, told, r).run(order);
    const bool too_much = !out && out.error().code == Errc::unobservable;
    if (!automatic || !too_much) {
      if (automatic && order < options.max_order) {
        told.missing = missing_levels(told.levels, told.use_degc, order + 2, told.missing_degc);
      }
      return out;
    }
  }
  told.order = 0;
  told.follows_time = false;
  if (automatic && options.max_order > 0 && !told.rolls) {
    told.missing = missing_levels(told.levels, told.use_degc, 2, told.missing_degc);
  }
  Expected<Calibration> out = calibrate(datasheet, gravity, stations, count, options.fit, &r);
  told.parameters = r.parameters;
  told.rank = r.rank;
  told.gauge = r.gauge;
  told.condition = r.condition;
  told.iterations = r.iterations;
  told.null_directions = r.null_directions;
  if (out && automatic && told.levels.count > 1) {
    // No drift could be estimated, so one level speaks for itself alone.
    const ChebyshevSpan seen = fullest_level(stations, count, told.levels);
    r.temperature_min_degc = out->report.temperature_min_degc = seen.lowest;
    r.temperature_max_degc = out->report.temperature_max_degc = seen.highest;
  }
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
