#include <cmath>
#include <string>

#include "log_state.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {
constexpr std::int64_t kLargestCount = 0xFFFFFFFFLL;
/// Copied in place: a temporary would be written and copied for every row.
constexpr Sample kNoSample{};
}  // namespace

/// A column that is the same in all rows of a ULog.
CellKind LogReader::State::text_in(std::size_t column, double& value) const noexcept {
  return parse_cell(binary->header().columns[column].text, value);
}

bool LogReader::State::refuse(std::size_t column, std::string_view what) {
  bad_column = column;
  bad_what = what;
  return false;
}
bool LogReader::State::refuse_cell(std::size_t column, const char* what) {
  return refuse(column, shown(column) + what);
}
bool LogReader::State::refuse_tag(std::size_t column, const char* what) {
  return refuse(column, shown(column) + " is not " + what + " (a whole number, 0 or more; -1 or empty for none)");
}
bool LogReader::State::refuse_time(double time_s) {
  return refuse(time, "time " + shortest(time_s) + " s does not increase (the row before has " +
                          shortest(statistics.last_time_s) + " s)");
}

/// What stands in a cell of the row at hand.
template <bool kBinary>
inline CellKind LogReader::State::number_in(std::size_t column, double& value) const noexcept {
  if constexpr (!kBinary) return parse_cell(cells[column], value);
  const std::size_t place = number_place[column];
  if (place == kNoColumn) return text_in(column, value);
  if (!binary->has(place)) return CellKind::empty;
  value = binary->value(place);
  return CellKind::number;
}

template <bool kBinary>
inline CellKind LogReader::State::whole_in(std::size_t column, std::int64_t& value) const noexcept {
  if constexpr (!kBinary) return parse_whole(cells[column], value);
  double number = 0.0;
  const CellKind kind = number_in<true>(column, number);
  return kind == CellKind::number && !to_whole(number, value) ? CellKind::text : kind;
}

/// A cell for a message.
std::string LogReader::State::shown(std::size_t column) const {
  if (!binary) return in_quotes(cells[column]);
  double value = 0.0;
  if (number_place[column] == kNoColumn) return in_quotes(binary->header().columns[column].text);
  return number_in<true>(column, value) == CellKind::number ? shortest(value) : "an empty cell";
}

template <bool kBinary>
inline bool LogReader::State::fill_time(Sample& sample) {
  if (time == kNoColumn) {
    const auto number = static_cast<double>(index - 1);
    sample.time_s = input.rate_hz > 0.0 ? number / input.rate_hz : number;
    return true;
  }
  double value = 0.0;
  if (number_in<kBinary>(time, value) != CellKind::number) return refuse_cell(time, " is not a time");
  if (!std::isfinite(value)) return refuse(time, "the time is not finite");
  sample.time_s = value * input.time_unit_s;
  if (statistics.rows > 0 && !(sample.time_s > statistics.last_time_s)) return refuse_time(sample.time_s);
  return true;
}

template <bool kBinary>
inline bool LogReader::State::fill_tag(std::size_t column, const char* what, std::uint32_t& tag) {
  if (column == kNoColumn) return true;
  std::int64_t value = 0;
  const CellKind kind = whole_in<kBinary>(column, value);
  const bool fits = kind == CellKind::empty || (kind == CellKind::number && value >= -1 && value < kLargestCount);
  if (!fits) return refuse_tag(column, what);
  tag = kind == CellKind::empty ? 0U : tag_of_label(value);
  return true;
}

template <bool kBinary>
inline bool LogReader::State::fill_tags(Sample& sample) {
  if (!fill_tag<kBinary>(station, "a station number", sample.station)) return false;
  if (!fill_tag<kBinary>(roll_group, "the number of a roll group", sample.roll_group)) return false;
  if (count != kNoColumn) {
    std::int64_t value = 0;
    const bool fits = whole_in<kBinary>(count, value) == CellKind::number && value >= 1 && value <= kLargestCount;
    if (!fits) return refuse_cell(count, " is not a number of samples (a whole number, 1 or more)");
    sample.count = static_cast<std::uint32_t>(value);
  }
  return true;
}

template <bool kBinary>
inline bool LogReader::State::fill_temperature(Sample& sample) {
  sample.temperature_degc = input.default_temperature_degc;
  if (temperature == kNoColumn) return true;
  double value = 0.0;
  const CellKind kind = number_in<kBinary>(temperature, value);
  if (kind == CellKind::text) return refuse_cell(temperature, " is not a temperature");
  if (kind == CellKind::number && std::isfinite(value)) {
    last_temperature_degc = value;
    has_temperature = true;
  } else if (!has_temperature) {
    return refuse(temperature, "neither this row nor a row before it has a temperature");
  } else {
    ++statistics.temperature_held;
  }
  sample.temperature_degc = last_temperature_degc;
  return true;
}

template <bool kBinary>
inline bool LogReader::State::fill_rotation(const std::vector<std::size_t>& columns, Rotation& out) {
  out = Rotation{};
  if (columns.empty()) return true;
  out.rate_known = true;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    double value = 0.0;
    const CellKind kind = number_in<kBinary>(columns[k], value);
    if (kind == CellKind::text) return refuse_cell(columns[k], " is not a rate of rotation");
    if (kind != CellKind::number || !std::isfinite(value)) {
      out = Rotation{true, false, {}};
      return true;
    }
    out.rate_radps[k] = value;
    out.turning = out.turning || value != 0.0;
  }
  return true;
}

/// An empty cell or nan is a chip that has delivered nothing new, and no fault of the row.
template <bool kBinary>
inline bool LogReader::State::fill_clocks() {
  for (std::size_t c = 0; c < clocks.size(); ++c) {
    double value = 0.0;
    const CellKind kind = number_in<kBinary>(clocks[c], value);
    if (kind == CellKind::text) return refuse_cell(clocks[c], " is not a time");
    if (kind == CellKind::number && std::isinf(value)) return refuse(clocks[c], "the time is not finite");
    clock_s[c] = kind == CellKind::number ? value * input.time_unit_s : std::nan("");
  }
  return true;
}

template <bool kBinary>
inline bool LogReader::State::fill_depth() {
  depth_m = std::nan("");
  if (depth == kNoColumn) return true;
  double value = 0.0;
  const CellKind kind = number_in<kBinary>(depth, value);
  if (kind == CellKind::text) return refuse_cell(depth, " is not a depth");
  if (kind == CellKind::number && std::isfinite(value)) depth_m = value * input.depth_unit_m;
  return true;
}

/// What becomes of the values of a good row for the statistics.
void LogReader::State::count_each(const Sample& sample) noexcept {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::uint32_t bit = 1U << static_cast<unsigned>(i);
    const double value = sample.raw[i];
    if ((sample.delivered.bits & bit) == 0) {
      ++statistics.missing[i];
    } else if (!std::isfinite(value)) {
      ++statistics.not_finite[i];
    } else if ((seen.bits & bit) == 0) {
      seen.bits |= bit;
      statistics.first_value[i] = value;
    } else if (value != statistics.first_value[i]) {
      statistics.varied.bits |= bit;
    }
  }
}

/// Once every sensor has shown two values, a row of finite ones has nothing to add.
inline void LogReader::State::count_values(const Sample& sample) noexcept {
  const SensorSet all = SensorSet::first(static_cast<int>(sensors.size()));
  double nothing = 0.0;  // 0 of what is finite, else NaN
  for (std::size_t i = 0; i < sensors.size(); ++i) nothing += 0.0 * sample.raw[i];
  if (nothing == 0.0 && sample.delivered == all && statistics.varied == all) return;
  count_each(sample);
}

template <bool kBinary>
inline bool LogReader::State::fill_sensors(Sample& sample) {
  if (kBinary && !sensor_place.empty() && binary->has_all(sensor_marks)) {
    for (std::size_t i = 0; i < sensor_place.size(); ++i) sample.raw[i] = binary->value(sensor_place[i]);
    sample.delivered = SensorSet::first(static_cast<int>(sensor_place.size()));
    count_values(sample);
    return true;
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    double value = 0.0;
    switch (number_in<kBinary>(sensors[i], value)) {
      case CellKind::number:
        sample.raw[i] = value;
        sample.delivered.bits |= 1U << static_cast<unsigned>(i);
        break;
      case CellKind::empty: break;
      case CellKind::text: return refuse_cell(sensors[i], " is not a number");
    }
  }
  count_values(sample);  // only now that the row is known to be good
  return true;
}

template <bool kBinary>
bool LogReader::State::fill_row(Sample& sample) {
  sample = kNoSample;
  return fill_time<kBinary>(sample) && fill_tags<kBinary>(sample) && fill_temperature<kBinary>(sample) &&
         fill_rotation<kBinary>(rates, rotation) && fill_rotation<kBinary>(second_rates, second_rotation) &&
         fill_clocks<kBinary>() && fill_depth<kBinary>() && fill_sensors<kBinary>(sample);
}
template bool LogReader::State::fill_row<true>(Sample& sample);
template bool LogReader::State::fill_row<false>(Sample& sample);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
