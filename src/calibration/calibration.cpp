/// From converged parameters to an accepted calibration, or to the reason why not.
#include <cmath>

#include "fit_report.hpp"
#include "plumb/calibration/temperature_fit.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// Eigenvalues below this times the largest are rounding.
constexpr double kRankTolerance = 1e-10;
/// Errors of the fitted directions feign information of about their own variance where there is none (one
/// circle of rolls looks ever so slightly like a band); such eigenvalues count as zero too.
constexpr double kFeignedInformation = 4.0;
/// The nine harmonics of gravity that the length sees need nine directions.
constexpr int kStationsForFullRank = 9;
constexpr int kStationsAtLeast = 3;

/// SF_i = |W_i| SF0_i and B_i = (B0_i + b_i) / |W_i| in the sense in which the sensor counts.
SensorCoefficients recalibrated(const SensorCoefficients& nominal, double length, double bias_mps2) noexcept {
  SensorCoefficients out = nominal;
  out.bias[0] += bias_mps2;
  for (std::size_t k = 0; k < 4; ++k) {
    out.scale[k] *= length;
    out.bias[k] /= length;
  }
  return out;
}

}  // namespace

namespace fit {

namespace {

/// Not inlined: the array that is tried needs no room under the rest.
[[gnu::noinline]] Error make_array(const std::array<SensorRow, kCapacity>& rows, int n, SensorArray& out) noexcept {
  const Expected<SensorArray> made = SensorArray::make(rows.data(), n);
  if (!made) return made.error();
  out = *made;
  return Error{};
}

/// Tails at which the limits of a monitor take what a calibration leaves: of calibrations that err more, and, at its
/// default rate of rejection, of a misfit, which is noise of every attitude.
constexpr double kBeyond = 0.01, kRejection = 1e-6;

}  // namespace

Error compose(const Datasheet& datasheet, const GravityReference& gravity, const Parameters& theta,
              const double* covariance, FitReport& report, Calibration& out) noexcept {
  const int n = datasheet.size;
  const double sign = datasheet.reads == Reads::gravity ? 1.0 : -1.0;
  std::array<SensorRow, kCapacity> rows{};
  std::array<double, kCapacity> length{};
  out.model = datasheet.model();
  for (int i = 0; i < n; ++i) {
    const Vec3 w = row_of(theta, i);
    length[at(i)] = norm(w);
    rows[at(i)] = datasheet.sensor[at(i)].row;
    rows[at(i)].axis = scaled(w, 1.0 / length[at(i)]);
    rows[at(i)].sigma_mps2 /= length[at(i)];
    SensorCoefficients& c = out.model.sensor[at(i)];
    c = recalibrated(c, length[at(i)], sign * theta[at(4 * i + 3)]);
  }
  const Error unsound = make_array(rows, n, out.array);
  if (unsound.code != Errc::ok) return unsound;
  // An error of W_i and b_i reaches the reading (r - b_i) / |W_i|, hence both lengths.
  RowUncertainty uncertainty;
  const auto wider = [&report](double p, int numbers) {
    return estimated_sigma_widening(report.chi2, report.degrees_of_freedom, p, numbers);
  };
  const double of_parameters = wider(kBeyond, 4 * n - 2), of_misfit = wider(kRejection, 2);
  const double mean_square = gravity.g_mps2 * gravity.g_mps2 / 3.0;  // of a component of g over the sphere
  for (int a = 0; a < 4 * n; ++a) {
    for (int b = 0; b <= a; ++b) {
      uncertainty.covariance[at(a * (a + 1) / 2 + b)] =
          of_parameters * of_parameters * covariance[a * 4 * n + b] / (length[at(a / 4)] * length[at(b / 4)]);
    }
  }
  for (int i = 0; i < n; ++i) {
    const double misfit =
        of_misfit * (i == report.high_variance_sensor ? report.loud_misfit_mps2 : report.misfit_mps2) / length[at(i)];
    uncertainty.misfit_mps2[at(i)] = misfit;
    double variance = misfit * misfit;
    for (int p = 0; p < 4; ++p) {
      const int a = 4 * i + p;
      variance += uncertainty.covariance[at(a * (a + 1) / 2 + a)] * (p < 3 ? mean_square : 1.0);
    }
    report.e_cal_mps2[at(i)] = std::sqrt(std::fmax(variance, 0.0));
  }
  uncertainty.common_scale = gravity.sigma_mps2 / gravity.g_mps2;
  out.array.set_uncertainty(uncertainty);
  if (&out.report != &report) out.report = report;
  return Error{};
}

namespace {

Error refused_scale(const Datasheet& datasheet) noexcept {
  for (int i = 0; i < datasheet.size; ++i) {
    const double scale = datasheet.sensor[at(i)].coefficients.scale[0];
    if (scale == 0.0 || !std::isfinite(scale)) return Error{Errc::not_finite, i, scale, 0.0};
  }
  return Error{};
}

Error refused_setting(const Datasheet& datasheet, const FitOptions& options) noexcept {
  if (!plainly_sound(datasheet)) {
    const Expected<SensorArray> nominal = datasheet.array();
    if (!nominal) return nominal.error();
  }
  const Error scale = refused_scale(datasheet);
  if (scale.code != Errc::ok) return scale;
  if (!unit_axis(options.roll_axis)) return Error{Errc::out_of_range, 0, norm(options.roll_axis), 1.0};
  if (!(options.roll_axis_deviation_rad >= 0.0) || !std::isfinite(options.roll_axis_deviation_rad)) {
    return Error{Errc::out_of_range, 2, options.roll_axis_deviation_rad, 0.0};
  }
  return Error{};
}

}  // namespace

Error refused_stations(const Problem& problem, const FitOptions& options, FitFigures& report) noexcept {
  report.roll_groups = problem.roll.groups;
  report.single_station_groups = problem.roll.lone;
  if (problem.roll.used) {
    report.roll_axis = problem.roll.axis;
    report.roll_axis_deviation_rad = problem.roll.wobble_rad;
  }
  if (problem.roll.groups > kMaxRollGroups) {
    return Error{Errc::out_of_range, 1, static_cast<double>(problem.roll.groups), kMaxRollGroups};
  }
  report.stations = usable_stations(problem);
  note_stations(problem, report);
  const int needed = options.require_full_rank ? kStationsForFullRank : kStationsAtLeast;
  if (report.stations < needed) {
    return Error{Errc::too_few_stations, -1, static_cast<double>(report.stations), static_cast<double>(needed)};
  }
  for (int k = 0; k < problem.count; ++k) {
    const Station& station = problem.stations[k];
    const double t = station.temperature_degc;
    if (station.count == 0 || (t >= kPlausibleMin_degc && t <= kPlausibleMax_degc) || std::isnan(t)) continue;
    return Error{Errc::diverged, k, t, t < kPlausibleMin_degc ? kPlausibleMin_degc : kPlausibleMax_degc};
  }
  return same_numbers(problem);
}

Error refused_input(const Datasheet& datasheet, const GravityReference& gravity, const FitOptions& options,
                    const Station* stations, int count, FitFigures& report) noexcept {
  const Error wrong = refused_setting(datasheet, options);
  if (wrong.code != Errc::ok) return wrong;
  return refused_stations(problem_of(datasheet, gravity.g_mps2, options, {stations, count}), options, report);
}

double rank_floor(const FitTally& tally) noexcept {
  return std::fmax(kRankTolerance, kFeignedInformation * tally.direction_variance());
}

/// `describe` where the axes are held: no covariance, no report beyond the figures. Leaves the sums' blocks to the
/// judge of the rank. False where something is not finite.
[[gnu::noinline]] bool describe_held(const Problem& problem, double variance, Fitted& fitted, Blocks& blocks,
                                     FitFigures& r) noexcept {
  Parameters gradient;
  turn_to_datasheet(problem.datasheet, problem.roll, fitted.theta);
  if (variance > 0.0) {
    r.chi2 = accumulate(problem, fitted.theta, 0.0, Loss::squares, blocks.data(), gradient, Room{}).chi2;
  }
  const Sums sums =
      accumulate(problem, fitted.theta, variance, Loss::squares, blocks.data(), gradient, Room{}, &fitted.tally);
  if (!(variance > 0.0)) r.chi2 = sums.chi2;
  if (!sums.finite || !std::isfinite(r.chi2)) return false;
  fitted.tally.write(problem.datasheet.size, r);
  r.gauge = 3;  // no common rotation is left to a fit without axes
  r.degrees_of_freedom = sums.rows - 2 * r.stations;
  return true;
}

}  // namespace fit

Error Calibrator::refused(const Station* stations, int count, FitReport& report) const noexcept {
  const Error wrong = fit::refused_input(datasheet_, gravity_, options_, stations, count, report);
  if (wrong.code != Errc::ok) return wrong;
  if (stop_ == StopReason::not_finite) return Error{Errc::diverged, bad_station_, cost_, 0.0};
  return Error{};
}

/// Fills the report, `fitted` and the covariance; false where something is not finite.
bool Calibrator::describe(const fit::Problem& problem, fit::Fitted& fitted, Information& covariance,
                          FitReport& r) const noexcept {
  const fit::PriorRoots roots = fit::prior_roots(datasheet_);
  fitted.theta = fit::natural(datasheet_, roots, theta_);
  fit::turn_to_datasheet(datasheet_, problem.roll, fitted.theta);
  fit::note_outliers(problem, r, r.outlier);
  fit::note_common_scale(datasheet_, fitted.theta, r);
  fit::Parameters gradient;
  fit::RollSums roll;
  fit::Screening screening(problem);
  const fit::Room room = {&roll, &screening, nullptr};
  Information scratch;  // the blocks first, then what the analysis needs
  // Chi^2 is reported against the datasheet's noise alone, with the directions that this noise would choose.
  const double variance = misfit_mps2_ * misfit_mps2_;
  if (variance > 0.0) {
    r.chi2 = fit::accumulate(problem, fitted.theta, 0.0, fit::Loss::squares, scratch.data(), gradient, room).chi2;
  }
  const fit::Sums sums = fit::accumulate(problem, fitted.theta, variance, fit::Loss::squares, scratch.data(), gradient,
                                         room, &fitted.tally);
  if (!(variance > 0.0)) r.chi2 = sums.chi2;
  if (!sums.finite || !std::isfinite(r.chi2)) return false;
  fitted.tally.write(datasheet_.size, r);
  r.excitation = fitted.tally.excitation();
  fit::expand(scratch.data(), &roll, roots, datasheet_.size, fit::Square{covariance.data(), 4 * datasheet_.size});
  const double floor = fit::rank_floor(fitted.tally);
  if (!fit::analyse(datasheet_, problem.roll, roots, fitted.theta, floor, covariance.data(), scratch.data(), r)) {
    return false;
  }
  r.degrees_of_freedom = sums.rows - 2 * r.stations - r.rank;
  r.p_value = r.degrees_of_freedom >= 1 ? chi2_tail(r.chi2, r.degrees_of_freedom) : 1.0;
  if (problem.roll.used) r.common_turn = fit::common_turn(datasheet_, problem.roll.axis, fitted.theta);
  if (r.temperature_max_degc - r.temperature_min_degc >= kLevelsApart_degc) {
    r.level_misfit = fit::level_misfit(problem, fitted.theta, problem.stations.plain(), variance);
  }
  double factor = 1.0;
  if (options_.estimate_misfit) {
    factor = fit::note_loud_sensor(problem, fitted.tally, r);
  } else if (r.degrees_of_freedom >= 1 && r.chi2 > r.degrees_of_freedom) {
    factor = r.chi2 / r.degrees_of_freedom;
  }
  fit::inflate(factor, r.parameters, covariance.data(), r);
  return true;
}

Error Calibrator::judge(const fit::Problem& problem, const fit::Fitted& fitted, FitReport& r) const noexcept {
  const int needed = r.parameters - (problem.roll.used ? 1 : 3);
  if (options_.require_full_rank && r.rank < needed) {
    return Error{Errc::unobservable, -1, static_cast<double>(r.rank), static_cast<double>(needed)};
  }
  return fit::judge_figures(problem, options_, fitted, r);
}

bool Calibrator::sets_aside(const Station& station) const noexcept {
  if (phase_ != Phase::screened) return false;
  fit::Problem problem = fit::problem_of(datasheet_, gravity_.g_mps2, options_, {&station, 1});
  const fit::Screen screen = {screen_, screen_misfit_mps2_ * screen_misfit_mps2_};
  problem.screen = &screen;
  return fit::Screening(problem).out(station);
}

namespace {

[[gnu::noinline]] void clear_report(FitReport& report) noexcept { report = FitReport{}; }

}  // namespace

Expected<Calibration> Calibrator::finish(const Station* stations, int count, FitReport* report) const noexcept {
  Expected<Calibration> out(tl::in_place);  // one calibration, made where the caller wants it: it is large
  const Error error = finish_into(stations, count, report != nullptr ? *report : out->report, *out);
  if (error.code != Errc::ok) out = tl::unexpected<Error>(error);
  return out;
}

/// `report` may be that of `out`.
[[gnu::noinline]] Error Calibrator::finish_into(const Station* stations, int count, FitReport& r,
                                                Calibration& out) const noexcept {
  clear_report(r);
  r.parameters = 4 * datasheet_.size;
  r.iterations = iterations_;
  r.start = started_;
  r.stop = stop_;
  r.misfit_mps2 = misfit_mps2_;
  const Error wrong = refused(stations, count, r);
  if (wrong.code != Errc::ok) return wrong;
  fit::Problem problem = fit::problem_of(datasheet_, gravity_.g_mps2, options_, {stations, count});
  const fit::Screen screen = {screen_, screen_misfit_mps2_ * screen_misfit_mps2_};
  if (phase_ == Phase::screened) problem.screen = &screen;
  fit::Harmonics harmonics;
  fit::Fitted fitted(&harmonics);
  Information covariance;
  if (!describe(problem, fitted, covariance, r)) return Error{Errc::diverged, -1, cost_};
  const Error composed = fit::compose(datasheet_, gravity_, fitted.theta, covariance.data(), r, out);
  if (composed.code == Errc::ok) {
    r.inclination_sigma_rad = fit::inclination_sigma(problem, fitted.theta, out.array);
    out.report.inclination_sigma_rad = r.inclination_sigma_rad;
  }
  Error error = judge(problem, fitted, r);
  out.report.noise_mps2 = r.noise_mps2;
  if (stop_ != StopReason::converged) error = Error{Errc::diverged, -1, cost_, 0.0};
  if (error.code == Errc::ok) return composed;
  if (error.code != Errc::unobservable) {
    const Error twins = fit::twin_channels(problem);
    if (twins.code != Errc::ok) error = twins;
  }
  return error;
}

/// Omits what the screen omits; returns how many stations that are.
[[gnu::noinline]] int Calibrator::screen_out(StationList& stations) const noexcept {
  if (phase_ != Phase::screened) return 0;
  const fit::Screen screen = {screen_, screen_misfit_mps2_ * screen_misfit_mps2_};
  const fit::Problem problem = {datasheet_, gravity_.g_mps2, stations, stations.size(), {}, &screen};
  fit::Screening screening(problem);
  int out = 0;
  for (int k = 0; k < stations.size(); ++k) {
    if (!screening.out(stations[k])) continue;
    stations.leave_out(k);
    ++out;
  }
  return out;
}

/// Fills `fitted` and the figures; false where something is not finite.
[[gnu::noinline]] bool Calibrator::describe_held(const StationList& stations, fit::Fitted& fitted,
                                                 FitFigures& figures) const noexcept {
  const fit::Problem problem = {datasheet_, gravity_.g_mps2, stations, stations.size(), {}, nullptr};
  fit::Blocks blocks;
  if (!fit::describe_held(problem, misfit_mps2_ * misfit_mps2_, fitted, blocks, figures)) return false;
  figures.rank = fit::rank_of_held(datasheet_, blocks.data(), fit::rank_floor(fitted.tally));
  figures.degrees_of_freedom -= figures.rank;
  figures.p_value = figures.degrees_of_freedom >= 1 ? chi2_tail(figures.chi2, figures.degrees_of_freedom) : 1.0;
  return figures.rank >= 0;
}

[[gnu::noinline]] Error Calibrator::refused_held(const StationList& stations, FitFigures& figures) const noexcept {
  Error error = fit::refused_scale(datasheet_);
  const fit::Problem all = {datasheet_, gravity_.g_mps2, stations, stations.size(), {}, nullptr};
  if (error.code == Errc::ok) error = fit::refused_stations(all, options_, figures);
  if (error.code == Errc::ok && stop_ == StopReason::not_finite) error = {Errc::diverged, bad_station_, cost_, 0.0};
  return error;
}

[[gnu::noinline]] Error Calibrator::judge_held(const StationList& stations, const fit::Fitted& fitted,
                                               FitFigures& figures) const noexcept {
  const fit::Problem all = {datasheet_, gravity_.g_mps2, stations, stations.size(), {}, nullptr};
  Error error = fit::judge_figures(all, options_, fitted, figures);
  if (stop_ != StopReason::converged) error = Error{Errc::diverged, -1, cost_, 0.0};
  if (error.code == Errc::ok) return error;
  const Error twins = fit::twin_channels(all);
  return twins.code != Errc::ok ? twins : error;
}

namespace {

/// Not inlined, nor is the next: no copy of either result lies under the sums.
[[gnu::noinline]] void take_parameters(const Calibrator& calibrator, fit::Parameters& theta) noexcept {
  theta = calibrator.parameters();
}

[[gnu::noinline]] void write_held(const Datasheet& datasheet, const fit::Parameters& theta, const FitFigures& figures,
                                  HeldFit& out) noexcept {
  out = {{}, {}, figures.rank, figures.degrees_of_freedom, figures.chi2, figures.p_value};
  const double sign = datasheet.reads == Reads::gravity ? 1.0 : -1.0;
  for (int i = 0; i < datasheet.size; ++i) {
    out.length[at(i)] = norm(fit::row_of(theta, i));
    out.bias_mps2[at(i)] = sign * theta[at(4 * i + 3)];
  }
}

}  // namespace

Error Calibrator::finish_held(const StationList& stations, HeldFit& out) const noexcept {
  FitFigures r;
  r.parameters = 2 * datasheet_.size;
  r.misfit_mps2 = misfit_mps2_;
  const Error refused = refused_held(stations, r);
  if (refused.code != Errc::ok) return refused;
  StationList used = stations;
  r.outliers = screen_out(used);
  fit::Fitted fitted(nullptr);
  take_parameters(*this, fitted.theta);
  if (!describe_held(used, fitted, r)) return Error{Errc::diverged, -1, cost_};
  write_held(datasheet_, fitted.theta, r, out);
  return judge_held(stations, fitted, r);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
