// [temperature], [noise], [rotation] and [depth] of the scenario file: what the tool is exposed to.
#include <cmath>
#include <limits>

#include "scenario_parts.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// "3 degC/min" -> degC per s, "60 deg/s" -> rad per s, "0.084 mGal/m" -> m/s^2 per m: one quantity per another.
double read_quotient(const TomlTable& table, const char* key, Quantity above, Quantity below, const std::string& form) {
  const TomlNode& value = table.need(key, form);
  const std::string text = table.text_with_unit(value, key, form);
  const std::size_t slash = text.rfind('/');
  if (slash == std::string::npos) table.fail(value.line, key, in_quotes(text) + " is not a rate", form);
  const double amount = table.checked(parse_quantity(above, text.substr(0, slash)), key, value);
  const std::string unit(trimmed(std::string_view(text).substr(slash + 1)));
  return amount / table.checked(parse_quantity(below, "1 " + unit), key, value);
}

double read_temperature_rate(const TomlTable& table) {
  return read_quotient(table, "rate", Quantity::temperature, Quantity::time,
                       "write it with a unit of time, as in rate = \"3 degC/min\"");
}

}  // namespace

scenario::TemperatureLaw read_temperature(const ScenarioSource& source, double reference_degc) {
  const TomlTable table = section_of(source, "temperature", {"law", "value", "start", "rate"});
  const std::vector<std::string> laws = {"constant", "linear"};
  const int law = table.choice("law", laws, 0);
  refuse_unused(table, laws[static_cast<std::size_t>(law)],
                law == 0 ? std::vector<std::string>{"law", "value"} : std::vector<std::string>{"law", "start", "rate"});
  const char* key = law == 0 ? "value" : "start";
  scenario::TemperatureLaw out;
  out.start_degc = within(table, key, table.quantity(Quantity::temperature, key, reference_degc), -273.15, 1e4,
                          "give a temperature of the sensors, as in \"25 degC\"");
  if (law == 1) {
    out.rate_degc_per_s =
        within(table, "rate", read_temperature_rate(table), -1e3, 1e3, "give a slower change, as in \"3 degC/min\"");
  }
  return out;
}

scenario::NoiseLaw read_noise(const ScenarioSource& source) {
  const TomlTable table =
      section_of(source, "noise", {"factor", "quantise", "clip", "instability", "correlation", "walk"});
  scenario::NoiseLaw noise;
  noise.white = within(table, "factor", table.quantity(Quantity::ratio, "factor", noise.white), 0.0, 1e6,
                       "give a factor on the datasheet's noise: 1 as declared, 0 none");
  noise.quantise = read_flag(table, "quantise", noise.quantise);
  noise.clip = read_flag(table, "clip", noise.clip);
  scenario::InstabilityLaw& wander = noise.instability;
  wander.sigma_mps2 =
      within(table, "instability", table.quantity(Quantity::acceleration, "instability", wander.sigma_mps2), 0.0, 1e6,
             "give the bias instability of every sensor, 1 sigma, as in \"20 ug0\"");
  wander.correlation_s =
      within(table, "correlation", table.quantity(Quantity::time, "correlation", wander.correlation_s), 1e-9, 1e12,
             "give the correlation time of the bias wander, as in \"100 s\"");
  wander.walk_mps2 = within(table, "walk", table.quantity(Quantity::acceleration, "walk", wander.walk_mps2), 0.0, 1e6,
                            "give 1 sigma of the random walk after one second, as in \"1 ug0\"");
  return noise;
}

scenario::Turning read_rotation(const ScenarioSource& source) {
  const TomlTable table = section_of(source, "rotation", {"rate", "axis", "from", "until"});
  scenario::Turning turning;
  if (source.root.find("rotation") == nullptr) return turning;
  turning.rate_radps =
      within(table, "rate",
             read_quotient(table, "rate", Quantity::angle, Quantity::time, "write it as in rate = \"60 deg/s\""), -1e5,
             1e5, "give a smaller rate, as in \"60 deg/s\"");
  if (table.has("axis")) {
    const std::string form = "give the axis in the tool frame, of unit length: axis = [0, 0, 1]";
    turning.axis = table.need_vec3("axis", form);
    if (std::abs(norm(turning.axis) - 1.0) > 1e-6) {
      table.fail(table.line_of("axis"), "axis", "is " + brief(norm(turning.axis), 9) + " long, must be of unit length",
                 form);
    }
  }
  const std::string times = "give a time of the log, as in \"12 s\"; `until` must not be before `from`";
  turning.from_s = within(table, "from", table.quantity(Quantity::time, "from", 0.0), -1e12, 1e12, times);
  turning.until_s = table.quantity(Quantity::time, "until", std::numeric_limits<double>::infinity());
  if (!(turning.until_s >= turning.from_s)) table.fail(table.line_of("until"), "until", "is before from", times);
  return turning;
}

scenario::Interference read_interference(const ScenarioSource& source) {
  const TomlTable table = section_of(source, "interference", {"vector", "frame", "from", "until"});
  scenario::Interference out;
  if (source.root.find("interference") == nullptr) return out;
  const std::string form = "give the field beside the Earth's: vector = [\"500 nT\", \"0 nT\", \"-200 nT\"]";
  const TomlNode& list = table.need("vector", form);
  if (list.kind != TomlNode::Kind::array || list.items.size() != 3)
    table.fail(list.line, "vector", "must be a list of three magnetic fields", form);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string name = "vector[" + std::to_string(k + 1) + "]";
    const std::string text = table.text_with_unit(list.items[k], name.c_str(), "uT, nT, mT, G");
    out.field_mps2[k] =
        table.checked(parse_quantity(Quantity::acceleration, text, source.field), name.c_str(), list.items[k]);
  }
  out.of_tool = table.choice("frame", {"tool", "ground"}, 0) == 0;
  const std::string times = "give a time of the log, as in \"12 s\"; `until` must not be before `from`";
  out.from_s = within(table, "from", table.quantity(Quantity::time, "from", 0.0), -1e12, 1e12, times);
  out.until_s = table.quantity(Quantity::time, "until", out.until_s);
  if (!(out.until_s >= out.from_s)) table.fail(table.line_of("until"), "until", "is before from", times);
  return out;
}

scenario::DepthLaw read_depth(const ScenarioSource& source) {
  const TomlTable table = section_of(source, "depth", {"station_spacing", "gravity", "heat"});
  scenario::DepthLaw depth;
  if (source.root.find("depth") == nullptr) return depth;
  depth.station_spacing_m =
      within(table, "station_spacing",
             table.need_quantity(Quantity::length, "station_spacing",
                                 "give the distance between two stations, as in station_spacing = \"28 m\""),
             -1e6, 1e6, "give a smaller length, as in \"28 m\"");
  if (table.has("gravity")) {
    depth.gravity_per_s2 = within(table, "gravity",
                                  read_quotient(table, "gravity", Quantity::acceleration, Quantity::length,
                                                "write it as in gravity = \"0.084 mGal/m\""),
                                  -1.0, 1.0, "give the change per metre, as in \"0.084 mGal/m\"");
  }
  if (table.has("heat")) {
    depth.heat_degc_per_m = within(
        table, "heat",
        read_quotient(table, "heat", Quantity::temperature, Quantity::length, "write it as in heat = \"0.03 degC/m\""),
        -1e3, 1e3, "give the change per metre, as in \"0.03 degC/m\"");
  }
  return depth;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
