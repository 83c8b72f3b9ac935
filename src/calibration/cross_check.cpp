#include "plumb/calibration/cross_check.hpp"

#include <cmath>
#include <limits>

#include "fit_internal.hpp"
#include "plumb/array/geometry.hpp"
#include "station_solver.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// Variance of a weighted sum of the readings: noise of the mean, misfit, covariance of the fit.
double variance_of(const SensorArray& array, SensorSet used, const std::array<double, kCapacity>& weight,
                   const Vec3& gravity_mps2, double samples) noexcept {
  double sum = 0.0, along = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!used.has(i)) continue;
    along += weight[at(i)] * dot(array.axis(i), gravity_mps2);
    sum += weight[at(i)] * weight[at(i)] * array.sigma_mps2(i) * array.sigma_mps2(i) / samples;
    for (int j = 0; j < array.size(); ++j) {
      if (used.has(j)) sum += weight[at(i)] * weight[at(j)] * array.uncertainty().at(i, j, gravity_mps2);
    }
  }
  along *= array.uncertainty().common_scale;
  return sum + along * along;
}

struct Tally {
  double squared_norm = 0.0;
  double squared_parity = 0.0;
  double squared_sigmas = 0.0;
  double worst_sigmas = -1.0;
};

void take(const StationPrediction& p, int station, Tally& tally, HoldOut& out) noexcept {
  ++out.judged;
  tally.squared_norm += p.norm_error_mps2 * p.norm_error_mps2;
  tally.squared_parity += p.parity_rms_mps2 * p.parity_rms_mps2;
  tally.squared_sigmas += p.sigmas * p.sigmas;
  out.norm_max_mps2 = std::fmax(out.norm_max_mps2, std::fabs(p.norm_error_mps2));
  out.parity_max_mps2 = std::fmax(out.parity_max_mps2, p.parity_rms_mps2);
  if (p.sigmas > tally.worst_sigmas) {
    tally.worst_sigmas = p.sigmas;
    out.worst = station;
  }
}

/// Of a fit that does not settle, or not within the physical bounds: worse than any that does.
constexpr double kUnsettled = 1e300;

/// Chi^2 per degree of freedom without sensor i; infinite where the rest cannot be judged.
double unrest_without(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations, int count,
                      const FitOptions& options, int i, Station* scratch, double& misfit_mps2) noexcept {
  for (int k = 0; k < count; ++k) {
    scratch[k] = stations[k];
    scratch[k].delivered = stations[k].delivered.without(i);
  }
  FitReport report;
  misfit_mps2 = 0.0;
  const Expected<Calibration> fitted = calibrate(datasheet, gravity, scratch, count, options, &report);
  // Nor does a fit that bends a sensor beyond all bounds explain anything: it does so to make up for the faulty sensor.
  const bool settled = fitted || (fitted.error().code != Errc::diverged && fitted.error().code != Errc::implausible);
  if (!settled) return kUnsettled;
  if (!fitted || report.degrees_of_freedom < kOddFreedom) return std::numeric_limits<double>::infinity();
  misfit_mps2 = report.misfit_mps2;
  return report.chi2 / report.degrees_of_freedom;
}

}  // namespace

FitOptions without_limits(FitOptions options) noexcept {
  const double infinite = std::numeric_limits<double>::infinity();
  options.require_full_rank = false;
  options.max_norm_rms_mps2 = infinite;
  options.max_scale_change = infinite;
  options.max_axis_change_rad = infinite;
  options.max_bias_sigmas = infinite;
  options.max_outlier_share = infinite;
  options.max_sensor_excess = infinite;
  return options;
}

StationPrediction predict(const Calibration& calibration, const GravityReference& gravity,
                          const Station& station) noexcept {
  StationPrediction out;
  const SensorArray& array = calibration.array;
  const SensorSet used = station.delivered & array.all();
  const LeastSquares map = least_squares(array, used);
  if (station.count == 0 || !map.valid) return out;
  const Readings y = calibration.model.apply(station.mean, station.temperature_degc, used);
  const Vec3 x = map.estimate(y);
  const double length = norm(x);
  if (!(length > 0.0) || !std::isfinite(length)) return out;
  const Vec3 u = scaled(x, 1.0 / length), g = scaled(u, gravity.g_mps2);
  const auto samples = static_cast<double>(station.count);
  std::array<double, kCapacity> weight{};
  double residual = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!used.has(i)) continue;
    weight[at(i)] = dot(map.column[at(i)], u);
    const double e = y[at(i)] - dot(array.axis(i), x);
    residual += e * e;
  }
  out.norm_error_mps2 = length - gravity.g_mps2;
  const double norm_variance = variance_of(array, used, weight, g, samples);
  double squares = out.norm_error_mps2 * out.norm_error_mps2 / norm_variance;
  const ParityBasis parity = parity_basis(array, used);
  for (int r = 0; r < parity.rows; ++r) {
    double value = 0.0;
    for (int i = 0; i < array.size(); ++i) value += used.has(i) ? parity.weight[at(r)][at(i)] * y[at(i)] : 0.0;
    squares += value * value / variance_of(array, used, parity.weight[at(r)], g, samples);
  }
  if (parity.rows > 0) out.parity_rms_mps2 = std::sqrt(residual / parity.rows);
  out.sigmas = std::sqrt(squares / (1 + parity.rows));
  out.judged = std::isfinite(out.sigmas);
  return out;
}

namespace {

/// `fit_to` makes a calibration of the stations at the front of `scratch`; it is given their number.
template <class FitTo>
HoldOut hold_out_of(FitTo fit_to, const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                    int count, const HoldOutPlan& plan, Station* scratch, StationPrediction* each) noexcept {
  HoldOut out;
  if (stations == nullptr || scratch == nullptr || count < 1 || plan.folds < 2) return out;
  if (plan.rounds < 1 || plan.rounds > plan.folds) return out;
  Tally tally;
  for (int k = 0; k < count && each != nullptr; ++k) each[k] = StationPrediction{};
  for (int fold = 0; fold < plan.rounds && fold < count; ++fold) {
    int kept = 0;
    for (int k = 0; k < count; ++k) {
      if (k % plan.folds != fold) scratch[kept++] = stations[k];
    }
    const Expected<Calibration> without = fit_to(kept);
    for (int k = fold; k < count; k += plan.folds) {
      Station asked = stations[k];
      asked.delivered = fit::usable_channels(datasheet, asked);  // a reading at full scale is none, as in the fit
      const StationPrediction p = without ? predict(*without, gravity, asked) : StationPrediction{};
      if (each != nullptr) each[k] = p;
      if (p.judged) {
        take(p, k, tally, out);
      } else {
        ++out.not_judged;
      }
    }
  }
  if (out.judged == 0) return out;
  out.norm_rms_mps2 = std::sqrt(tally.squared_norm / out.judged);
  out.parity_rms_mps2 = std::sqrt(tally.squared_parity / out.judged);
  out.sigmas = std::sqrt(tally.squared_sigmas / out.judged);
  return out;
}

}  // namespace

HoldOut hold_out(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations, int count,
                 const HoldOutPlan& plan, const FitOptions& options, Station* scratch,
                 StationPrediction* each) noexcept {
  // The stations held out saw the same gravity as the others: how well it is known is no part of the prediction.
  const GravityReference same = {gravity.g_mps2, 0.0, gravity.model};
  const auto fit_to = [&](int kept) { return calibrate(datasheet, same, scratch, kept, options); };
  return hold_out_of(fit_to, datasheet, same, stations, count, plan, scratch, each);
}

HoldOut hold_out_over_temperature(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                                  int count, const HoldOutPlan& plan, const TemperatureOptions& options,
                                  Station* scratch, Station* more_scratch, TemperatureWork& work,
                                  StationPrediction* each) noexcept {
  if (more_scratch == nullptr) return {};
  const GravityReference same = {gravity.g_mps2, 0.0, gravity.model};
  const auto fit_to = [&](int kept) {
    return calibrate_over_temperature(datasheet, same, scratch, kept, options, more_scratch, work);
  };
  return hold_out_of(fit_to, datasheet, same, stations, count, plan, scratch, each);
}

OddSensor odd_sensor(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations, int count,
                     const FitOptions& options, Station* scratch) noexcept {
  OddSensor out;
  if (stations == nullptr || scratch == nullptr) return out;
  FitReport all;
  // What a fit rejects is what tells the sensors apart here.
  FitOptions lenient = without_limits(options);
  lenient.reject_outliers = false;
  const Expected<Calibration> fitted = calibrate(datasheet, gravity, stations, count, lenient, &all);
  FitOptions plausible = lenient;
  plausible.max_scale_change = options.max_scale_change;
  plausible.max_axis_change_rad = options.max_axis_change_rad;
  plausible.max_bias_sigmas = options.max_bias_sigmas;
  if (!fitted && fitted.error().code != Errc::diverged) return out;
  out.with_mps2 = fitted ? all.misfit_mps2 : std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity(), next = least;
  int best = -1;
  for (int i = 0; i < datasheet.size; ++i) {
    double misfit_mps2 = 0.0;
    const double unrest = unrest_without(datasheet, gravity, stations, count, plausible, i, scratch, misfit_mps2);
    if (unrest < least) {
      next = least;
      least = unrest;
      best = i;
      out.without_mps2 = misfit_mps2;
    } else if (unrest < next) {
      next = unrest;
    }
  }
  // Without another sensor to compare with, none stands out.
  if (best < 0 || least >= kUnsettled || !std::isfinite(next)) return out;
  out.ratio = next > 0.0 ? least / next : 1.0;
  if (out.ratio <= kOddRatio) out.sensor = best;
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
