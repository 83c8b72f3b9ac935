/// From converged parameters to an accepted calibration, or to the reason why not.
#include <cmath>

#include "fit_internal.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

using fit::at;

/// Eigenvalues below this times the largest are rounding.
constexpr double kRankTolerance = 1e-10;
/// Errors of the fitted directions feign information of about their own variance where there is none (one
/// circle of rolls looks ever so slightly like a band); such eigenvalues count as zero too.
constexpr double kFeignedInformation = 4.0;
/// The nine harmonics of gravity that the length sees need nine directions.
constexpr int kStationsForFullRank = 9;
constexpr int kStationsAtLeast = 3;

struct Deviation {
  double scale = 0.0;  ///< relative to the datasheet, the larger of the two ratios
  double axis_rad = 0.0;
  double bias_mps2 = 0.0;
};

Deviation deviation_of(const Datasheet& datasheet, const fit::Parameters& theta, int i) noexcept {
  const Vec3 w = fit::row_of(theta, i);
  const double ratio = norm(w);
  return {std::fmax(ratio, 1.0 / ratio) - 1.0, angle_between_rad(w, datasheet.sensor[at(i)].row.axis),
          theta[at(4 * i + 3)]};
}

void note_temperature_span(const fit::Problem& problem, FitReport& report) noexcept {
  bool any = false;
  for (int k = 0; k < problem.count; ++k) {
    const double t = problem.stations[k].temperature_degc;
    if (problem.stations[k].count == 0 || !std::isfinite(t)) continue;
    if (!any || t < report.temperature_min_degc) report.temperature_min_degc = t;
    if (!any || t > report.temperature_max_degc) report.temperature_max_degc = t;
    any = true;
  }
}

/// First parameter beyond its physical bound; written so that a NaN is beyond every bound.
Error implausible(const Datasheet& datasheet, const FitOptions& options, const fit::Parameters& theta) noexcept {
  for (int i = 0; i < datasheet.size; ++i) {
    const Deviation d = deviation_of(datasheet, theta, i);
    const double bias_limit = options.max_bias_sigmas * datasheet.sensor[at(i)].prior.bias_mps2;
    if (!(d.scale <= options.max_scale_change)) {
      return Error{Errc::implausible, i, d.scale, options.max_scale_change};
    }
    if (!(d.axis_rad <= options.max_axis_change_rad)) {
      return Error{Errc::implausible, i, d.axis_rad, options.max_axis_change_rad};
    }
    if (!(std::fabs(d.bias_mps2) <= bias_limit)) return Error{Errc::implausible, i, d.bias_mps2, bias_limit};
  }
  return Error{};
}

/// Everything but rank and stations, which are judged first.
Error judge(const Datasheet& datasheet, const FitOptions& options, const fit::Parameters& theta,
            const FitReport& report) noexcept {
  const int needed = report.parameters - 3;
  if (options.require_full_rank && report.rank < needed) {
    return Error{Errc::unobservable, -1, static_cast<double>(report.rank), static_cast<double>(needed)};
  }
  const Error error = implausible(datasheet, options, theta);
  if (error.code != Errc::ok) return error;
  if (!(report.norm_rms_mps2 <= options.max_norm_rms_mps2)) {
    return Error{Errc::poor_fit, -1, report.norm_rms_mps2, options.max_norm_rms_mps2};
  }
  return Error{};
}

void set_chi2(const fit::ResidualSummary& summary, FitReport& report) noexcept {
  report.degrees_of_freedom = summary.rows - 2 * report.stations - report.rank;
  report.p_value = 1.0;
  if (report.degrees_of_freedom >= 1) report.p_value = chi2_tail(report.chi2, report.degrees_of_freedom);
}

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

Expected<Calibration> compose(const Datasheet& datasheet, const GravityReference& gravity, const Parameters& theta,
                              const double* covariance, FitReport& report) noexcept {
  const int n = datasheet.size;
  const double sign = datasheet.reads == Reads::gravity ? 1.0 : -1.0;
  std::array<SensorRow, kCapacity> rows{};
  std::array<double, kCapacity> length{};
  Expected<Calibration> out(Calibration{});
  out->model = datasheet.model();
  for (int i = 0; i < n; ++i) {
    const Vec3 w = row_of(theta, i);
    length[at(i)] = norm(w);
    rows[at(i)] = datasheet.sensor[at(i)].row;
    rows[at(i)].axis = scaled(w, 1.0 / length[at(i)]);
    rows[at(i)].sigma_mps2 /= length[at(i)];
    SensorCoefficients& c = out->model.sensor[at(i)];
    c = recalibrated(c, length[at(i)], sign * theta[at(4 * i + 3)]);
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), n);
  if (!array) return tl::unexpected<Error>(array.error());
  // An error of W_i and b_i reaches the reading (r - b_i) / |W_i|, hence both lengths.
  RowUncertainty uncertainty;
  const double mean_square = gravity.g_mps2 * gravity.g_mps2 / 3.0;  // of a component of g over the sphere
  for (int a = 0; a < 4 * n; ++a) {
    for (int b = 0; b <= a; ++b) {
      uncertainty.covariance[at(a * (a + 1) / 2 + b)] =
          covariance[a * 4 * n + b] / (length[at(a / 4)] * length[at(b / 4)]);
    }
  }
  for (int i = 0; i < n; ++i) {
    const double misfit = report.misfit_mps2 / length[at(i)];
    uncertainty.misfit_mps2[at(i)] = misfit;
    double variance = misfit * misfit;
    for (int p = 0; p < 4; ++p) {
      const int a = 4 * i + p;
      variance += uncertainty.covariance[at(a * (a + 1) / 2 + a)] * (p < 3 ? mean_square : 1.0);
    }
    report.e_cal_mps2[at(i)] = std::sqrt(std::fmax(variance, 0.0));
  }
  // The length of gravity where the tool was calibrated is itself uncertain: a common scale of all readings, which
  // parity cannot see and every norm can. Not part of e_cal, which compares sensors.
  const double share = gravity.sigma_mps2 / gravity.g_mps2;
  for (int a = 0; a < 4 * n; ++a) {
    for (int b = 0; b <= a; ++b) {
      if (a % 4 == 3 || b % 4 == 3) continue;
      uncertainty.covariance[at(a * (a + 1) / 2 + b)] +=
          share * share * rows[at(a / 4)].axis[at(a % 4)] * rows[at(b / 4)].axis[at(b % 4)];
    }
  }
  out->array = *array;
  out->array.set_uncertainty(uncertainty);
  out->report = report;
  return out;
}

}  // namespace fit

Expected<Calibration> Calibrator::finish(const Station* stations, int count, FitReport* report) noexcept {
  FitReport own;
  FitReport& r = report != nullptr ? *report : own;
  r = FitReport{};
  r.parameters = 4 * datasheet_.size;
  r.iterations = iterations_;
  r.stop = stop_;
  r.misfit_mps2 = misfit_mps2_;
  const Expected<SensorArray> nominal = datasheet_.array();
  if (!nominal) return tl::unexpected<Error>(nominal.error());
  const fit::Problem problem = {datasheet_, gravity_.g_mps2, stations, stations == nullptr ? 0 : count};
  r.stations = fit::usable_stations(problem);
  note_temperature_span(problem, r);
  const int needed = options_.require_full_rank ? kStationsForFullRank : kStationsAtLeast;
  if (r.stations < needed) return fail(Errc::too_few_stations, -1, r.stations, needed);
  if (stop_ == StopReason::not_finite) return fail(Errc::diverged, -1, cost_);

  const fit::PriorRoots roots = fit::prior_roots(datasheet_);
  fit::Parameters theta = fit::natural(datasheet_, roots, theta_);
  fit::turn_to_datasheet(datasheet_, theta);
  const fit::ResidualSummary summary = fit::describe_residuals(problem, theta, r);
  fit::Parameters gradient;
  const double variance = misfit_mps2_ * misfit_mps2_;
  const fit::Sums sums = fit::accumulate(problem, theta, variance, scratch_.data(), gradient);
  if (!summary.finite || !sums.finite) return fail(Errc::diverged, -1, cost_);
  fit::expand(scratch_.data(), roots, datasheet_.size, normal_.data());
  const double floor = std::fmax(kRankTolerance, kFeignedInformation * summary.direction_variance);
  if (!fit::analyse(datasheet_, roots, theta, floor, normal_.data(), scratch_.data(), r)) {
    return fail(Errc::diverged, -1, cost_);
  }
  set_chi2(summary, r);
  if (!options_.estimate_misfit && r.degrees_of_freedom >= 1 && r.chi2 > r.degrees_of_freedom) {
    fit::inflate(r.chi2 / r.degrees_of_freedom, r.parameters, normal_.data(), r);
  }
  Expected<Calibration> out = fit::compose(datasheet_, gravity_, theta, normal_.data(), r);
  if (stop_ != StopReason::converged) return fail(Errc::diverged, -1, cost_);
  const Error error = judge(datasheet_, options_, theta, r);
  if (error.code != Errc::ok) return tl::unexpected<Error>(error);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
