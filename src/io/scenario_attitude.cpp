// [attitude] of the scenario file: where the tool points, how long it rests, how it moves between.
#include <cmath>

#include "refusal.hpp"
#include "scenario_parts.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

using scenario::AttitudeLaw;

constexpr double kUnitTolerance = 1e-6;
constexpr std::int64_t kMostStations = 1000000;
/// A year of dwell: beyond it a slip of the unit is meant.
constexpr double kLongest_s = 366.0 * 86400.0;

const std::vector<std::string>& laws() {
  static const std::vector<std::string> names = {"fixed", "list", "random", "roll-test", "drilling-path"};
  return names;
}

std::vector<std::string> keys_of(std::size_t law) {
  static const std::vector<std::vector<std::string>> own = {
      {"direction"},
      {"directions"},
      {"stations"},
      {"stations", "inclination", "toolface"},
      {"stations", "inclination", "azimuth", "toolface", "build", "turn", "toolface_step", "toolface_jitter"}};
  std::vector<std::string> keys = {"law",           "dwell",       "motion", "vibration", "rest_vibration",
                                   "record_motion", "tag_stations"};
  keys.insert(keys.end(), own[law].begin(), own[law].end());
  return keys;
}

std::vector<std::string> all_keys() {
  std::vector<std::string> keys = keys_of(0);
  for (std::size_t law = 1; law < laws().size(); ++law) {
    for (const std::string& key : keys_of(law)) {
      bool known = false;
      for (const std::string& other : keys) known = known || other == key;
      if (!known) keys.push_back(key);
    }
  }
  return keys;
}

/// [x, y, z] of unit length, or {inclination = "30 deg", toolface = "90 deg"}.
Vec3 direction_from(const TomlTable& table, const std::string& name, const TomlNode& node) {
  const std::string form =
      "write where gravity points in the tool frame, [0, 0, 1] of unit length, or {inclination = \"30 deg\", toolface "
      "= \"90 deg\"}";
  if (node.kind == TomlNode::Kind::table) {
    const TomlTable angles(node, table.file(), table.field(name), {"inclination", "toolface"});
    scenario::Attitude attitude;
    attitude.inclination_rad = angles.need_quantity(Quantity::angle, "inclination", form);
    attitude.toolface_rad = angles.quantity(Quantity::angle, "toolface", 0.0);
    return scenario::gravity_direction(attitude);
  }
  bool numbers = node.kind == TomlNode::Kind::array && node.items.size() == 3;
  for (const TomlNode& item : node.items) {
    numbers = numbers && (item.kind == TomlNode::Kind::number || item.kind == TomlNode::Kind::integer) &&
              std::isfinite(item.number);
  }
  if (!numbers) table.fail(node.line, name, "is not a direction", form);
  const Vec3 direction = {node.items[0].number, node.items[1].number, node.items[2].number};
  const double length = norm(direction);
  if (std::abs(length - 1.0) <= kUnitTolerance) return direction;
  std::string remedy = form;
  if (std::isfinite(length) && length > 0.0) {
    remedy = "divide it by its length: [" + shortest(direction[0] / length) + ", " + shortest(direction[1] / length) +
             ", " + shortest(direction[2] / length) + "]";
  }
  table.fail(node.line, name, "is " + brief(length, 9) + " long, must be of unit length", remedy);
}

scenario::DirectionList read_list(const TomlTable& table) {
  const std::string form = "write directions = [[0, 0, 1], {inclination = \"30 deg\", toolface = \"90 deg\"}, ...]";
  const TomlNode& list = table.need("directions", form);
  if (list.kind != TomlNode::Kind::array || list.items.empty()) {
    table.fail(list.line, "directions", "must be a list of at least one direction", form);
  }
  scenario::DirectionList law;
  for (std::size_t k = 0; k < list.items.size(); ++k) {
    law.directions.push_back(direction_from(table, "directions[" + std::to_string(k + 1) + "]", list.items[k]));
  }
  return law;
}

int read_stations(const TomlTable& table, int fallback) {
  const std::int64_t stations = table.integer("stations", fallback);
  return static_cast<int>(within(table, "stations", static_cast<double>(stations), 1.0,
                                 static_cast<double>(kMostStations),
                                 "give 1 to " + std::to_string(kMostStations) + " stations"));
}

AttitudeLaw read_law(const TomlTable& table, std::size_t index) {
  const auto angle = [&table](const char* key, double fallback) {
    return within(table, key, table.quantity(Quantity::angle, key, fallback), -1e6, 1e6,
                  "give a smaller angle, as in \"90 deg\"");
  };
  if (index == 0) {
    const TomlNode& direction = table.need("direction", "give the direction of gravity: direction = [0, 0, 1]");
    return scenario::FixedAttitude{direction_from(table, "direction", direction)};
  }
  if (index == 1) return read_list(table);
  if (index == 2) return scenario::RandomStations{read_stations(table, scenario::RandomStations().stations)};
  if (index == 3) {
    scenario::RollTest law;
    law.stations = read_stations(table, law.stations);
    law.inclination_rad = angle("inclination", law.inclination_rad);
    law.first_toolface_rad = angle("toolface", law.first_toolface_rad);
    return law;
  }
  scenario::DrillingPath law;
  law.stations = read_stations(table, law.stations);
  law.first.inclination_rad = angle("inclination", law.first.inclination_rad);
  law.first.azimuth_rad = angle("azimuth", law.first.azimuth_rad);
  law.first.toolface_rad = angle("toolface", law.first.toolface_rad);
  law.build_rad = angle("build", law.build_rad);
  law.turn_rad = angle("turn", law.turn_rad);
  law.toolface_step_rad = angle("toolface_step", law.toolface_step_rad);
  law.toolface_jitter_rad = angle("toolface_jitter", law.toolface_jitter_rad);
  return law;
}

}  // namespace

void read_attitude(const ScenarioSource& source, scenario::Scenario& out) {
  if (source.root.find("attitude") == nullptr) {
    throw Refusal(FileError{source.file, 0, "attitude", "is missing",
                            "add [attitude] with law = \"drilling-path\" (or one of: " + joined(laws()) +
                                ") to state the attitude of the tool"});
  }
  const TomlTable table = section_of(source, "attitude", all_keys());
  const auto law = static_cast<std::size_t>(
      table.need_choice("law", laws(), "state the attitude of the tool: law = one of: " + joined(laws())));
  refuse_unused(table, laws()[law], keys_of(law));
  out.attitudes = read_law(table, law);
  out.dwell_s = within(table, "dwell", table.quantity(Quantity::time, "dwell", out.dwell_s), 0.0, kLongest_s,
                       "give the time at rest at every station, as in \"2 s\"");
  out.move_s = within(table, "motion", table.quantity(Quantity::time, "motion", out.move_s), 0.0, kLongest_s,
                      "give the time between two stations, 0 s or more, as in \"1 s\"");
  if (out.dwell_s * out.rate_hz < 0.5) {
    table.fail(table.line_of("dwell"), "dwell", "is too short to hold a sample", "raise dwell, or the rate");
  }
  for (const char* const key : {"vibration", "rest_vibration"}) {
    if (source.field != FieldKind::gravity && table.has(key))
      table.fail(table.line_of(key), key, "is an acceleration, which only accelerometers feel",
                 "remove it; a magnetic field beside the Earth's is [interference]");
  }
  out.vibration_mps2 =
      within(table, "vibration", table.quantity(Quantity::acceleration, "vibration", out.vibration_mps2), 0.0, 1e6,
             "give the rms per axis while moving, 0 or more, as in \"0.1 g0\"");
  out.rest_vibration_mps2 =
      within(table, "rest_vibration", table.quantity(Quantity::acceleration, "rest_vibration", out.rest_vibration_mps2),
             0.0, 1e6, "give the rms per axis while at rest, 0 or more, as in \"1 mg0\"");
  out.record_motion = read_flag(table, "record_motion", out.record_motion);
  out.tag_stations = read_flag(table, "tag_stations", out.tag_stations);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
