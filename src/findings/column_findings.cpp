#include "plumb/findings/column_findings.hpp"

#include <algorithm>

#include "plumb/findings/dead_channel.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

constexpr double kKelvinOfZeroDegc = 273.15;
/// As kelvin these are -23 to 127 degC; as degC hardly anything that can be calibrated by hand.
constexpr double kLeastKelvin = 250.0, kMostKelvin = 400.0;
/// Values of `MonitorConfig` that stand for "not given".
constexpr double kNoBound_degc = 1e8;

double as_figure(std::uint64_t rows) { return static_cast<double>(rows); }

std::optional<Finding> sensor_column(const CalibrationRun& run, int i) {
  const auto a = static_cast<std::size_t>(i);
  const std::uint64_t missing = run.log.missing[a], not_finite = run.log.not_finite[a], rows = run.log.rows;
  Finding out{FindingCode::column_constant, i, as_figure(missing + not_finite), as_figure(rows)};
  if (dead_channel(run.log, i) && missing + not_finite < rows) return out;
  if (missing + not_finite == 0) return {};
  out.code = not_finite == 0 ? FindingCode::column_empty
             : missing == 0  ? FindingCode::column_not_finite
                             : FindingCode::column_empty_or_not_finite;
  return out;
}

bool without_roll_groups(const CalibrationRun& run, const io::ArrayFile& array) {
  const auto grouped = [](const Station& s) { return s.roll_group != 0; };
  if (array.input.roll_group_column.empty() || run.stations.empty()) return false;
  return std::none_of(run.stations.begin(), run.stations.end(), grouped);
}

template <class Change>
bool all_within(const std::vector<Station>& stations, double least, double most, Change change) {
  return std::all_of(stations.begin(), stations.end(), [&](const Station& s) {
    const double degc = change(s.temperature_degc);
    return degc >= least - kLevelMargin_degc && degc <= most + kLevelMargin_degc;
  });
}

double from_kelvin(double t) { return t - kKelvinOfZeroDegc; }
double from_fahrenheit(double t) { return (t - 32.0) / 1.8; }

}  // namespace

std::vector<Finding> column_findings(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<Finding> out;
  for (int i = 0; i < array.array.size(); ++i) {
    if (const std::optional<Finding> found = sensor_column(run, i)) out.push_back(*found);
  }
  const double rows = as_figure(run.log.rows);
  if (!array.input.temperature_column.empty() && run.log.temperature_held > 0)
    out.push_back({FindingCode::temperature_column_gaps, -1, as_figure(run.log.temperature_held), rows});
  if (without_roll_groups(run, array)) out.push_back({FindingCode::roll_group_column_empty, -1, rows, rows});
  return out;
}

std::optional<Finding> temperature_unit(const CalibrationRun& run, const io::ArrayFile& array) {
  const std::vector<Station>& stations = run.stations;
  if (array.input.temperature_column.empty() || stations.empty()) return {};
  const auto [low, high] =
      std::minmax_element(stations.begin(), stations.end(),
                          [](const Station& a, const Station& b) { return a.temperature_degc < b.temperature_degc; });
  Finding out{FindingCode::temperature_in_kelvin, -1, low->temperature_degc, high->temperature_degc};
  const double from = array.monitor.temperature_min_degc, to = array.monitor.temperature_max_degc;
  if (from > -kNoBound_degc && to < kNoBound_degc &&
      (out.value > to + kLevelMargin_degc || out.limit < from - kLevelMargin_degc)) {
    out.code = all_within(stations, from, to, from_kelvin)       ? FindingCode::claimed_temperature_in_kelvin
               : all_within(stations, from, to, from_fahrenheit) ? FindingCode::claimed_temperature_in_fahrenheit
                                                                 : FindingCode::claimed_temperature_in_another_unit;
    return out;
  }
  if (out.value < kLeastKelvin || out.limit > kMostKelvin) return {};
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
