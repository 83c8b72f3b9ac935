#include "column_facts.hpp"

#include <fmt/format.h>
#include <cmath>

#include <algorithm>

#include "plumb/calibration/temperature_fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr double kKelvinOfZeroDegc = 273.15;
/// As kelvin these are -23 to 127 degC; as degC hardly anything that can be calibrated by hand.
constexpr double kLeastKelvin = 250.0, kMostKelvin = 400.0;
/// Values of `MonitorConfig` that stand for "not given".
constexpr double kNoBound_degc = 1e8;

std::string in_rows(std::uint64_t without, std::uint64_t rows) {
  if (without == rows) return fmt::format("all {} rows", rows);
  const double percent = 100.0 * static_cast<double>(without) / static_cast<double>(rows);
  return fmt::format("{} of {} rows ({:.3g} %)", without, rows, percent);
}

std::optional<ColumnFact> sensor_fact(const CalibrationRun& run, const io::ArrayFile& array, int i) {
  const auto a = static_cast<std::size_t>(i);
  ColumnFact out{array.input.sensor_columns[a],
                 id_of(array, i),
                 run.log.missing[a] + run.log.not_finite[a],
                 run.log.rows,
                 dead_channel(run.log, i),
                 ""};
  const std::string name = fmt::format("`{}` ({})", out.column, out.of);
  if (out.dead && out.rows_without < out.rows) {
    out.words = fmt::format("{} reads {:.6g} in every row{}", name, run.log.first_value[a],
                            out.rows_without > 0 ? " that has a number" : "");
    return out;
  }
  if (out.rows_without == 0) return {};
  if (run.log.not_finite[a] == 0) {
    out.words = fmt::format("{} is empty in {}", name, in_rows(out.rows_without, out.rows));
  } else if (run.log.missing[a] == 0) {
    out.words = fmt::format("{} is nan or inf in {}", name, in_rows(out.rows_without, out.rows));
  } else {
    out.words = fmt::format("{} is empty, nan or inf in {}", name, in_rows(out.rows_without, out.rows));
  }
  return out;
}

std::optional<ColumnFact> temperature_fact(const CalibrationRun& run, const io::ArrayFile& array) {
  if (array.input.temperature_column.empty() || run.log.temperature_held == 0) return {};
  ColumnFact out{array.input.temperature_column, "temperature", run.log.temperature_held, run.log.rows, false, ""};
  out.words = fmt::format("`{}` (temperature) is empty in {}, which took the one before", out.column,
                          in_rows(out.rows_without, out.rows));
  if (run.without_temperature > 0) {
    out.words += fmt::format(
        "; {} station{} left out, having none of {} own while those before and after differ by more than {:g} degC or "
        "none follows",
        run.without_temperature, run.without_temperature == 1 ? " is" : "s are",
        run.without_temperature == 1 ? "its" : "their", kLevelMargin_degc);
  }
  return out;
}

std::optional<ColumnFact> roll_group_fact(const CalibrationRun& run, const io::ArrayFile& array) {
  const auto grouped = [](const Station& s) { return s.roll_group != 0; };
  if (array.input.roll_group_column.empty() || run.stations.empty()) return {};
  if (std::any_of(run.stations.begin(), run.stations.end(), grouped)) return {};
  ColumnFact out{array.input.roll_group_column, "roll_group", run.log.rows, run.log.rows, false, ""};
  out.words = fmt::format(
      "`{}` (roll_group) is empty or -1 at all {} stations, so nothing says which of them share an inclination: number "
      "the groups from 0 up, or take `roll_group` out of the array file",
      out.column, run.stations.size());
  return out;
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

io::LogStatistics statistics_of(const std::vector<Sample>& samples, int sensors) {
  io::LogStatistics log;
  for (const Sample& sample : samples) {
    for (int i = 0; i < sensors; ++i) {
      const auto a = static_cast<std::size_t>(i);
      const double value = sample.raw[a];
      if (!sample.delivered.has(i)) {
        ++log.missing[a];
      } else if (!std::isfinite(value)) {
        ++log.not_finite[a];
      } else {
        if (log.missing[a] + log.not_finite[a] == log.rows) log.first_value[a] = value;
        if (value != log.first_value[a]) log.varied = log.varied.with(i);
      }
    }
    ++log.rows;
  }
  return log;
}

bool dead_channel(const io::LogStatistics& log, int sensor) {
  const auto a = static_cast<std::size_t>(sensor);
  const std::uint64_t told = log.rows - log.missing[a] - log.not_finite[a];
  return log.rows > 1 && (told == 0 || (told > 1 && !log.varied.has(sensor)));
}

std::vector<ColumnFact> column_facts(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<ColumnFact> out;
  const auto take = [&out](std::optional<ColumnFact> fact) {
    if (fact) out.push_back(*std::move(fact));
  };
  for (int i = 0; i < array.array.size(); ++i) take(sensor_fact(run, array, i));
  take(temperature_fact(run, array));
  take(roll_group_fact(run, array));
  return out;
}

std::optional<Refusal> column_refusal(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> words, ids;
  for (const ColumnFact& fact : column_facts(run, array)) {
    if (!fact.dead) continue;
    words.push_back(fact.words);
    ids.push_back(fact.of);
  }
  if (words.empty()) return {};
  return Refusal{"the column " + listed(words),
                 fmt::format("look at `column` of {} in the array file and at how the log was written; a sensor that "
                             "is not there belongs out of the array file",
                             listed(ids))};
}

std::string temperature_unit_words(const CalibrationRun& run, const io::ArrayFile& array) {
  const std::vector<Station>& stations = run.stations;
  if (array.input.temperature_column.empty() || stations.empty()) return "";
  const auto [low, high] =
      std::minmax_element(stations.begin(), stations.end(),
                          [](const Station& a, const Station& b) { return a.temperature_degc < b.temperature_degc; });
  const double least = low->temperature_degc, most = high->temperature_degc;
  const std::string name = fmt::format("`{}` reads {:.4g} to {:.4g}", array.input.temperature_column, least, most);
  const double from = array.monitor.temperature_min_degc, to = array.monitor.temperature_max_degc;
  if (from > -kNoBound_degc && to < kNoBound_degc &&
      (least > to + kLevelMargin_degc || most < from - kLevelMargin_degc)) {
    const bool kelvin = all_within(stations, from, to, from_kelvin);
    const bool fahrenheit = all_within(stations, from, to, from_fahrenheit);
    return fmt::format("{}, and the array file claims {:.4g} to {:.4g} degC{}", name, from, to,
                       kelvin       ? ": is it in kelvin? The column must be in degC, subtract 273.15"
                       : fahrenheit ? ": is it in degF? The column must be in degC, (T - 32) / 1.8"
                                    : ": is it in another unit than degC?");
  }
  if (least < kLeastKelvin || most > kMostKelvin) return "";
  return name + ": is it in kelvin? The column must be in degC, subtract 273.15";
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
