// Faults written: as the text that reads back as the same fault, and as a sentence.
#include <cmath>
#include <utility>

#include "fault_parts.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

SizeForm form_of(FaultKind kind) noexcept {
  switch (kind) {
    case FaultKind::stuck_level: return SizeForm::level;
    case FaultKind::stuck_last: return SizeForm::dither;
    case FaultKind::coarse: return SizeForm::step;
    case FaultKind::random_range:
    case FaultKind::random_level:
    case FaultKind::clip: return SizeForm::range;
    case FaultKind::bias_step:
    case FaultKind::noise:
    case FaultKind::shake:
    case FaultKind::gravity: return SizeForm::acceleration;
    case FaultKind::drift: return SizeForm::drift;
    case FaultKind::scale_change: return SizeForm::factor;
    case FaultKind::missing:
    case FaultKind::drop: return SizeForm::share;
    case FaultKind::bit_flip:
    case FaultKind::late:
    case FaultKind::slow: return SizeForm::count;
    case FaultKind::pattern: return SizeForm::pattern;
    case FaultKind::exchange: return SizeForm::sensor;
    case FaultKind::temperature: return SizeForm::temperature;
    case FaultKind::back: return SizeForm::time;
    case FaultKind::spikes: return SizeForm::acceleration_share;
    case FaultKind::chatter:
    case FaultKind::warm_up: return SizeForm::acceleration_time;
    case FaultKind::cross_talk: return SizeForm::sensor_share;
    case FaultKind::turned:
    case FaultKind::ghost: return SizeForm::angle_angle;
    case FaultKind::mirror: return SizeForm::sensor_sensor;
    case FaultKind::repeat:
    case FaultKind::swap: break;
  }
  return SizeForm::none;
}

std::string id_of(const FaultContext& context, int sensor) {
  if (sensor == kWholeLog) return "log";
  std::string id;
  for (const char c : context.datasheet.sensor[static_cast<std::size_t>(sensor)].row.id) {
    if (c == '\0') break;
    id += c;
  }
  return id;
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
  if (context.datasheet.sensor[static_cast<std::size_t>(sensor)].resolution_raw > 0.0) {
    units.push_back({"LSB", context.datasheet.sensor[static_cast<std::size_t>(sensor)].resolution_raw, false});
  }
  return units;
}

namespace {

/// "12s", "#5", "station6"; for a sentence "12 s", "5", "6".
std::string when_text(Clock clock, double value, bool sentence) {
  if (clock == Clock::time) return quantity_text(value, time_units(), sentence ? " " : "");
  if (sentence) return shortest_text(value);
  return (clock == Clock::row ? "#" : "station") + shortest_text(value);
}

std::string level_text(const FaultContext& context, int sensor, double raw, const char* gap) {
  return quantity_text(raw, level_units(context, sensor), gap);
}

std::string share_text(double share) { return quantity_text(share, share_units()); }

/// What stands behind the '='; empty where nothing has to.
std::string size_text(const Fault& fault, const FaultContext& context, const char* gap, const char* between) {
  const auto level = [&](double raw) { return level_text(context, fault.sensor, raw, gap); };
  const auto other = [&](double index) { return id_of(context, static_cast<int>(index)); };
  const double first = fault.magnitude;
  const double second = fault.upper;
  switch (form_of(fault.kind)) {
    case SizeForm::none: return {};
    case SizeForm::dither: return first > 0.0 ? level(first) : std::string();
    case SizeForm::level:
    case SizeForm::step: return level(first);
    case SizeForm::range: return level(first) + between + level(second);
    case SizeForm::acceleration: return quantity_text(first, acceleration_units(), gap);
    case SizeForm::drift: return quantity_text(first, drift_units(), gap);
    case SizeForm::share: return first < 1.0 ? share_text(first) : std::string();
    case SizeForm::pattern: return to_string(static_cast<BitPattern>(static_cast<int>(first)));
    case SizeForm::sensor: return other(first);
    case SizeForm::temperature: return shortest_text(first) + gap + "degC";
    case SizeForm::time: return quantity_text(first, time_units(), gap);
    case SizeForm::acceleration_share:
      return quantity_text(first, acceleration_units(), gap) + "*" + share_text(second);
    case SizeForm::acceleration_time:
      return quantity_text(first, acceleration_units(), gap) + "*" + quantity_text(second, time_units(), gap);
    case SizeForm::sensor_share: return other(first) + "*" + share_text(second);
    case SizeForm::angle_angle:
      return quantity_text(first, angle_units(), gap) +
             (second != 0.0 || std::signbit(second) ? "*" + quantity_text(second, angle_units(), gap) : std::string());
    case SizeForm::sensor_sensor: return other(first) + "*" + other(second);
    case SizeForm::count:
    case SizeForm::factor: break;
  }
  return shortest_text(first);
}

/// What a channel does, in words that follow its id.
std::string happening(const Fault& fault, const FaultContext& context) {
  const std::string size = size_text(fault, context, " ", " to ");
  const std::string first = size.substr(0, size.find('*'));
  const std::string second = size.find('*') == std::string::npos ? std::string() : size.substr(size.find('*') + 1);
  const std::string share = size.empty() ? std::string("all") : size;
  switch (fault.kind) {
    case FaultKind::stuck_level: return "stands at " + size;
    case FaultKind::stuck_last:
      return "stands at its last value" + (fault.magnitude > 0.0 ? " with a dither of +-" + size : std::string());
    case FaultKind::random_range: return "delivers random values from " + size + ", new in every row";
    case FaultKind::random_level: return "stands at a random value from " + size;
    case FaultKind::bias_step: return "reads " + size + " too much";
    case FaultKind::drift: return "drifts by " + size;
    case FaultKind::noise: return "has " + size + " rms of noise more";
    case FaultKind::spikes: return "has spikes of +-" + first + " in " + second + " of its rows";
    case FaultKind::chatter: return "reads " + first + " too much in every other stretch of " + second;
    case FaultKind::warm_up: return "reads " + first + " too much, dying away with " + second;
    case FaultKind::clip: return "is clipped outside " + size;
    case FaultKind::coarse: return "comes in steps of " + size;
    case FaultKind::bit_flip: return "has bit " + size + " inverted";
    case FaultKind::pattern: return "delivers " + size;
    case FaultKind::missing: return "does not deliver " + share + " of its rows";
    case FaultKind::late: return "comes " + size + " rows late";
    case FaultKind::slow: return "has a new value every " + size + " rows only";
    case FaultKind::exchange: return "and " + size + " have changed places";
    case FaultKind::cross_talk: return "picks up " + second + " of " + first;
    case FaultKind::turned: return "is turned by " + first + (second.empty() ? "" : " towards " + second);
    case FaultKind::ghost: return "shows gravity turned by " + first + (second.empty() ? "" : " about " + second);
    case FaultKind::mirror: return "shows gravity mirrored between " + first + " and " + second;
    case FaultKind::shake: return "shakes with " + size + " rms per axis";
    case FaultKind::gravity: return "is under a gravity longer by " + size + " than told";
    case FaultKind::temperature: return "has its temperature told wrong by " + size;
    case FaultKind::drop: return "loses " + share + " of its rows";
    case FaultKind::repeat: return "has every row twice";
    case FaultKind::swap: return "has its rows in the wrong order, two by two";
    case FaultKind::back: return "has its time behind by " + size;
    case FaultKind::scale_change: break;
  }
  return "has its scale factor multiplied by " + size;
}

}  // namespace

std::string to_text(const Fault& fault, const FaultContext& context) {
  std::string text = id_of(context, fault.sensor) + ":" + to_string(fault.kind);
  const std::string size = size_text(fault, context, "", "..");
  if (!size.empty()) text += "=" + size;
  text += "@" + when_text(fault.clock, fault.onset, false);
  if (std::isfinite(fault.duration)) text += "+" + when_text(fault.clock, fault.duration, false);
  return text;
}

std::string describe_effect(const Fault& fault, const FaultContext& context) {
  return (fault.sensor == kWholeLog ? "the log" : id_of(context, fault.sensor)) + " " + happening(fault, context);
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
