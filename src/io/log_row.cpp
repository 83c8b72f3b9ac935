#include <cmath>
#include <string>

#include "log_state.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {
constexpr std::int64_t kLargestCount = 0xFFFFFFFFLL;
}  // namespace

bool LogReader::State::fill_time(Sample& sample) {
  if (time == kNoColumn) {
    const auto number = static_cast<double>(index - 1);
    sample.time_s = input.rate_hz > 0.0 ? number / input.rate_hz : number;
    return true;
  }
  double value = 0.0;
  if (parse_cell(cells[time], value) != CellKind::number)
    return refuse(time, in_quotes(cells[time]) + " is not a time");
  if (!std::isfinite(value)) return refuse(time, "the time is not finite");
  sample.time_s = value * input.time_unit_s;
  if (statistics.rows > 0 && !(sample.time_s > statistics.last_time_s)) {
    return refuse(time, "time " + shortest(sample.time_s) + " s does not increase (the row before has " +
                            shortest(statistics.last_time_s) + " s)");
  }
  return true;
}

bool LogReader::State::fill_tag(std::size_t column, const char* what, std::uint32_t& tag) {
  if (column == kNoColumn) return true;
  std::int64_t value = 0;
  const CellKind kind = parse_whole(cells[column], value);
  const bool fits = kind == CellKind::empty || (kind == CellKind::number && value >= -1 && value < kLargestCount);
  if (!fits)
    return refuse(column,
                  in_quotes(cells[column]) + " is not " + what + " (a whole number from 0 up, -1 or empty for none)");
  tag = kind == CellKind::empty ? 0U : tag_of_label(value);
  return true;
}

bool LogReader::State::fill_tags(Sample& sample) {
  if (!fill_tag(station, "a station number", sample.station)) return false;
  if (!fill_tag(roll_group, "the number of a roll group", sample.roll_group)) return false;
  if (count != kNoColumn) {
    std::int64_t value = 0;
    const bool fits = parse_whole(cells[count], value) == CellKind::number && value >= 1 && value <= kLargestCount;
    if (!fits) return refuse(count, in_quotes(cells[count]) + " is not a number of samples (a whole number from 1 up)");
    sample.count = static_cast<std::uint32_t>(value);
  }
  return true;
}

bool LogReader::State::fill_temperature(Sample& sample) {
  sample.temperature_degc = input.default_temperature_degc;
  if (temperature == kNoColumn) return true;
  double value = 0.0;
  const CellKind kind = parse_cell(cells[temperature], value);
  if (kind == CellKind::text) return refuse(temperature, in_quotes(cells[temperature]) + " is not a temperature");
  if (kind == CellKind::number && std::isfinite(value)) {
    last_temperature_degc = value;
    has_temperature = true;
  } else if (!has_temperature) {
    return refuse(temperature, "there is no temperature yet in this row or before it");
  } else {
    ++statistics.temperature_held;
  }
  sample.temperature_degc = last_temperature_degc;
  return true;
}

bool LogReader::State::fill_rotation() {
  rotation = Rotation{};
  if (rates.empty()) return true;
  rotation.rate_known = true;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    double value = 0.0;
    const CellKind kind = parse_cell(cells[rates[k]], value);
    if (kind == CellKind::text) return refuse(rates[k], in_quotes(cells[rates[k]]) + " is not a rate of turn");
    if (kind != CellKind::number || !std::isfinite(value)) {
      rotation = Rotation{true, false, {}};
      return true;
    }
    rotation.rate_radps[k] = value;
    rotation.turning = rotation.turning || value != 0.0;
  }
  return true;
}

bool LogReader::State::fill_depth() {
  depth_m = std::nan("");
  if (depth == kNoColumn) return true;
  double value = 0.0;
  const CellKind kind = parse_cell(cells[depth], value);
  if (kind == CellKind::text) return refuse(depth, in_quotes(cells[depth]) + " is not a depth");
  if (kind == CellKind::number && std::isfinite(value)) depth_m = value * input.depth_unit_m;
  return true;
}

bool LogReader::State::fill_sensors(Sample& sample) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    double value = 0.0;
    const std::string_view cell = cells[sensors[i]];
    switch (parse_cell(cell, value)) {
      case CellKind::number:
        sample.raw[i] = value;
        sample.delivered.bits |= 1U << static_cast<unsigned>(i);
        break;
      case CellKind::empty: break;
      case CellKind::text: return refuse(sensors[i], in_quotes(cell) + " is not a number");
    }
  }
  // Counted only now that the row is known to be good.
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (!sample.delivered.has(static_cast<int>(i))) {
      ++statistics.missing[i];
    } else if (!std::isfinite(sample.raw[i])) {
      ++statistics.not_finite[i];
    } else {
      note_value(i, sample.raw[i]);
    }
  }
  return true;
}

void LogReader::State::note_value(std::size_t sensor, double value) {
  const bool first = statistics.missing[sensor] + statistics.not_finite[sensor] == statistics.rows;
  if (first) statistics.first_value[sensor] = value;
  if (value != statistics.first_value[sensor]) statistics.varied.bits |= 1U << static_cast<unsigned>(sensor);
}

bool LogReader::State::fill(Sample& sample) {
  sample = Sample();
  return fill_time(sample) && fill_tags(sample) && fill_temperature(sample) && fill_rotation() && fill_depth() &&
         fill_sensors(sample);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
