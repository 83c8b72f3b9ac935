#include "fit_report.hpp"

#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

void note_stations(const Problem& problem, FitReport& report) noexcept {
  bool any = false;
  for (int k = 0; k < problem.count; ++k) {
    const Station& station = problem.stations[k];
    const double t = station.temperature_degc;
    if (station.count == 0) continue;
    const SensorSet given = station.delivered & SensorSet::first(problem.datasheet.size);
    const SensorSet clipped = given - usable_channels(problem.datasheet, station);
    report.clipped += clipped.size();
    report.clipped_sensors = report.clipped_sensors | clipped;
    if (!std::isfinite(t)) continue;
    if (!any || t < report.temperature_min_degc) report.temperature_min_degc = t;
    if (!any || t > report.temperature_max_degc) report.temperature_max_degc = t;
    any = true;
  }
}

void note_outliers(const Problem& problem, FitReport& report) noexcept {
  if (problem.screen == nullptr) return;
  Screening screening(problem);
  for (int k = 0; k < problem.count; ++k) {
    if (!screening.out(problem.stations[k])) continue;
    if (report.outliers < kMaxOutliers) {
      Outlier& outlier = report.outlier[at(report.outliers)];
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

void note_common_scale(const Datasheet& datasheet, const Parameters& theta, FitReport& report) noexcept {
  const double n = datasheet.size;
  double variance = 0.0;
  for (int i = 0; i < datasheet.size; ++i) {
    const double prior = datasheet.sensor[at(i)].prior.scale;
    report.common_scale += (norm(row_of(theta, i)) - 1.0) / n;
    variance += prior * prior / (n * n);
  }
  report.common_scale_sigma = std::sqrt(variance);
}

Error implausible(const Datasheet& datasheet, const Roll& roll, const FitOptions& options,
                  const Parameters& theta) noexcept {
  const Error worst = furthest_off(datasheet, options, theta, -1);
  if (worst.code == Errc::ok || roll.used) return worst;
  // One axis that is far off (a sign, a swapped channel) turns the frame of all, or mirrors it, which gravity does not
  // show. Leave each out in turn: where the others then fit, it is the one.
  for (int k = 0; k < 2 * datasheet.size; ++k) {
    const int i = k / 2;
    Parameters turned = theta;
    for (int p = 0; p < 4 * datasheet.size && k % 2 == 1; ++p) turned[at(p)] *= p % 4 == 3 ? 1.0 : -1.0;
    turn_to_datasheet(datasheet, roll, turned, i);
    if (furthest_off(datasheet, options, turned, i).code != Errc::ok) continue;
    const Error alone = furthest_off(datasheet, options, turned, -1);
    if (alone.code != Errc::ok) return alone;
  }
  return worst;
}

Error judge_figures(const Problem& problem, const FitOptions& options, const Fitted& fitted,
                    const FitReport& r) noexcept {
  const Error error = implausible(problem.datasheet, problem.roll, options, fitted.theta);
  if (error.code != Errc::ok) return error;
  const double most = options.max_outlier_share * (r.stations + r.outliers);
  if (static_cast<double>(r.outliers) > most) {
    return Error{Errc::poor_fit, most_blamed(problem), static_cast<double>(r.outliers), most};
  }
  double excess = 0.0;
  const int loudest = fitted.tally.loudest(problem.datasheet.size, r.degrees_of_freedom, excess);
  const bool singled_out = excess > options.max_sensor_excess;
  if (!(r.norm_rms_mps2 <= options.max_norm_rms_mps2)) {
    return Error{Errc::poor_fit, singled_out ? loudest : -1, r.norm_rms_mps2, options.max_norm_rms_mps2};
  }
  if (singled_out) return Error{Errc::poor_fit, loudest, excess, options.max_sensor_excess};
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
