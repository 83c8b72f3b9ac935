// [truth] and [[sensor_truth]] of the scenario file: what the sensors really are, which plumb does not know.
#include <algorithm>
#include <cmath>

#include "plumb/io/hash.hpp"
#include "scenario_parts.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

using scenario::Tool;
using scenario::TruthSpans;

/// The part of a seed from which `scenario::paper_tool` draws: one seed, one tool, here and in `plumb demo`.
constexpr std::uint64_t kTruthPart = 0;

const std::vector<std::string>& truth_keys() {
  static const std::vector<std::string> names = {"law", "bias", "scale", "tilt", "seed"};
  return names;
}

const std::vector<std::string>& sensor_keys() {
  static const std::vector<std::string> names = {"id",      "axis",  "scale", "bias",     "bias_t",
                                                 "scale_t", "t_ref", "cross", "lever_arm"};
  return names;
}

/// How far a sensor of this field lies from its datasheet where the scenario does not say. A gyro stays within what its
/// monitor takes for healthy: the least of its group.
TruthSpans usual_spans(const ArrayFile& array) {
  TruthSpans out;
  if (array.field == FieldKind::magnetic) out.bias_mps2 = 0.5 * kInside_per_ut;
  if (array.field != FieldKind::rate) return out;
  out.bias_mps2 = array.rate.errors[0].bias_radps;
  out.scale = array.rate.errors[0].scale;
  out.axis_rad = array.rate.errors[0].axis_rad;
  for (std::size_t i = 1; i < static_cast<std::size_t>(array.array.size()); ++i) {
    const RateErrors& e = array.rate.errors[i];
    out.bias_mps2 = std::min(out.bias_mps2, e.bias_radps);
    out.scale = std::min(out.scale, e.scale);
    out.axis_rad = std::min(out.axis_rad, e.axis_rad);
  }
  out.axis_rad /= std::sqrt(2.0);  // of two turns, about two directions
  return out;
}

/// Groups of one tool are drawn apart.
std::uint64_t part_of_group(const ArrayFile& array) {
  return array.group.empty() ? kTruthPart : fnv1a(array.group.data(), array.group.size());
}

Tool drawn(const TomlTable& table, const ArrayFile& array) {
  const Datasheet& datasheet = array.datasheet;
  const std::vector<std::string> laws = {"uniform", "normal", "none"};
  const int law = table.choice("law", laws, 0);
  if (law == 2) {
    refuse_unused(table, "none", {"law"});
    return scenario::perfect_tool(datasheet);
  }
  TruthSpans spans = usual_spans(array);
  spans.shape = law == 1 ? TruthSpans::Shape::normal : TruthSpans::Shape::uniform;
  const auto span = [&table](const char* key, Quantity quantity, double fallback, double high, const char* example) {
    return within(table, key, table.quantity(quantity, key, fallback), 0.0, high,
                  std::string("give the deviation from the datasheet, 0 or more, as in \"") + example + "\"");
  };
  spans.bias_mps2 = span("bias", Quantity::acceleration, spans.bias_mps2, 1e3, "20 mg0");
  spans.scale = span("scale", Quantity::ratio, spans.scale, 0.5, "2 %");
  spans.axis_rad = span("tilt", Quantity::angle, spans.axis_rad, kPi, "2 deg");
  return scenario::draw_tool(datasheet, scenario::derive_seed(read_seed(table, "seed", 1), part_of_group(array)),
                             spans);
}

const TomlNode* list_at(const TomlTable& table, const char* key, std::size_t least, std::size_t most,
                        const std::string& what, const std::string& form) {
  const TomlNode* list = table.find(key);
  if (list == nullptr) return nullptr;
  if (list->kind == TomlNode::Kind::array && list->items.size() >= least && list->items.size() <= most) return list;
  table.fail(list->line, key, "must be a list of " + what, form);
}

/// One coefficient of the scale: relative ("200 ppm/degC"), or in the unit of the scale ("1 uV/g0/degC"), which
/// alone can spell every double.
double scale_slope(const TomlTable& table, const std::string& name, const TomlNode& list, const std::string& text,
                   int order, const RawUnit& unit, double scale) {
  const FileExpected<double> relative = parse_temperature_slope(Quantity::ratio, text, order);
  if (relative) return *relative * scale;
  const std::string per = order == 1 ? "/degC" : "/degC^" + std::to_string(order);
  const std::string_view whole = trimmed(text);
  if (whole.size() > per.size() && whole.substr(whole.size() - per.size()) == per) {
    const FileExpected<double> absolute = parse_scale(whole.substr(0, whole.size() - per.size()), unit);
    if (absolute) return *absolute;
  }
  return table.checked(relative, name.c_str(), list);
}

/// Terms 1..3 of eqs (1), (2), replaced all three where the key is there.
void read_slopes(const TomlTable& table, const RawUnit& unit, SensorCoefficients& out) {
  for (const bool of_scale : {false, true}) {
    const char* key = of_scale ? "scale_t" : "bias_t";
    const std::string form =
        std::string("write ") + key +
        (of_scale ? " = [\"200 ppm/degC\", \"1 ppm/degC^2\"]" : " = [\"0.1 mg/degC\", \"2 ug/degC^2\"]");
    const TomlNode* list = list_at(table, key, 1, 3, "one to three coefficients", form);
    if (list == nullptr) continue;
    std::array<double, 4>& terms = of_scale ? out.scale : out.bias;
    for (std::size_t k = 1; k < 4; ++k) terms[k] = 0.0;
    for (std::size_t k = 1; k <= list->items.size(); ++k) {
      const TomlNode& item = list->items[k - 1];
      const std::string name = std::string(key) + "[" + std::to_string(k) + "]";
      if (item.kind != TomlNode::Kind::text)
        table.fail(list->line, name, std::string("is ") + item.kind_name() + ", must be a string with a unit", form);
      const int order = static_cast<int>(k);
      terms[k] =
          of_scale ? scale_slope(table, name, *list, item.text, order, unit, out.scale[0])
                   : table.checked(parse_temperature_slope(Quantity::acceleration, item.text, order, table.field_of()),
                                   name.c_str(), *list);
    }
  }
}

Vec3 read_axis(const TomlTable& table) {
  const std::string form = "give the true direction of the sensor: axis = [0.0, 0.0, 1.0]";
  const Vec3 axis = table.need_vec3("axis", form);
  const double length = norm(axis);
  if (std::abs(length - 1.0) <= kAxisLengthTolerance) return axis;
  table.fail(table.line_of("axis"), "axis", "is " + brief(length, 9) + " long, must be of unit length",
             length > 0.0 ? "divide it by its length: [" + shortest(axis[0] / length) + ", " +
                                shortest(axis[1] / length) + ", " + shortest(axis[2] / length) + "]"
                          : form);
}

void read_cross(const TomlTable& table, int sensor, SensorModel& model) {
  const auto n = static_cast<std::size_t>(model.size);
  const std::string form =
      "write the cross terms m_ij of eq (3) against all " + std::to_string(n) + " sensors, 0 for " + "none";
  const TomlNode* list = list_at(table, "cross", n, n, std::to_string(n) + " numbers", form);
  if (list == nullptr) return;
  for (std::size_t k = 0; k < n; ++k) {
    const TomlNode& item = list->items[k];
    const bool number = item.kind == TomlNode::Kind::number || item.kind == TomlNode::Kind::integer;
    if (!number || !(std::abs(item.number) <= 1.0))
      table.fail(list->line, "cross", "holds an entry that is not a number from -1 to 1", form);
    model.misalignment[static_cast<std::size_t>(sensor) * kCapacity + k] = item.number;
  }
}

/// Three lengths with their units.
Vec3 read_lever_arm(const TomlTable& table) {
  const std::string form =
      "give the position of the sensor relative to the axis of rotation: lever_arm = [\"0.012 m\", \"0 m\", \"0 m\"]";
  const TomlNode* list = list_at(table, "lever_arm", 3, 3, "a list of three lengths", form);
  Vec3 arm{};
  for (std::size_t k = 0; list != nullptr && k < 3; ++k) {
    const TomlNode& item = list->items[k];
    const std::string name = "lever_arm[" + std::to_string(k + 1) + "]";
    const std::string text = table.text_with_unit(item, name.c_str(), accepted_units(Quantity::length));
    arm[k] = table.checked(parse_quantity(Quantity::length, text), name.c_str(), *list);
    if (!(std::abs(arm[k]) <= 1e3)) table.fail(list->line, name, "is longer than 1 km", form);
  }
  return arm;
}

void read_scale(const TomlTable& table, const RawUnit& unit, SensorCoefficients& out) {
  const TomlNode* value = table.find("scale");
  if (value == nullptr) return;
  const std::string text = table.text_with_unit(*value, "scale", "V/g0, mV/g0, count/g0, count/(m/s^2), ...");
  const double scale = table.checked(parse_scale(text, unit), "scale", *value);
  // The slopes of the datasheet are relative to the scale, and stay so.
  for (std::size_t k = 1; k < 4; ++k) out.scale[k] *= scale / out.scale[0];
  out.scale[0] = scale;
}

void read_sensor(const TomlTable& table, int sensor, const RawUnit& unit, Tool& tool) {
  const auto s = static_cast<std::size_t>(sensor);
  SensorCoefficients& c = tool.model.sensor[s];
  if (table.has("axis")) tool.axes[s] = read_axis(table);
  read_scale(table, unit, c);
  if (const TomlNode* bias = table.find("bias"); bias != nullptr) {
    const std::string text = table.text_with_unit(*bias, "bias", accepted_raw_units(table.field_of()));
    c.bias[0] = table.checked(parse_as_acceleration(text, unit, c.scale[0]), "bias", *bias);
  }
  read_slopes(table, unit, c);
  c.reference_degc = table.quantity(Quantity::temperature, "t_ref", c.reference_degc);
  read_cross(table, sensor, tool.model);
  if (table.has("lever_arm")) tool.lever_arm_m[s] = read_lever_arm(table);
}

}  // namespace

Tool read_truth(const ScenarioSource& source, const ArrayFile& array) {
  Tool tool = drawn(section_of(source, "truth", truth_keys()), array);
  std::vector<std::string> ids;
  ids.reserve(static_cast<std::size_t>(array.array.size()));
  for (int i = 0; i < array.array.size(); ++i) ids.emplace_back(array.array.row(i).id.data());
  std::vector<std::string> seen;
  for (const TomlTable& table : tables_of(source, "sensor_truth", sensor_keys())) {
    const std::string id = table.need_text("id", "name the sensor that this table describes, one of: " + joined(ids));
    const auto at = std::find(ids.begin(), ids.end(), id);
    if (at == ids.end()) {
      table.fail(table.line_of("id"), "id", "the array has no sensor " + in_quotes(id),
                 did_you_mean(id, ids) + "sensors: " + joined(ids));
    }
    if (std::find(seen.begin(), seen.end(), id) != seen.end()) {
      table.fail(table.line_of("id"), "id", in_quotes(id) + " has two [[sensor_truth]] tables", "join them into one");
    }
    seen.push_back(id);
    read_sensor(table, static_cast<int>(at - ids.begin()), array.input.unit, tool);
  }
  return tool;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
