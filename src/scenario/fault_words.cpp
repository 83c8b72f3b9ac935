// Faults written: as the text that reads back as the same fault, and as a sentence.
#include <cmath>
#include <utility>

#include "fault_parts.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

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
      for (const TextUnit& unit : acceleration_units(context.vector)) {
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
  switch (row_of(fault.kind).form) {
    case SizeForm::none: return {};
    case SizeForm::dither: return first > 0.0 ? level(first) : std::string();
    case SizeForm::level:
    case SizeForm::step: return level(first);
    case SizeForm::range: return level(first) + between + level(second);
    case SizeForm::acceleration: return quantity_text(first, acceleration_units(context.vector), gap);
    case SizeForm::drift: return quantity_text(first, drift_units(context.vector), gap);
    case SizeForm::share: return first < 1.0 ? share_text(first) : std::string();
    case SizeForm::pattern: return to_string(static_cast<BitPattern>(static_cast<int>(first)));
    case SizeForm::sensor: return other(first);
    case SizeForm::temperature: return shortest_text(first) + gap + "degC";
    case SizeForm::time: return quantity_text(first, time_units(), gap);
    case SizeForm::acceleration_share:
      return quantity_text(first, acceleration_units(context.vector), gap) + "*" + share_text(second);
    case SizeForm::acceleration_time:
      return quantity_text(first, acceleration_units(context.vector), gap) + "*" +
             quantity_text(second, time_units(), gap);
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

/// Puts the sizes into the sentence of a kind: `FaultKindRow::sentence` says how.
std::string filled(const std::string& sentence, const std::string& size) {
  const std::size_t star = size.find('*');
  const std::string first = size.substr(0, star);
  const std::string second = star == std::string::npos ? std::string() : size.substr(star + 1);
  std::string out, option;
  bool empty = false;  // what stands in the brackets at hand
  std::string* to = &out;
  for (std::size_t i = 0; i < sentence.size(); ++i) {
    if (sentence[i] == '[') {
      to = &option;
      empty = false;
    } else if (sentence[i] == ']') {
      if (!empty) out += option;
      option.clear();
      to = &out;
    } else if (sentence[i] == '{') {
      const std::size_t end = sentence.find('}', i);
      const std::string name = sentence.substr(i + 1, end - i - 1);
      const std::string& part = name == "1" ? first : name == "2" ? second : size;
      *to += name == "rows" ? count_text(std::stod(size), "row") : name == "all" && part.empty() ? "all" : part;
      empty = empty || part.empty();
      i = end;
    } else {
      *to += sentence[i];
    }
  }
  return out;
}

/// What a channel does, in words that follow its id.
std::string happening(const Fault& fault, const FaultContext& context) {
  return filled(row_of(fault.kind).sentence, size_text(fault, context, " ", " to "));
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
  static constexpr const char* kUnit[][2] = {{"", ""}, {" row", " rows"}, {" station", " stations"}};
  const auto clock = static_cast<std::size_t>(fault.clock);
  std::string text =
      describe_effect(fault, context) + " from " + kFrom[clock] + when_text(fault.clock, fault.onset, true) + " on";
  if (std::isfinite(fault.duration)) {
    text += ", for " + when_text(fault.clock, fault.duration, true);
    text += by_count(fault.duration, kUnit[clock][0], kUnit[clock][1]);
  }
  return text;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
