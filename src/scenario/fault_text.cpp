#include "plumb/scenario/fault_text.hpp"

#include <cmath>
#include <utility>

#include "quantity_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

using Text = std::string_view;
template <class T>
using Result = tl::expected<T, std::string>;

tl::unexpected<std::string> refuse(std::string why) { return tl::unexpected<std::string>(std::move(why)); }

std::string quoted(Text text) { return "'" + std::string(text) + "'"; }

Text trimmed(Text text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

const DatasheetSensor& sensor_of(const FaultContext& context, int i) {
  return context.datasheet.sensor[static_cast<std::size_t>(i)];
}

std::string id_of(const FaultContext& context, int i) {
  std::string id;
  for (const char c : sensor_of(context, i).row.id) {
    if (c == '\0') break;
    id += c;
  }
  return id;
}

int sensor_named(const FaultContext& context, Text name) {
  for (int i = 0; i < context.datasheet.size; ++i) {
    if (id_of(context, i) == name) return i;
  }
  return -1;
}

Result<int> find_sensor(const FaultContext& context, Text text) {
  int found = sensor_named(context, text);
  if (found < 0) found = sensor_named(context, trimmed(text));
  if (found >= 0) return found;
  const auto number = read_number(text);
  if (number && number->rest.empty()) {
    const double i = number->value;
    if (i >= 1.0 && i <= context.datasheet.size && std::floor(i) == i) return static_cast<int>(i) - 1;
  }
  std::string known;
  for (int i = 0; i < context.datasheet.size; ++i) known += (i == 0 ? "" : ", ") + id_of(context, i);
  return refuse("no sensor " + quoted(trimmed(text)) + ". Remedy: name one of " + known);
}

/// Units for levels in the log's own unit; that unit itself comes first, with the factor 1.
TextUnits level_units(const FaultContext& context, int sensor) {
  TextUnits units = {{context.raw_unit, 1.0}};
  switch (context.raw) {
    case FaultContext::Raw::voltage:
      for (const auto& [name, volt] : {std::pair<const char*, double>{"V", 1.0}, {"mV", 1e-3}, {"uV", 1e-6}}) {
        units.push_back({name, volt / context.base_per_raw});
      }
      break;
    case FaultContext::Raw::count: units.push_back({"count", 1.0 / context.base_per_raw}); break;
    case FaultContext::Raw::acceleration:
      for (const TextUnit& unit : acceleration_units()) {
        units.push_back({unit.name, unit.factor / context.base_per_raw, unit.print});
      }
      break;
  }
  if (sensor_of(context, sensor).resolution_raw > 0.0) {
    units.push_back({"LSB", sensor_of(context, sensor).resolution_raw, false});
  }
  return units;
}

/// A level: in raw units, as full scale, or as the acceleration that the sensor would seem to read by its
/// datasheet at the calibration temperature (in the sense in which it counts).
Result<double> read_level(const FaultContext& context, int sensor, Text text) {
  const DatasheetSensor& sheet = sensor_of(context, sensor);
  const bool negative = !text.empty() && text.front() == '-';
  const Text unsigned_text = negative || (!text.empty() && text.front() == '+') ? text.substr(1) : text;
  if (unsigned_text == "FS") {
    if (sheet.full_scale_raw > 0.0) return negative ? -sheet.full_scale_raw : sheet.full_scale_raw;
    return refuse("the full scale of " + id_of(context, sensor) +
                  " is not known. Remedy: give the level with its unit, or full_scale in the array file");
  }
  auto level = read_quantity(text, level_units(context, sensor), "level");
  if (level || context.raw == FaultContext::Raw::acceleration) return level;
  const auto acceleration = read_quantity(text, acceleration_units(), "level");
  if (!acceleration) return refuse(level.error() + ", as FS for full scale, or as an acceleration (1g0)");
  const SensorCoefficients& nominal = sheet.coefficients;
  return nominal.scale[0] * (*acceleration + nominal.bias[0]);
}

Result<double> read_dither(const FaultContext& context, int sensor, Text text) {
  return read_quantity(text, level_units(context, sensor), "dither");
}

/// "-3V..3V"; the first unit may be left out where it is the same.
Result<Fault> read_range(const FaultContext& context, Fault fault, Text text) {
  const std::size_t dots = text.find("..");
  if (dots == Text::npos) {
    return refuse(quoted(text) + " is not a range. Remedy: give both ends, as in -3V..3V");
  }
  const Text low_text = trimmed(text.substr(0, dots));
  const Text high_text = trimmed(text.substr(dots + 2));
  const auto high = read_level(context, fault.sensor, high_text);
  if (!high) return tl::unexpected<std::string>(high.error());
  std::string completed(low_text);
  const auto bare = read_number(low_text);
  if (bare && bare->rest.empty()) {
    const auto with_unit = read_number(high_text);
    if (with_unit) completed += std::string(with_unit->rest);
  }
  const auto low = read_level(context, fault.sensor, completed);
  if (!low) return tl::unexpected<std::string>(low.error());
  fault.magnitude = *low;
  fault.upper = *high;
  return fault;
}

Result<double> read_factor(Text text) {
  const auto number = read_number(text);
  if (!number) return tl::unexpected<std::string>(number.error());
  if (number->rest.empty()) return number->value;
  return refuse(quoted(text) + " is not a plain factor. Remedy: write it without a unit, as in scale=1.1");
}

/// Reads what stands behind the '='.
Result<Fault> read_size(const FaultContext& context, Fault fault, bool given, Text text) {
  Result<double> size = 0.0;
  if (fault.kind == FaultKind::stuck_last && !given) return fault;
  if (!given || text.empty()) {
    return refuse("a fault of kind " + quoted(to_string(fault.kind)) +
                  " needs a size. Remedy: write it as in stuck=0V, random=-3V..3V, bias=50mg0, drift=1mg0/s or "
                  "scale=1.1");
  }
  switch (fault.kind) {
    case FaultKind::stuck_level: size = read_level(context, fault.sensor, text); break;
    case FaultKind::stuck_last: size = read_dither(context, fault.sensor, text); break;
    case FaultKind::random_range:
    case FaultKind::random_level: return read_range(context, fault, text);
    case FaultKind::bias_step: size = read_quantity(text, acceleration_units(), "bias"); break;
    case FaultKind::drift: size = read_quantity(text, drift_units(), "drift"); break;
    case FaultKind::scale_change: size = read_factor(text); break;
  }
  if (!size) return tl::unexpected<std::string>(size.error());
  fault.magnitude = *size;
  return fault;
}

struct When {
  Clock clock = Clock::time;
  double value = 0.0;
};

Result<When> read_when(Text text) {
  constexpr Text kStation = "station";
  const bool row = text.substr(0, 1) == "#";
  const bool station = text.substr(0, kStation.size()) == kStation;
  if (row || station) {
    const auto number = read_number(text.substr(row ? 1 : kStation.size()));
    if (number && number->rest.empty()) return When{row ? Clock::row : Clock::station, number->value};
    return refuse(quoted(text) + " is not a row or station. Remedy: write #5 or station6, the first is 1");
  }
  const auto time = read_quantity(text, time_units(), "time");
  if (time) return When{Clock::time, *time};
  return refuse(time.error() + "; or #5 for a row, station6 for a station");
}

/// Position of the '+' that begins the duration; a '+' of an exponent does not count.
std::size_t duration_sign(Text text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    const bool exponent = text[i - 1] == 'e' && i >= 2 && text[i - 2] >= '0' && text[i - 2] <= '9';
    if (text[i] == '+' && !exponent) return i;
  }
  return Text::npos;
}

Result<Fault> read_times(Fault fault, Text text) {
  const std::size_t sign = duration_sign(text);
  const auto onset = read_when(trimmed(text.substr(0, sign)));
  if (!onset) return refuse("onset: " + onset.error());
  fault.clock = onset->clock;
  fault.onset = onset->value;
  if (sign == Text::npos) return fault;
  const auto duration = read_when(trimmed(text.substr(sign + 1)));
  if (!duration) return refuse("duration: " + duration.error());
  if (duration->clock != fault.clock) {
    return refuse("onset and duration in " + quoted(text) +
                  " are counted differently. Remedy: write both as times, both as rows (#5+#10) or both as stations");
  }
  fault.duration = duration->value;
  return fault;
}

Result<Fault> read_kind(Fault fault, Text text) {
  std::string known;
  for (int k = 0; k < kFaultKinds; ++k) {
    fault.kind = static_cast<FaultKind>(k);
    if (text == to_string(fault.kind)) return fault;
    known += (k == 0 ? "" : ", ") + std::string(to_string(fault.kind));
  }
  return refuse("unknown kind of fault " + quoted(text) + ". Remedy: write one of " + known);
}

Result<Fault> parse(Text text, const FaultContext& context) {
  const std::size_t at = text.rfind('@');
  if (at == Text::npos) return refuse("no onset. Remedy: say when the fault begins, as in a2:stuck=0V@12s");
  const Text head = text.substr(0, at);
  const std::size_t colon = head.rfind(':');
  if (colon == Text::npos) return refuse("no sensor. Remedy: begin with it, as in a2:stuck=0V@12s");

  Fault fault;
  const auto sensor = find_sensor(context, head.substr(0, colon));
  if (!sensor) return tl::unexpected<std::string>(sensor.error());
  fault.sensor = *sensor;
  const Text body = head.substr(colon + 1);
  const std::size_t equals = body.find('=');
  const bool given = equals != Text::npos;
  const Text size = given ? trimmed(body.substr(equals + 1)) : Text();
  auto result = read_kind(fault, trimmed(body.substr(0, equals)));
  if (result) result = read_size(context, *result, given, size);
  if (result) result = read_times(*result, trimmed(text.substr(at + 1)));
  if (!result) return result;
  const auto checked = check(*result, context.datasheet.size);
  if (!checked) return tl::unexpected<std::string>(checked.error());
  return result;
}

/// "12s", "#5", "station6"; for a sentence "12 s", "5", "6".
std::string when_text(Clock clock, double value, bool sentence) {
  if (clock == Clock::time) return quantity_text(value, time_units(), sentence ? " " : "");
  if (sentence) return shortest_text(value);
  return (clock == Clock::row ? "#" : "station") + shortest_text(value);
}

std::string level_text(const FaultContext& context, int sensor, double raw, const char* gap) {
  return quantity_text(raw, level_units(context, sensor), gap);
}

std::string size_text(const Fault& fault, const FaultContext& context, const char* gap, const char* between) {
  switch (fault.kind) {
    case FaultKind::stuck_last:
    case FaultKind::stuck_level: return level_text(context, fault.sensor, fault.magnitude, gap);
    case FaultKind::random_range:
    case FaultKind::random_level:
      return level_text(context, fault.sensor, fault.magnitude, gap) + between +
             level_text(context, fault.sensor, fault.upper, gap);
    case FaultKind::bias_step: return quantity_text(fault.magnitude, acceleration_units(), gap);
    case FaultKind::drift: return quantity_text(fault.magnitude, drift_units(), gap);
    case FaultKind::scale_change: break;
  }
  return shortest_text(fault.magnitude);
}

std::string happening(const Fault& fault, const FaultContext& context) {
  const std::string size = size_text(fault, context, " ", " to ");
  switch (fault.kind) {
    case FaultKind::stuck_level: return "stands at " + size;
    case FaultKind::stuck_last:
      return "stands at its last value" + (fault.magnitude > 0.0 ? " with a dither of +-" + size : std::string());
    case FaultKind::random_range: return "delivers random values from " + size + ", new in every row";
    case FaultKind::random_level: return "stands at a random value from " + size;
    case FaultKind::bias_step: return "reads " + size + " too much";
    case FaultKind::drift: return "drifts by " + size;
    case FaultKind::scale_change: break;
  }
  return "has its scale factor multiplied by " + size;
}

}  // namespace

tl::expected<Fault, std::string> parse_fault(std::string_view text, const FaultContext& context) {
  auto fault = parse(text, context);
  if (!fault) return refuse("fault " + quoted(text) + ": " + fault.error());
  return fault;
}

std::string to_text(const Fault& fault, const FaultContext& context) {
  std::string text = id_of(context, fault.sensor) + ":" + to_string(fault.kind);
  if (fault.kind != FaultKind::stuck_last || fault.magnitude > 0.0) text += "=" + size_text(fault, context, "", "..");
  text += "@" + when_text(fault.clock, fault.onset, false);
  if (std::isfinite(fault.duration)) text += "+" + when_text(fault.clock, fault.duration, false);
  return text;
}

std::string describe_effect(const Fault& fault, const FaultContext& context) {
  return id_of(context, fault.sensor) + " " + happening(fault, context);
}

std::string describe(const Fault& fault, const FaultContext& context) {
  static constexpr const char* kFrom[] = {"t = ", "row ", "station "};
  static constexpr const char* kUnit[] = {"", " rows", " stations"};
  const auto clock = static_cast<std::size_t>(fault.clock);
  std::string text =
      describe_effect(fault, context) + " from " + kFrom[clock] + when_text(fault.clock, fault.onset, true) + " on";
  if (std::isfinite(fault.duration)) {
    text += ", for " + when_text(fault.clock, fault.duration, true) + kUnit[clock];
  }
  return text;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
