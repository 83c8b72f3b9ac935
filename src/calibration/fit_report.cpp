#include "fit_report.hpp"

#include <cmath>
#include <limits>

#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;
using numbers::kInfinity;

namespace fit {
namespace {

/// Residuals that noise alone explains with at least this probability.
constexpr double kSuspicious = 1e-3;

struct Deviation {
  double scale = 0.0;  ///< relative to the datasheet, the larger of the two ratios
  double axis_rad = 0.0;
  double bias_mps2 = 0.0;
};

Deviation deviation_of(const Datasheet& datasheet, const Parameters& theta, int i) noexcept {
  const Vec3 w = row_of(theta, i);
  const double ratio = norm(w);
  return {std::fmax(ratio, 1.0 / ratio) - 1.0, angle_between_rad(w, datasheet.sensor[at(i)].row.axis),
          theta[at(4 * i + 3)]};
}

/// The parameter furthest beyond its bound, in bounds.
Error furthest_off(const Datasheet& datasheet, const FitOptions& options, const Parameters& theta,
                   int left_out) noexcept {
  Error worst;
  double most = 1.0;
  for (int i = 0; i < datasheet.size; ++i) {
    if (i == left_out) continue;
    const Deviation d = deviation_of(datasheet, theta, i);
    const std::array<double, 3> value = {d.scale, d.axis_rad, std::fabs(d.bias_mps2)};
    const std::array<double, 3> limit = {options.max_scale_change, options.max_axis_change_rad,
                                         options.max_bias_sigmas * datasheet.sensor[at(i)].prior.bias_mps2};
    for (std::size_t k = 0; k < 3; ++k) {
      // A value that is no number is beyond every bound, and so is any but 0 beyond a bound of 0.
      double ratio = kInfinity;
      if (value[k] <= limit[k]) {
        ratio = 0.0;
      } else if (limit[k] > 0.0) {
        ratio = value[k] / limit[k];
      }
      if (!(ratio <= most)) {
        worst = Error{Errc::implausible, i, value[k], limit[k]};
        most = ratio;
        if (std::isnan(ratio)) most = kInfinity;
      }
    }
  }
  return worst;
}

/// Variance of the samples about the means of their stations, pooled.
class SampleNoise {
 public:
  explicit SampleNoise(const Datasheet& datasheet) noexcept : datasheet_(datasheet) {}
  void add(const Station& station, SensorSet used) noexcept {
    if (station.count < 2) return;
    const double freedom = static_cast<double>(station.count) - 1.0;
    for (int i = 0; i < datasheet_.size; ++i) {
      const double noise = station.scatter[at(i)] / datasheet_.sensor[at(i)].coefficients.scale[0];
      if (!used.has(i) || !(noise * noise > 0.0) || !std::isfinite(noise * noise)) continue;
      squares_[at(i)] += freedom * noise * noise;
      freedom_[at(i)] += freedom;
    }
  }
  void write(FitFigures& report) const noexcept {
    for (int i = 0; i < datasheet_.size; ++i) {
      report.sample_noise_mps2[at(i)] = freedom_[at(i)] > 0.0 ? std::sqrt(squares_[at(i)] / freedom_[at(i)]) : 0.0;
    }
  }

 private:
  const Datasheet& datasheet_;
  std::array<double, kCapacity> squares_{}, freedom_{};
};

}  // namespace

bool plainly_sound(const Datasheet& datasheet) noexcept {
  if (datasheet.size < 3 || datasheet.size > kCapacity) return false;
  for (int i = 0; i < datasheet.size; ++i) {
    const SensorRow& row = datasheet.sensor[at(i)].row;
    if (row.id[0] == '\0' || row.id.back() != '\0' || !unit_axis(row.axis)) return false;
    if (!(row.sigma_mps2 >= std::numeric_limits<double>::min()) || !std::isfinite(row.sigma_mps2)) return false;
    for (int k = 0; k < i; ++k) {
      if (datasheet.sensor[at(k)].row.id == row.id) return false;
    }
  }
  return independent(datasheet, SensorSet::first(datasheet.size));
}

void note_stations(const Problem& problem, FitFigures& report) noexcept {
  bool any = false;
  SampleNoise noise(problem.datasheet);
  for (int k = 0; k < problem.count; ++k) {
    const Station& station = problem.stations[k];
    const double t = station.temperature_degc;
    if (station.count == 0) continue;
    const SensorSet given = station.delivered & SensorSet::first(problem.datasheet.size);
    const SensorSet clipped = given - usable_channels(problem.datasheet, station);
    report.clipped += clipped.size();
    report.clipped_sensors = report.clipped_sensors | clipped;
    noise.add(station, given - clipped);
    if (!std::isfinite(t)) continue;
    if (!any || t < report.temperature_min_degc) report.temperature_min_degc = t;
    if (!any || t > report.temperature_max_degc) report.temperature_max_degc = t;
    any = true;
  }
  noise.write(report);
}

double note_loud_sensor(const Problem& problem, const FitTally& tally, FitFigures& report) noexcept {
  const int n = problem.datasheet.size, freedom = tally.freedom(report);
  double excess = 0.0;
  const int highest_variance = tally.highest_variance(n, freedom, excess);
  if (highest_variance < 0 || !(report.p_value < kNoNoise)) return 1.0;
  // Whether or not it can be named: the misfit is a mean over the sensors, and the sensor with the highest variance has
  // more.
  const double factor = std::fmax(tally.variance_factor(highest_variance, n, freedom), 1.0);
  if (!tally.beyond_chance(highest_variance, freedom, excess)) return factor;
  report.high_variance_sensor = highest_variance;
  report.loud_excess = excess;
  const double sigma = problem.datasheet.sensor[at(highest_variance)].row.sigma_mps2;
  double noise = 0.0;
  int stations = 0;
  for (int k = 0; k < problem.count; ++k) {
    if (problem.stations[k].count == 0) continue;
    noise += sigma * sigma / problem.stations[k].count;
    ++stations;
  }
  noise /= stations;  // a sensor has a high variance at stations
  const double common = report.misfit_mps2 * report.misfit_mps2;
  report.loud_misfit_mps2 = std::sqrt(factor * (common + noise) - noise);
  return factor;
}

/// With three sensors a station has one residual, and the fit can bend towards a few stations that err so that the
/// sound ones look it (docs/theory.md, section 9.6). That happens where few degrees of freedom are left.
Error doubtful_screening(const Datasheet& datasheet, const FitFigures& report) noexcept {
  constexpr int kFewFreedom = 24;  // from there on not one fit in 2000 was seen to take the wrong stations
  constexpr int kLeastFreedom = 8;
  constexpr double kDoubtful = 1e-3;  // of the stations that stayed
  if (datasheet.size != 3 || report.outliers == 0 || report.degrees_of_freedom >= kFewFreedom) return Error{};
  const double most = 0.5 * report.degrees_of_freedom;
  if (report.degrees_of_freedom < kLeastFreedom || static_cast<double>(report.outliers) > most) {
    return Error{Errc::poor_fit, -1, static_cast<double>(report.outliers), most};
  }
  if (report.p_value < kDoubtful) return Error{Errc::poor_fit, -1, report.p_value, kDoubtful};
  return Error{};
}

Error noisy_samples(const Datasheet& datasheet, const FitOptions& options, const FitFigures& report) noexcept {
  if (!(report.p_value < kNoNoise)) return Error{};
  Error worst;
  for (int i = 0; i < datasheet.size; ++i) {
    const double factor = report.sample_noise_mps2[at(i)] / datasheet.sensor[at(i)].row.sigma_mps2;
    if (factor > options.max_noise_factor && factor > worst.value) {
      worst = Error{Errc::poor_fit, i, factor, options.max_noise_factor};
    }
  }
  return worst;
}

void note_outliers(const Problem& problem, FitFigures& report, std::array<Outlier, kMaxOutliers>& list) noexcept {
  if (problem.screen == nullptr) return;
  Screening screening(problem);
  for (int k = 0; k < problem.count; ++k) {
    if (!screening.out(problem.stations[k])) continue;
    if (report.outliers < kMaxOutliers) {
      Outlier& outlier = list[at(report.outliers)];
      outlier.station = k;
      outlier.standardised = std::sqrt(screening.solver.chi2);
      outlier.sensor = blamed(screening.solver, outlier.share);
    }
    ++report.outliers;
  }
}

int most_blamed(const Problem& problem) noexcept {
  std::array<double, kCapacity> blame{};
  Screening screening(problem);
  double total = 0.0;
  for (int k = 0; k < problem.count; ++k) {
    if (!screening.out(problem.stations[k])) continue;
    double share = 0.0;
    const int sensor = blamed(screening.solver, share);
    total += 1.0;
    if (sensor >= 0) blame[at(sensor)] += 1.0;
  }
  int most = -1;
  for (int i = 0; i < problem.datasheet.size; ++i) {
    if (2.0 * blame[at(i)] > total) most = i;
  }
  return most;
}

void note_common_scale(const Datasheet& datasheet, const Parameters& theta, FitFigures& report) noexcept {
  const double n = datasheet.size;
  CommonScale out;
  double squares = 0.0, variance = 0.0;
  for (int i = 0; i < datasheet.size; ++i) {
    const double prior = datasheet.sensor[at(i)].prior.scale, change = norm(row_of(theta, i)) - 1.0;
    out.mean += change / n;
    squares += change * change / n;
    variance += prior * prior / (n * n);
  }
  out.scatter = std::sqrt(std::fmax(squares - out.mean * out.mean, 0.0));
  out.sigma = std::sqrt(variance);
  report.common_scale = out;
}

namespace {

/// Squared deviations from the datasheet in prior sigmas, but those of `left_out`.
double prior_chi2(const Datasheet& datasheet, const Parameters& theta, int left_out) noexcept {
  double sum = 0.0;
  for (int i = 0; i < datasheet.size; ++i) {
    if (i == left_out) continue;
    const Deviation d = deviation_of(datasheet, theta, i);
    const Prior& prior = datasheet.sensor[at(i)].prior;
    const std::array<double, 3> value = {d.scale, d.axis_rad, d.bias_mps2};
    const std::array<double, 3> sigma = {prior.scale, prior.axis_rad, prior.bias_mps2};
    for (std::size_t k = 0; k < 3; ++k) {
      if (sigma[k] > 0.0) sum += value[k] * value[k] / (sigma[k] * sigma[k]);
    }
  }
  return sum;
}

/// With every sensor omitted in turn, of either hand: where the others then fit, it is the one.
struct Alone {
  Error error;
  double chi2 = kInfinity;
};

Alone alone(const Datasheet& datasheet, const Roll& roll, const FitOptions& options, const Parameters& theta,
            int i) noexcept {
  Alone out;
  for (const double hand : {1.0, -1.0}) {
    Parameters turned = theta;
    for (int p = 0; p < 4 * datasheet.size; ++p) turned[at(p)] *= p % 4 == 3 ? 1.0 : hand;
    turn_to_datasheet(datasheet, roll, turned, i);
    if (furthest_off(datasheet, options, turned, i).code != Errc::ok) continue;
    const Error own = furthest_off(datasheet, options, turned, -1);
    const double chi2 = prior_chi2(datasheet, turned, i);
    if (own.code == Errc::ok || !(chi2 < out.chi2)) continue;
    out = {own, chi2};
  }
  return out;
}

}  // namespace

Error implausible(const Datasheet& datasheet, const Roll& roll, const FitOptions& options, const Parameters& theta,
                  SensorSet& suspects) noexcept {
  suspects = {};
  const Error worst = furthest_off(datasheet, options, theta, -1);
  if (worst.code == Errc::ok) return worst;
  if (roll.used) {
    const CommonTurn turn = common_turn(datasheet, roll.axis, theta);
    Parameters turned = theta;
    turn_to_datasheet(datasheet, Roll{}, turned);
    const bool all_together = furthest_off(datasheet, options, turned, -1).code == Errc::ok && turn.sensor < 0;
    return all_together ? Error{Errc::implausible, -1, turn.rad, options.max_axis_change_rad} : worst;
  }
  // One axis that is far off (a sign, a swapped channel) turns the frame of all, or mirrors it, which gravity does not
  // show.
  Alone best;
  std::array<double, kCapacity> chi2{};
  for (int i = 0; i < datasheet.size; ++i) {
    const Alone own = alone(datasheet, roll, options, theta, i);
    chi2[at(i)] = own.chi2;
    if (own.chi2 < best.chi2) best = own;
  }
  if (best.error.code == Errc::ok) return worst;
  for (int i = 0; i < datasheet.size; ++i) {
    if (chi2[at(i)] < best.chi2 + kSeparable) suspects = suspects.with(i);
  }
  if (suspects.size() > 1) best.error.index = -1;
  return best.error;
}

namespace {

/// Of the noisiest sensor at each station, by the datasheet; rms over the stations that deliver.
double noise_of_means(const Problem& problem) noexcept {
  double sum = 0.0;
  int used = 0;
  for (int k = 0; k < problem.count; ++k) {
    const auto& station = problem.stations[k];
    double most = 0.0;
    for (int i = 0; i < problem.datasheet.size; ++i) {
      if (station.delivered.has(i)) most = std::fmax(most, problem.datasheet.sensor[at(i)].row.sigma_mps2);
    }
    if (station.count == 0 || most == 0.0) continue;
    sum += most * most / station.count;
    ++used;
  }
  return used > 0 ? std::sqrt(sum / used) : 0.0;
}

}  // namespace

Error judge_figures(const Problem& problem, const FitOptions& options, const Fitted& fitted, FitFigures& r) noexcept {
  r.noise_mps2 = noise_of_means(problem);
  const Error error = implausible(problem.datasheet, problem.roll, options, fitted.theta, r.suspects);
  if (error.code != Errc::ok) return error;
  const double most = options.max_outlier_share * (r.stations + r.outliers);
  if (static_cast<double>(r.outliers) > most) {
    return Error{Errc::poor_fit, most_blamed(problem), static_cast<double>(r.outliers), most};
  }
  const Error doubtful = doubtful_screening(problem.datasheet, r);
  if (doubtful.code != Errc::ok) return doubtful;
  const Error noisy = noisy_samples(problem.datasheet, options, r);
  if (noisy.code != Errc::ok) return noisy;
  double excess = 0.0;
  const int highest_variance = fitted.tally.highest_variance(problem.datasheet.size, fitted.tally.freedom(r), excess);
  // Among few stations chance alone reaches the bound; what suspects none as a whole suspects no single sensor.
  const bool singled_out = excess > options.max_sensor_excess && r.p_value < kSuspicious;
  const double most_rms_mps2 = residual_bound_mps2(options.max_norm_rms_mps2, r);
  if (!(r.norm_rms_mps2 <= most_rms_mps2)) {
    return Error{Errc::poor_fit, singled_out ? highest_variance : -1, r.norm_rms_mps2, most_rms_mps2};
  }
  if (singled_out) return Error{Errc::poor_fit, highest_variance, excess, options.max_sensor_excess};
  return Error{};
}

Error same_numbers(const Problem& problem) noexcept {
  constexpr int kEnough = 3;  // stations; one may be chance where a converter is coarse
  for (int i = 1; i < problem.datasheet.size; ++i) {
    for (int j = 0; j < i; ++j) {
      int seen = 0;
      bool same = true;
      for (int s = 0; s < problem.count && same; ++s) {
        const Station& station = problem.stations[s];
        if (station.count == 0 || !station.delivered.has(i) || !station.delivered.has(j)) continue;
        same = station.mean[at(i)] == station.mean[at(j)];
        ++seen;
      }
      if (same && seen >= kEnough) return Error{Errc::implausible, i, 0.0, 0.0};
    }
  }
  return Error{};
}

Error twin_channels(const Problem& problem) noexcept {
  constexpr double kAlike = 8.0;      // standard deviations of a difference
  constexpr double kParallel = 0.98;  // such axes may read alike
  const Datasheet& datasheet = problem.datasheet;
  const Parameters nominal = datasheet_parameters(datasheet);
  for (int i = 1; i < datasheet.size; ++i) {
    for (int j = 0; j < i; ++j) {
      const SensorRow& a = datasheet.sensor[at(i)].row;
      const SensorRow& b = datasheet.sensor[at(j)].row;
      if (std::fabs(dot(a.axis, b.axis)) > kParallel) continue;
      const double limit = kAlike * std::sqrt(a.sigma_mps2 * a.sigma_mps2 + b.sigma_mps2 * b.sigma_mps2);
      StationSolver solver(problem, nominal, 0.0);
      double first = 0.0, most = 0.0;
      int seen = 0;
      for (int s = 0; s < problem.count && most <= limit; ++s) {
        if (solver.read(problem.stations[s]) != Loaded::used || solver.rows != datasheet.size) continue;
        const double difference = solver.reading[at(i)] - solver.reading[at(j)];
        if (seen++ == 0) first = difference;
        most = std::fmax(most, std::fabs(difference - first));
      }
      if (seen >= 2 && most <= limit) return Error{Errc::implausible, i, most, limit};
    }
  }
  return Error{};
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
