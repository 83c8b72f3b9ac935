#include <algorithm>
#include <cmath>
#include <vector>

#include "array_parts.hpp"
#include "plumb/scenario/count_text.hpp"
#include "refusal.hpp"
#include "text_tools.hpp"
#include "toml_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

const std::vector<std::string>& known_keys() {
  static const std::vector<std::string> names =
      with_motion_keys(with_stability_keys({"id", "column", "axis", "scale", "bias", "bias_t", "scale_t", "t_ref",
                                            "noise", "prior", "full_scale", "resolution", "lever_arm_m", "package"}));
  return names;
}

const std::vector<std::string>& known_keys(FieldKind field) {
  static const std::vector<std::string> magnetic =
      with_stability_keys({"id", "column", "axis", "scale", "bias", "bias_t", "scale_t", "t_ref", "noise", "prior",
                           "full_scale", "resolution", "package"});
  static const std::vector<std::string> rate = with_rate_keys(
      {"id", "column", "axis", "scale", "bias", "bias_t", "scale_t", "t_ref", "noise", "full_scale", "package"});
  return field == FieldKind::gravity ? known_keys() : field == FieldKind::magnetic ? magnetic : rate;
}

constexpr std::size_t kLongestId = 15;
constexpr std::size_t kLongestPackage = 31;
constexpr double kLongestArm_m = 100.0;
/// A tenth of a ng0, 4 fT or 0.2 mdeg/h: the best accelerometers reach some ng0 in a second.
constexpr double kLeastNoise_mps2 = 1e-9;

/// Everything that reading one sensor needs besides its table.
struct Surroundings {
  const RawUnit& unit;
  double g_mps2;  ///< 0: the vector has no known length
};

void refuse_unless_positive(const TomlTable& table, const char* key, double value, const std::string& remedy) {
  if (!(value > 0.0)) table.fail(table.line_of(key), key, "must be above zero", remedy);
}

Vec3 read_axis(const TomlTable& table) {
  const Vec3 axis =
      table.need_vec3("axis", "give the direction that the sensor measures, in the tool frame: axis = [0.0, 0.0, 1.0]");
  const double length = norm(axis);
  if (std::abs(length - 1.0) <= kAxisLengthTolerance) return axis;
  std::string remedy = "give a direction: the three numbers must not all be zero";
  if (std::isfinite(length) && length > 0.0) {
    remedy = "divide it by its length: [" + shortest(axis[0] / length) + ", " + shortest(axis[1] / length) + ", " +
             shortest(axis[2] / length) + "]";
  }
  table.fail(table.line_of("axis"), "axis", "is " + brief(length, 9) + " long, must be of unit length", remedy);
}

/// Terms 1..3 of eqs (1), (2); a relative slope of the scale is multiplied by `factor` = the scale.
void read_slopes(const TomlTable& table, const char* key, Quantity quantity, double factor,
                 std::array<double, 4>& out) {
  const TomlNode* list = table.find(key);
  if (list == nullptr) return;
  const std::string unit = units_of(table.field_of()).fine;
  const std::string slopes = table.field_of() == FieldKind::gravity
                                 ? "0.1 mg/degC\", \"2 ug/degC^2"
                                 : "0.5 " + unit + "/degC\", \"0.01 " + unit + "/degC^2";
  const std::string form = std::string("write ") + key + " = [\"" +
                           (quantity == Quantity::ratio ? "200 ppm/degC\", \"1 ppm/degC^2" : slopes) + "\"]";
  if (list->kind != TomlNode::Kind::array || list->items.empty() || list->items.size() > 3) {
    table.fail(list->line, key, "must be a list of one to three coefficients", form);
  }
  int order = 0;
  for (const TomlNode& item : list->items) {
    ++order;
    const std::string name = std::string(key) + "[" + std::to_string(order) + "]";
    if (item.kind != TomlNode::Kind::text)
      table.fail(list->line, name, std::string("is ") + item.kind_name() + ", must be a string with a unit", form);
    out[static_cast<std::size_t>(order)] =
        factor *
        table.checked(parse_temperature_slope(quantity, item.text, order, table.field_of()), name.c_str(), *list);
  }
}

/// 1-sigma tolerances of terms 1..3; those not given keep their default.
void read_prior_slopes(const TomlTable& table, const char* key, Quantity quantity, std::array<double, 3>& out) {
  std::array<double, 4> terms = {0.0, out[0], out[1], out[2]};
  read_slopes(table, key, quantity, 1.0, terms);
  for (std::size_t k = 0; k < out.size(); ++k) {
    refuse_unless_positive(table, key, terms[k + 1], "give 1-sigma tolerances, or remove the term");
    out[k] = terms[k + 1];
  }
}

Prior read_prior(const TomlTable& table, const RawUnit& unit, double scale) {
  Prior prior;
  const TomlNode* node = table.find("prior");
  if (node == nullptr) return prior;
  const TomlTable inner(*node, table.file(), table.field("prior"), {"bias", "scale", "axis", "bias_t", "scale_t"},
                        table.field_of());
  if (const TomlNode* bias = inner.find("bias"); bias != nullptr) {
    const std::string text = inner.text_with_unit(*bias, "bias", accepted_raw_units(unit.field));
    prior.bias_mps2 = std::abs(inner.checked(parse_as_acceleration(text, unit, scale), "bias", *bias));
  }
  prior.scale = inner.quantity(Quantity::ratio, "scale", prior.scale);
  prior.axis_rad = inner.quantity(Quantity::angle, "axis", prior.axis_rad);
  refuse_unless_positive(inner, "bias", prior.bias_mps2,
                         std::string("give the 1-sigma tolerance of the bias, for example \"") +
                             (unit.field == FieldKind::gravity ? "20 mg" : "500 nT") + "\"");
  refuse_unless_positive(inner, "scale", prior.scale, "give the 1-sigma tolerance of the scale, for example \"2 %\"");
  refuse_unless_positive(inner, "axis", prior.axis_rad,
                         "give the 1-sigma tolerance of the direction, for example \"2 deg\"");
  read_prior_slopes(inner, "bias_t", Quantity::acceleration, prior.bias_t_mps2);
  read_prior_slopes(inner, "scale_t", Quantity::ratio, prior.scale_t);
  return prior;
}

/// A value in raw units or as an acceleration, without its sign; 0 = unknown where the key is absent.
double read_raw(const TomlTable& table, const char* key, const RawUnit& unit, double scale) {
  const TomlNode* value = table.find(key);
  if (value == nullptr) return 0.0;
  const std::string text = table.text_with_unit(*value, key, accepted_raw_units(unit.field));
  return std::abs(table.checked(parse_as_raw(text, unit, scale), key, *value));
}

void check_range(const TomlTable& table, const DatasheetSensor& sensor, double g_mps2) {
  if (!table.has("full_scale") || g_mps2 == 0.0) return;
  const FieldUnits& units = units_of(table.field_of());
  const auto words = [&units](double mps2) { return brief(units.coarse_per_inside * mps2) + " " + units.coarse; };
  const double reach_mps2 =
      sensor.full_scale_raw / std::abs(sensor.coefficients.scale[0]) - std::abs(sensor.coefficients.bias[0]);
  const double needed_mps2 = g_mps2 * (1.0 + kFullScaleMargin);
  if (reach_mps2 >= needed_mps2) return;
  table.fail(table.line_of("full_scale"), "full_scale",
             "reaches " + words(reach_mps2) + " beside the bias, below " + units.vector + " plus a margin of 5 % (" +
                 words(needed_mps2) + ")",
             std::string("such a sensor clips when it points along ") + units.vector +
                 ": check full_scale, scale and bias, or remove the sensor");
}

double read_scale(const TomlTable& table, const RawUnit& unit) {
  const bool acceleration = unit.kind == RawUnit::Kind::acceleration;
  if (!table.has("scale") && acceleration) return 1.0 / unit.base_per_unit;
  const bool gravity = unit.field == FieldKind::gravity;
  const std::string example = !gravity                            ? units_of(unit.field).scale_examples
                              : unit.kind == RawUnit::Kind::count ? "\"2048 count/g0\""
                                                                  : "\"3 V/g0\"";
  const TomlNode& value = table.need("scale", "the log is in " + unit.name + ": give scale = " + example);
  const bool plain = value.kind == TomlNode::Kind::number || value.kind == TomlNode::Kind::integer;
  const std::string text =
      acceleration && plain
          ? shortest(value.number)
          : table.text_with_unit(value, "scale", gravity ? "V/g0, mV/g0, count/g0, count/(m/s^2), ..." : example);
  return table.checked(parse_scale(text, unit), "scale", value);
}

DatasheetSensor read_sensor(const TomlTable& table, const Surroundings& around) {
  DatasheetSensor sensor;
  const std::string id = table.need_text("id", "name the sensor: id = \"A1\"");
  if (id.size() > kLongestId) {
    table.fail(table.line_of("id"), "id", in_quotes(id) + " is longer than 15 characters", "shorten it");
  }
  sensor.row.id = make_id(id.c_str());
  sensor.row.axis = read_axis(table);
  const double scale = read_scale(table, around.unit);
  sensor.coefficients.scale[0] = scale;
  if (const TomlNode* bias = table.find("bias"); bias != nullptr) {
    const std::string text = table.text_with_unit(*bias, "bias", accepted_raw_units(around.unit.field));
    sensor.coefficients.bias[0] = table.checked(parse_as_acceleration(text, around.unit, scale), "bias", *bias);
  }
  read_slopes(table, "bias_t", Quantity::acceleration, 1.0, sensor.coefficients.bias);
  read_slopes(table, "scale_t", Quantity::ratio, scale, sensor.coefficients.scale);
  sensor.coefficients.reference_degc =
      table.quantity(Quantity::temperature, "t_ref", sensor.coefficients.reference_degc);
  const FieldUnits& units = units_of(table.field_of());
  const std::string remedy =
      std::string("give the noise of one sample, 1 sigma: noise = \"") + units.noise_example + "\"";
  const TomlNode& noise = table.need("noise", remedy);
  const std::string text = table.text_with_unit(noise, "noise", accepted_raw_units(around.unit.field));
  const double sigma_mps2 = table.checked(parse_as_acceleration(text, around.unit, std::abs(scale)), "noise", noise);
  refuse_unless_positive(table, "noise", sigma_mps2, remedy);
  if (sigma_mps2 < kLeastNoise_mps2)
    table.fail(noise.line, "noise",
               "is " + brief(units.coarse_per_inside * sigma_mps2) + " " + units.coarse + ", below " +
                   (table.field_of() == FieldKind::gravity
                        ? std::string("1e-9 m/s^2 (0.1 ng0)")
                        : brief(units.coarse_per_inside * kLeastNoise_mps2) + " " + units.coarse) +
                   ": no " + units.sensor + " is that quiet, and every limit follows from it",
               std::string("give the noise as the datasheet or a recording at rest states it, 1 sigma of one sample: "
                           "noise = \"") +
                   units.noise_example + "\"");
  sensor.row.sigma_mps2 = sigma_mps2;
  sensor.full_scale_raw = read_raw(table, "full_scale", around.unit, scale);
  sensor.resolution_raw = read_raw(table, "resolution", around.unit, scale);
  check_range(table, sensor, around.g_mps2);
  sensor.prior = read_prior(table, around.unit, scale);
  return sensor;
}

std::string path_of(std::size_t i, const std::string& prefix = "") {
  return prefix + "sensor[" + std::to_string(i + 1) + "]";
}

void refuse_twins(const std::vector<TomlTable>& tables, const std::vector<std::string>& values, const char* key,
                  const std::string& remedy) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (values[i] != values[j]) continue;
      tables[i].fail(tables[i].line_of(key), key,
                     in_quotes(values[i]) + " is already the " + key + " of " + path_of(j) + " (line " +
                         std::to_string(tables[j].line_of(key)) + ")",
                     remedy);
    }
  }
}

const TomlNode& sensor_list(const GroupNode& group) {
  const TomlNode* list = group.node.find("sensor");
  const std::string& file = group.file;
  const bool gravity = group.field == FieldKind::gravity;
  const std::string section = gravity ? "[[sensor]]" : "[[group.sensor]]";
  const std::string form =
      "add one " + section + " section for each " + units_of(group.field).sensor + ", three at least";
  if (list == nullptr)
    throw Refusal(FileError{file, gravity ? 0 : group.node.line, group.prefix + "sensor",
                            gravity ? "the file describes no sensor" : "the group describes no sensor", form});
  if (list->kind != TomlNode::Kind::array)
    throw Refusal(FileError{file, list->line, group.prefix + "sensor",
                            "is " + std::string(list->kind_name()) + ", must be a list",
                            "write " + section + " with two brackets"});
  const std::size_t n = list->items.size();
  if (n < 3)
    throw Refusal(FileError{
        file, list->line, group.prefix + "sensor",
        "an array of " + count_text(n, "sensor") + " cannot determine a vector; at least 3 are needed", form});
  if (n > static_cast<std::size_t>(kCapacity)) {
    throw Refusal(
        FileError{file, list->items[static_cast<std::size_t>(kCapacity)].line,
                  path_of(static_cast<std::size_t>(kCapacity), group.prefix),
                  std::to_string(n) + " sensors are more than this build holds (" + std::to_string(kCapacity) + ")",
                  "remove sensors, or build plumb with a larger PLUMB_CAPACITY (24 at most)"});
  }
  return *list;
}

/// What no monitor takes (`kMaxSigmaRatio`), no other command takes either.
void refuse_unlike_noise(const std::vector<TomlTable>& tables, const Datasheet& sheet) {
  const auto sigma = [&sheet](std::size_t i) { return sheet.sensor[i].row.sigma_mps2; };
  std::size_t least = 0;
  for (std::size_t i = 1; i < tables.size(); ++i) least = sigma(i) < sigma(least) ? i : least;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (sigma(i) <= kMaxSigmaRatio * sigma(least)) continue;
    tables[i].fail(tables[i].line_of("noise"), "noise",
                   "is " + brief(sigma(i) / sigma(least)) + " times that of " + path_of(least) + " (line " +
                       std::to_string(tables[least].line_of("noise")) + "), at most 300 times can be used together",
                   "check the unit of both; leave out a sensor that is so much noisier than the others");
  }
}

/// The rules of SensorArray, in the words of the file.
SensorArray built_array(const std::vector<TomlTable>& tables, const Datasheet& sheet) {
  std::array<SensorRow, kCapacity> rows{};
  refuse_unlike_noise(tables, sheet);
  for (std::size_t i = 0; i < tables.size(); ++i) rows[i] = sheet.sensor[i].row;
  const Expected<SensorArray> array = SensorArray::make(rows.data(), sheet.size);
  if (array) return *array;
  const Error& error = array.error();
  if (error.code == Errc::axes_rank_deficient) {
    tables.front().fail(tables.front().line_of("axis"), "axis",
                        "the axes of all sensors lie in one plane (smallest singular value " + brief(error.value) +
                            "), so they cannot measure across it",
                        "check the axes for copies and wrong signs; at least one must point out of the plane of the "
                        "others");
  }
  const std::size_t i = error.index >= 0 && error.index < sheet.size ? static_cast<std::size_t>(error.index) : 0;
  const FileError words = from_error(error);
  tables[i].fail(tables[i].line(), "", words.what, words.remedy);
}

/// Where the sensors sit: of all of them, or of none.
std::vector<Vec3> read_lever_arms(const std::vector<TomlTable>& tables) {
  const auto given = [](const TomlTable& table) { return table.has("lever_arm_m"); };
  std::vector<Vec3> out;
  if (std::none_of(tables.begin(), tables.end(), given)) return out;
  const std::string form =
      "give every sensor its position relative to the axis of rotation in m: lever_arm_m = [0.02, 0.0, 0.35]";
  for (const TomlTable& table : tables) {
    out.push_back(table.need_vec3("lever_arm_m", form));
    const bool sound = norm(out.back()) <= kLongestArm_m;
    if (!sound) table.fail(table.line_of("lever_arm_m"), "lever_arm_m", "is longer than 100 m, or not a number", form);
  }
  return out;
}

/// The chip of each sensor, empty where it states none.
std::string read_package(const TomlTable& table) {
  if (!table.has("package")) return {};
  const std::string form = "name the chip that the sensor is on, alike for all axes of one chip: package = \"imu1\"";
  const std::string name = table.need_text("package", form);
  const bool fits = !name.empty() && name.size() <= kLongestPackage;
  if (!fits) table.fail(table.line_of("package"), "package", "must have 1 to 31 characters", form);
  return name;
}

/// The chips by number, in the order of the file; 0 where a sensor states none.
void number_chips(const std::vector<std::string>& package, Datasheet& sheet) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < package.size(); ++i) {
    if (package[i].empty()) continue;
    const auto found = std::find(names.begin(), names.end(), package[i]);
    sheet.sensor[i].row.chip = static_cast<std::uint8_t>(found - names.begin() + 1);
    if (found == names.end()) names.push_back(package[i]);
  }
}

/// Without a temperature in the log, nothing may depend on it, and every row gets the reference.
void settle_temperature(const std::vector<TomlTable>& tables, const Datasheet& sheet, InputSpec& input) {
  if (!input.temperature_column.empty()) return;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const char* key = tables[i].has("bias_t") ? "bias_t" : "scale_t";
    if (tables[i].has(key)) {
      tables[i].fail(tables[i].line_of(key), key, "needs the temperature, but [input] names no temperature column",
                     "add temperature = \"<column>\" to [input], or remove " + std::string(key));
    }
  }
  input.default_temperature_degc = sheet.sensor[0].coefficients.reference_degc;
}

}  // namespace

std::string package_of(const ArrayFile& array, int sensor) {
  const auto at = static_cast<std::size_t>(sensor);
  return at < array.package.size() ? array.package[at] : std::string();
}

void read_sensors(const GroupNode& group, ArrayFile& out) {
  const TomlNode& list = sensor_list(group);
  const Stability usual = read_usual_stability(group);
  const double length_mps2 = group.field == FieldKind::rate ? 0.0 : out.gravity.g_mps2;
  std::vector<TomlTable> tables;
  std::vector<std::string> ids;
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    tables.emplace_back(list.items[i], group.file, path_of(i, group.prefix), known_keys(group.field), group.field);
    out.datasheet.sensor[i] = read_sensor(tables.back(), {out.input.unit, length_mps2});
    if (group.field == FieldKind::rate) read_rate_bounds(tables.back(), out.rate.errors[i]);
    if (group.field != FieldKind::rate) out.stability[i] = read_stability(tables.back(), usual);
    if (group.field == FieldKind::gravity && read_motion_bounds(tables.back(), out.motion.sensor[i]))
      out.motion.mentioned = true;
    ids.push_back(tables.back().text("id", ""));
    columns.push_back(tables.back().text("column", ids.back()));
  }
  out.datasheet.size = static_cast<int>(tables.size());
  refuse_twins(tables, ids, "id", "give every sensor its own id (parallel axes are allowed, equal ids are not)");
  refuse_twins(tables, columns, "column", "give every sensor its own column of the log");
  for (const TomlTable& table : tables) out.package.push_back(read_package(table));
  number_chips(out.package, out.datasheet);
  out.array = built_array(tables, out.datasheet);
  settle_temperature(tables, out.datasheet, out.input);
  if (group.field == FieldKind::gravity) out.lever_arm_m = read_lever_arms(tables);
  out.input.sensor_columns = columns;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
