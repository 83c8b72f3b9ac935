#include "fit_report.hpp"

#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {
namespace {

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

/// Written so that a NaN is beyond every bound.
Error implausible(const Datasheet& datasheet, const FitOptions& options, const Parameters& theta) noexcept {
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

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
