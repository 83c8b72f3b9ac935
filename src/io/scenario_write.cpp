// The scenario file, written: every double as the text that reads back as the same double.
#include <cmath>
#include <initializer_list>
#include <limits>

#include "plumb/io/exact_text.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/io/records.hpp"
#include "plumb/io/scenario_file.hpp"
#include "toml_tree.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

std::string quoted(const std::string& text) {
  std::string out;
  append_json_string(out, text);  // its escapes are those of a TOML string as well
  return out;
}

std::string exact(Quantity quantity, double si, std::initializer_list<const char*> units) {
  return "\"" + exact_text(quantity, si, units) + "\"";
}

std::string acceleration(double mps2) { return exact(Quantity::acceleration, mps2, {"mg0", "g0", "m/s^2"}); }
std::string angle(double rad) { return exact(Quantity::angle, rad, {"deg", "rad"}); }
std::string seconds(double s) { return exact(Quantity::time, s, {"s"}); }
std::string metres(double m) { return exact(Quantity::length, m, {"m"}); }
std::string degc(double value) { return exact(Quantity::temperature, value, {"degC"}); }

/// A TOML number that stays a floating one, the sign of a zero included.
std::string number(double value) {
  std::string text = shortest(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string numbers(const double* values, std::size_t count) {
  std::string out = "[";
  for (std::size_t k = 0; k < count; ++k) out += (k == 0 ? "" : ", ") + number(values[k]);
  return out + "]";
}

std::string direction(const Vec3& v) { return numbers(v.data(), v.size()); }

std::string line(const char* key, const std::string& value) { return std::string(key) + " = " + value + "\n"; }

std::string seed_text(std::uint64_t seed) {
  const bool fits = seed < static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return fits ? std::to_string(seed) : "\"" + std::to_string(seed) + "\"";
}

struct LawText {
  std::string operator()(const scenario::FixedAttitude& law) const {
    return line("law", "\"fixed\"") + line("direction", direction(law.direction));
  }
  std::string operator()(const scenario::DirectionList& law) const {
    std::string list = "[\n";
    for (const Vec3& v : law.directions) list += "  " + direction(v) + ",\n";
    return line("law", "\"list\"") + line("directions", list + "]");
  }
  std::string operator()(const scenario::RandomStations& law) const {
    return line("law", "\"random\"") + line("stations", std::to_string(law.stations));
  }
  std::string operator()(const scenario::RollTest& law) const {
    return line("law", "\"roll-test\"") + line("stations", std::to_string(law.stations)) +
           line("inclination", angle(law.inclination_rad)) + line("toolface", angle(law.first_toolface_rad));
  }
  std::string operator()(const scenario::DrillingPath& law) const {
    return line("law", "\"drilling-path\"") + line("stations", std::to_string(law.stations)) +
           line("inclination", angle(law.first.inclination_rad)) + line("azimuth", angle(law.first.azimuth_rad)) +
           line("toolface", angle(law.first.toolface_rad)) + line("build", angle(law.build_rad)) +
           line("turn", angle(law.turn_rad)) + line("toolface_step", angle(law.toolface_step_rad)) +
           line("toolface_jitter", angle(law.toolface_jitter_rad));
  }
};

bool any(const std::array<double, 4>& terms) { return terms[1] != 0.0 || terms[2] != 0.0 || terms[3] != 0.0; }

/// The three temperature coefficients; `unit` stands before "/degC".
std::string slopes(const std::array<double, 4>& terms, const std::string& unit) {
  std::string out;
  for (std::size_t k = 1; k < terms.size(); ++k) {
    // A scale of 0 is refused as a scale, not as a relative change.
    const bool none = terms[k] == 0.0 && unit.find("/(") != std::string::npos;
    const std::string value = none ? "0 %" : shortest(terms[k]) + " " + unit;
    out += (k == 1 ? "\"" : ", \"") + value + (k == 1 ? "/degC" : "/degC^" + std::to_string(k)) + "\"";
  }
  return "[" + out + "]";
}

std::string sensor_text(const scenario::Tool& tool, int sensor, const RawUnit& unit) {
  const auto s = static_cast<std::size_t>(sensor);
  const SensorCoefficients& truth = tool.model.sensor[s];
  const SensorCoefficients& sheet = tool.datasheet.sensor[s].coefficients;
  const std::string per_mps2 = unit.name + "/(m/s^2)";
  std::string out = "\n[[sensor_truth]]\n" + line("id", quoted(tool.datasheet.sensor[s].row.id.data()));
  out += line("axis", direction(tool.axes[s]));
  out += line("scale", "\"" + shortest(truth.scale[0]) + " " + per_mps2 + "\"");
  out += line("bias", acceleration(truth.bias[0]));
  if (any(truth.bias) || any(sheet.bias)) out += line("bias_t", slopes(truth.bias, "m/s^2"));
  if (any(truth.scale) || any(sheet.scale)) out += line("scale_t", slopes(truth.scale, per_mps2));
  if (truth.reference_degc != sheet.reference_degc) out += line("t_ref", degc(truth.reference_degc));
  const double* cross = &tool.model.misalignment[s * kCapacity];
  bool crossed = false;
  for (int k = 0; k < tool.model.size; ++k) crossed = crossed || cross[k] != 0.0;
  if (crossed) out += line("cross", numbers(cross, static_cast<std::size_t>(tool.model.size)));
  const Vec3& arm = tool.lever_arm_m[s];
  if (arm != Vec3{})
    out += line("lever_arm", "[" + metres(arm[0]) + ", " + metres(arm[1]) + ", " + metres(arm[2]) + "]");
  return out;
}

/// What is omitted where it is not there: wander, rotation, depth.
std::string surroundings(const scenario::Scenario& s) {
  std::string out;
  const scenario::InstabilityLaw& wander = s.noise.instability;
  if (wander.sigma_mps2 != 0.0) out += line("instability", acceleration(wander.sigma_mps2));
  if (wander.correlation_s != scenario::InstabilityLaw().correlation_s) {
    out += line("correlation", seconds(wander.correlation_s));
  }
  if (wander.walk_mps2 != 0.0) out += line("walk", acceleration(wander.walk_mps2));
  const scenario::Turning& turning = s.turning;
  if (turning.rate_radps != 0.0) {
    out += "\n[rotation]\n" + line("rate", "\"" + shortest(turning.rate_radps) + " rad/s\"");
    out += line("axis", direction(turning.axis));
    if (turning.from_s != 0.0) out += line("from", seconds(turning.from_s));
    if (std::isfinite(turning.until_s)) out += line("until", seconds(turning.until_s));
  }
  const scenario::DepthLaw& depth = s.depth;
  if (depth.station_spacing_m != 0.0) {
    out += "\n[depth]\n" + line("station_spacing", metres(depth.station_spacing_m));
    if (depth.gravity_per_s2 != 0.0) out += line("gravity", "\"" + shortest(depth.gravity_per_s2) + " m/s^2/m\"");
    if (depth.heat_degc_per_m != 0.0) out += line("heat", "\"" + shortest(depth.heat_degc_per_m) + " degC/m\"");
  }
  return out;
}

}  // namespace

std::string scenario_text(const ScenarioFile& file) {
  const scenario::Scenario& s = file.scenario;
  const auto flag = [](bool value) { return std::string(value ? "true" : "false"); };
  std::string out = line("name", quoted(file.name));
  if (!file.array_inline) {
    out += file.array_path.empty() ? line("tool", "\"paper\"") : line("array", quoted(file.array_path));
  }
  out += line("seed", seed_text(s.seed)) + line("gravity", acceleration(s.gravity_mps2));
  out += line("rate", exact(Quantity::rate, s.rate_hz, {"kHz", "Hz"}));
  if (s.start_s != 0.0) out += line("start", seconds(s.start_s));
  out += "\n[attitude]\n" + std::visit(LawText(), s.attitudes);
  out += line("dwell", seconds(s.dwell_s)) + line("motion", seconds(s.move_s));
  out += line("vibration", acceleration(s.vibration_mps2));
  if (s.rest_vibration_mps2 != 0.0) out += line("rest_vibration", acceleration(s.rest_vibration_mps2));
  out += line("record_motion", flag(s.record_motion)) + line("tag_stations", flag(s.tag_stations));
  const bool constant = s.temperature.rate_degc_per_s == 0.0;
  out += "\n[temperature]\n" + line("law", constant ? "\"constant\"" : "\"linear\"");
  out += line(constant ? "value" : "start", degc(s.temperature.start_degc));
  if (!constant) out += line("rate", "\"" + shortest(s.temperature.rate_degc_per_s) + " degC/s\"");
  out += "\n[noise]\n" + line("factor", number(s.noise.white)) + line("quantise", flag(s.noise.quantise)) +
         line("clip", flag(s.noise.clip));
  out += surroundings(s);
  const scenario::FaultContext context = fault_context(file.array);
  for (const scenario::Fault& fault : s.faults) {
    out += "\n[[fault]]\n" + line("spec", quoted(scenario::to_text(fault, context)));
  }
  // Last, because it is the longest: what was drawn, spelled out.
  out += "\n[truth]\n" + line("law", "\"none\"");
  for (int i = 0; i < s.tool.datasheet.size; ++i) out += sensor_text(s.tool, i, file.array.input.unit);
  if (file.array_inline) {
    const FileExpected<TomlNode> array = parse_toml(file.array.text, file.array.path);
    if (array) out += "\n" + toml_text(*array, "array");
  }
  return out;
}

std::string scenario_json(const ScenarioFile& file) {
  const FileExpected<TomlNode> tree = parse_toml(scenario_text(file), file.path);
  return tree ? json_text(*tree) : std::string();
}

FileExpected<void> write_scenario(const std::string& path, const ScenarioFile& file) {
  const std::string ending = ".json";
  const bool json = path.size() >= ending.size() && path.substr(path.size() - ending.size()) == ending;
  return write_file(path, json ? scenario_json(file) : scenario_text(file));
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
