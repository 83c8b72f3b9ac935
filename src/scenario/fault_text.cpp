#include "plumb/scenario/fault_text.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fault_parts.hpp"
#include "plumb/scenario/catalogue.hpp"

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

int sensor_named(const FaultContext& context, Text name) {
  for (int i = 0; i < context.datasheet.size; ++i) {
    if (id_of(context, i) == name) return i;
  }
  return -1;
}

Result<int> find_sensor(const FaultContext& context, Text text) {
  if (trimmed(text) == "log" && sensor_named(context, "log") < 0) return kWholeLog;
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
  return refuse("no sensor " + quoted(trimmed(text)) + ". Remedy: name one of " + known + ", or log for the whole log");
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
  const auto acceleration = read_quantity(text, acceleration_units(context.vector), "level");
  if (!acceleration) return refuse(level.error() + ", as FS for full scale, or as an acceleration (1g0)");
  const SensorCoefficients& nominal = sheet.coefficients;
  return nominal.scale[0] * (*acceleration + nominal.bias[0]);
}

Result<double> read_dither(const FaultContext& context, int sensor, Text text) {
  return read_quantity(text, level_units(context, sensor), "dither");
}

/// "-3V..3V"; the first unit may be omitted where it is the same.
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

Result<double> read_bare(Text text, const char* what, const char* example) {
  const auto number = read_number(text);
  if (!number) return tl::unexpected<std::string>(number.error());
  if (number->rest.empty()) return number->value;
  return refuse(quoted(text) + " is not a plain " + what + ". Remedy: write it without a unit, as in " + example);
}

/// A step of the output: in the log's unit, or as what it means in acceleration.
Result<double> read_step(const FaultContext& context, int sensor, Text text) {
  auto step = read_quantity(text, level_units(context, sensor), "step");
  if (step || context.raw == FaultContext::Raw::acceleration) return step;
  const auto acceleration = read_quantity(text, acceleration_units(context.vector), "step");
  if (!acceleration) return step;
  return std::abs(sensor_of(context, sensor).coefficients.scale[0]) * *acceleration;
}

Result<double> read_pattern(Text text) {
  for (int k = 0; k < kBitPatterns; ++k) {
    if (text == to_string(static_cast<BitPattern>(k))) return static_cast<double>(k);
  }
  return refuse("unknown pattern " + quoted(text) + ". Remedy: write nan, inf, -inf, huge, denormal or -0");
}

Result<double> read_other(const FaultContext& context, Text text) {
  const auto sensor = find_sensor(context, text);
  if (!sensor) return tl::unexpected<std::string>(sensor.error());
  return static_cast<double>(*sensor);
}

/// The two parts of "50mg0*10s" by readers of their own.
template <class First, class Second>
Result<Fault> read_pair(Fault fault, Text text, const char* example, First read_first, Second read_second) {
  const std::size_t star = text.find('*');
  if (star == Text::npos) {
    return refuse(quoted(text) + " is one number, but two are needed. Remedy: write them as in " + example);
  }
  const Result<double> first = read_first(trimmed(text.substr(0, star)));
  if (!first) return tl::unexpected<std::string>(first.error());
  const Result<double> second = read_second(trimmed(text.substr(star + 1)));
  if (!second) return tl::unexpected<std::string>(second.error());
  fault.magnitude = *first;
  fault.upper = *second;
  return fault;
}

Result<Fault> read_two(const FaultContext& context, Fault fault, Text text) {
  const auto acceleration = [&context](Text t) { return read_quantity(t, acceleration_units(context.vector), "size"); };
  const auto share = [](Text t) { return read_quantity(t, share_units(), "share"); };
  const auto time = [](Text t) { return read_quantity(t, time_units(), "time"); };
  const auto angle = [](Text t) { return read_quantity(t, angle_units(), "angle"); };
  const auto other = [&context](Text t) { return read_other(context, t); };
  switch (row_of(fault.kind).form) {
    case SizeForm::acceleration_share: return read_pair(fault, text, "spikes=0.5g0*1%", acceleration, share);
    case SizeForm::acceleration_time: return read_pair(fault, text, "chatter=50mg0*10s", acceleration, time);
    case SizeForm::sensor_share: return read_pair(fault, text, "cross=a3*1%", other, share);
    case SizeForm::sensor_sensor: return read_pair(fault, text, "mirror=a1*a3", other, other);
    default: break;
  }
  if (text.find('*') != Text::npos) return read_pair(fault, text, "turned=2deg*90deg", angle, angle);
  const Result<double> only = angle(text);
  if (!only) return tl::unexpected<std::string>(only.error());
  fault.magnitude = *only;
  return fault;
}

Result<double> read_one(const FaultContext& context, const Fault& fault, Text text) {
  switch (row_of(fault.kind).form) {
    case SizeForm::level: return read_level(context, fault.sensor, text);
    case SizeForm::dither: return read_dither(context, fault.sensor, text);
    case SizeForm::step: return read_step(context, fault.sensor, text);
    case SizeForm::acceleration: return read_quantity(text, acceleration_units(context.vector), "size");
    case SizeForm::drift: return read_quantity(text, drift_units(context.vector), "drift");
    case SizeForm::share: return read_quantity(text, share_units(), "share");
    case SizeForm::pattern: return read_pattern(text);
    case SizeForm::sensor: return read_other(context, text);
    case SizeForm::temperature: return read_quantity(text, {{"degC", 1.0}}, "temperature");
    case SizeForm::time: return read_quantity(text, time_units(), "time");
    case SizeForm::factor: return read_bare(text, "factor", "scale=1.1");
    default: return read_bare(text, "number", "late=5");
  }
}

bool may_lack_size(SizeForm form) {
  return form == SizeForm::none || form == SizeForm::dither || form == SizeForm::share;
}

/// Reads what stands behind the '='.
Result<Fault> read_size(const FaultContext& context, Fault fault, bool given, Text text) {
  const SizeForm form = row_of(fault.kind).form;
  if (form == SizeForm::share) fault.magnitude = 1.0;
  if (may_lack_size(form) && !given) return fault;
  if (form == SizeForm::none) {
    return refuse("a fault of kind " + quoted(to_string(fault.kind)) +
                  " takes no size. Remedy: leave out '=' and the size");
  }
  if (text.empty()) {
    return refuse("a fault of kind " + quoted(to_string(fault.kind)) +
                  " needs a size. Remedy: write it as in stuck=0V, random=-3V..3V, bias=50mg0, drift=1mg0/s or "
                  "scale=1.1");
  }
  if (fault.sensor == kWholeLog && row_of(fault.kind).strikes == Strikes::channel) {
    return refuse("a fault of kind " + quoted(to_string(fault.kind)) +
                  " acts on one sensor. Remedy: write the sensor in place of log");
  }
  if (form == SizeForm::range) return read_range(context, fault, text);
  if (form >= SizeForm::acceleration_share) return read_two(context, fault, text);
  const Result<double> size = read_one(context, fault, text);
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

/// What a fault's text falls into: "SENSOR:KIND[=SIZE]@WHEN".
struct Pieces {
  Text sensor, kind, size, when;
  bool sized = false;
};

Result<Pieces> pieces_of(Text text) {
  const std::size_t at = text.rfind('@');
  if (at == Text::npos)
    return refuse("the onset is missing. Remedy: give the begin of the fault, as in a2:stuck=0V@12s");
  const Text head = text.substr(0, at);
  const std::size_t colon = head.rfind(':');
  if (colon == Text::npos) return refuse("the sensor is missing. Remedy: begin with the sensor, as in a2:stuck=0V@12s");
  const Text body = head.substr(colon + 1);
  const std::size_t equals = body.find('=');
  Pieces pieces;
  pieces.sensor = head.substr(0, colon);
  pieces.kind = trimmed(body.substr(0, equals));
  pieces.sized = equals != Text::npos;
  if (pieces.sized) pieces.size = trimmed(body.substr(equals + 1));
  pieces.when = trimmed(text.substr(at + 1));
  return pieces;
}

/// A whole fault of the fault language, so that no name of the catalogue is meant.
bool is_kind(Text word, bool sized) {
  for (int k = 0; k < kFaultKinds; ++k) {
    const auto kind = static_cast<FaultKind>(k);
    if (word == to_string(kind)) return sized || may_lack_size(row_of(kind).form);
  }
  return false;
}

Result<Fault> read_kind(Fault fault, Text text) {
  std::string known;
  for (int k = 0; k < kFaultKinds; ++k) {
    fault.kind = static_cast<FaultKind>(k);
    if (text == to_string(fault.kind)) return fault;
    known += (k == 0 ? "" : ", ") + std::string(to_string(fault.kind));
  }
  return refuse("unknown kind of fault " + quoted(text) + ". Remedy: write one of " + known +
                ", or a name of the fault catalogue (F01 to F29, off, garbage, ...)");
}

Result<Fault> parse(const Pieces& pieces, const FaultContext& context) {
  Fault fault;
  const auto sensor = find_sensor(context, pieces.sensor);
  if (!sensor) return tl::unexpected<std::string>(sensor.error());
  fault.sensor = *sensor;
  auto result = read_kind(fault, pieces.kind);
  if (result) result = read_size(context, *result, pieces.sized, pieces.size);
  if (result) result = read_times(*result, pieces.when);
  if (!result) return result;
  const auto checked = check(*result, context.datasheet.size);
  if (!checked) return tl::unexpected<std::string>(checked.error());
  return result;
}

Result<Fault> parse(Text text, const FaultContext& context) {
  const auto pieces = pieces_of(text);
  return pieces ? parse(*pieces, context) : tl::unexpected<std::string>(pieces.error());
}

/// The faults of a catalogue entry, on the named sensor and, where it takes more, on those behind it.
Result<std::vector<Fault>> from_catalogue(const CatalogueEntry& entry, const Pieces& pieces,
                                          const FaultContext& context) {
  const auto sensor = find_sensor(context, pieces.sensor);
  if (!sensor) return tl::unexpected<std::string>(sensor.error());
  Fault times;
  times.sensor = *sensor;
  const auto when = read_times(times, pieces.when);
  if (!when) return tl::unexpected<std::string>(when.error());
  CatalogueOptions options;
  options.sensor = std::max(0, *sensor);
  options.clock = when->clock;
  options.onset = when->onset;
  options.duration = when->duration;
  if (pieces.sized) options.size = std::string(pieces.size);
  return faults_of(entry, options, context);
}

}  // namespace

tl::expected<std::vector<Fault>, std::string> parse_faults(std::string_view text, const FaultContext& context) {
  const auto named = [text](const std::string& why) { return refuse("fault " + quoted(text) + ": " + why); };
  const auto pieces = pieces_of(text);
  if (!pieces) return named(pieces.error());
  // A word of the fault language comes first: "stuck" with a size is a level, without one it is PX4's stuck.
  if (!is_kind(pieces->kind, pieces->sized)) {
    if (const std::optional<CatalogueEntry> entry = find_entry(pieces->kind)) {
      auto faults = from_catalogue(*entry, *pieces, context);
      if (!faults) return named(faults.error());
      return faults;
    }
  }
  const auto fault = parse(*pieces, context);
  if (!fault) return named(fault.error());
  return std::vector<Fault>{*fault};
}

tl::expected<Fault, std::string> parse_fault(std::string_view text, const FaultContext& context) {
  auto fault = parse(text, context);
  if (!fault) return refuse("fault " + quoted(text) + ": " + fault.error());
  return fault;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
