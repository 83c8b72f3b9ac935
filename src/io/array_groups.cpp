// [[group]]: sensors of another field on the same tool and in the same log.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "array_parts.hpp"
#include "motion_figure.hpp"
#include "refusal.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// What the Earth's field is between, with a margin: 22 to 67 uT.
constexpr double kLeastField_ut = 20.0, kMostField_ut = 70.0;
/// The sigma of a length that a monitor takes, in the group's inside unit.
constexpr double kMostSigma_ut = 0.1 / kInside_per_ut;
constexpr double kUsualSigma_ut = 0.13;

struct RateKey {
  Figure figure;
  double RateErrors::*field;
};

constexpr RateKey kErrors[] = {
    {{"scale_bound", "", 0.0, 0.4, "0.01"}, &RateErrors::scale},
    {{"axis_bound_rad", "rad", 0.0, 0.4, "0.01"}, &RateErrors::axis_rad},
    {{"bias_bound_radps", "rad/s", 0.0, 10.0, "0.006"}, &RateErrors::bias_radps},
    {{"lag_bound_s", "s", 0.0, 1.0, "20e-6"}, &RateErrors::lag_s},
    {{"g_sensitivity_bound_s_per_m", "(rad/s)/(m/s^2)", 0.0, 1.0, "2e-4"}, &RateErrors::g_sensitivity_s_per_m},
};

struct RateLimit {
  Figure figure;
  double RateSetup::*field;
};

constexpr Figure kPeriod{"sample_period_s", "s", 1e-5, 1.0, "0.001"};
constexpr RateLimit kLimits[] = {
    {{"rate_bound_radps", "rad/s", 0.0, 1000.0, "8"}, &RateSetup::rate_bound_radps},
    {{"force_bound_mps2", "m/s^2", 0.0, 1e5, "160"}, &RateSetup::force_bound_mps2},
    {{"at_rest_radps", "rad/s", 0.0, 1.0, "7.3e-5"}, &RateSetup::at_rest_radps},
    {{"false_alarms_per_hour", "", 1e-9, 1.0, "0.001"}, &RateSetup::false_alarms_per_hour},
    {{"dwell_s", "s", 0.0, 10.0, "0.064"}, &RateSetup::dwell_s},
    {{"quiet_s", "s", 0.0, 3600.0, "5"}, &RateSetup::quiet_s},
};

const std::vector<std::string>& group_keys(FieldKind field) {
  static const std::vector<std::string> magnetic = {"name", "field", "unit", "reference", "monitor", "sensor"};
  static const std::vector<std::string> rate = {"name", "field", "unit", "rate", "sensor"};
  return field == FieldKind::rate ? rate : magnetic;
}

double within(const TomlTable& table, const char* key, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return value;
  table.fail(table.line_of(key), key, "is " + brief(value) + " " + unit + ", out of range",
             "give " + brief(least) + " to " + brief(most) + " " + unit);
}

/// A vector's length or error in microtesla.
double field_ut(const TomlTable& table, const char* key, double fallback_ut) {
  return table.has(key) ? table.need_quantity(Quantity::acceleration, key, "") / kInside_per_ut : fallback_ut;
}

MagneticReference stated(const TomlTable& table) {
  MagneticReference out;
  out.source = "stated";
  (void)table.need("value",
                   "give the length of the field: value = \"50.8 uT\", or model = \"wmm\" with a place and a date");
  out.total_ut = within(table, "value", field_ut(table, "value", 0.0), kLeastField_ut, kMostField_ut, "uT");
  out.total_sigma_ut = kUsualSigma_ut;
  return out;
}

MagneticReference modelled(const TomlTable& table, const FieldLookup& lookup, ReferenceBasis& basis) {
  if (!lookup)
    table.fail(table.line_of("model"), "model", "is \"wmm\", and this program brings no model of the Earth's field",
               "read the file with geomagnetic::lookup, or state the field: model = \"value\", value = \"50.8 uT\"");
  MagneticPlace place;
  const char* const form =
      "say where and when: latitude = \"60.4 deg\", longitude = \"2.1 deg\", date = \"2026-03-31\"";
  place.latitude_deg = deg_from_rad(table.need_quantity(Quantity::angle, "latitude", form));
  place.longitude_deg = deg_from_rad(table.need_quantity(Quantity::angle, "longitude", form));
  place.height_m = table.quantity(Quantity::length, "height", 0.0);
  place.date = table.need_text("date", form);
  FileExpected<MagneticReference> found = lookup(place);
  if (found) {
    basis.place = place;
    return *std::move(found);
  }
  const std::string& key = found.error().field;
  table.fail(table.line_of(key.c_str()), key, found.error().what, found.error().remedy);
}

void refuse_unused(const TomlTable& table, const std::vector<std::string>& used) {
  for (const auto& member : table.node().members) {
    if (std::find(used.begin(), used.end(), member.first) == used.end())
      table.fail(member.second.line, member.first, "is not used by this model",
                 "remove it; this model uses: " + joined(used));
  }
}

MagneticReference read_reference(const GroupNode& group, const TomlNode& node, const FieldLookup& lookup,
                                 ReferenceBasis& basis) {
  static const std::vector<std::string> value = {"model", "value", "sigma", "dip", "dip_sigma"};
  static const std::vector<std::string> wmm = {"model", "latitude", "longitude", "height",
                                               "date",  "sigma",    "dip_sigma"};
  std::vector<std::string> known = value;
  known.insert(known.end(), wmm.begin() + 1, wmm.end());
  const TomlTable table(node, group.file, group.prefix + "reference", known, FieldKind::magnetic);
  const bool model = table.choice("model", {"value", "wmm"}, 0) == 1;
  refuse_unused(table, model ? wmm : value);
  MagneticReference out = model ? modelled(table, lookup, basis) : stated(table);
  const double sigma_ut = field_ut(table, "sigma", std::fmin(out.total_sigma_ut, kMostSigma_ut));
  out.total_sigma_ut = within(table, "sigma", sigma_ut, 0.0, kMostSigma_ut, "uT");
  if (table.has("dip")) {
    out.dip_rad = within(table, "dip", table.need_quantity(Quantity::angle, "dip", ""), -kPi / 2.0, kPi / 2.0, "rad");
    out.dip_sigma_rad = rad_from_deg(0.2);
    out.dip_known = true;
  }
  out.dip_sigma_rad = table.quantity(Quantity::angle, "dip_sigma", out.dip_sigma_rad);
  basis.total_sigma_stated = table.has("sigma");
  basis.dip_sigma_stated = table.has("dip_sigma");
  if (table.has("dip_sigma")) {
    if (!out.dip_known)
      table.fail(table.line_of("dip_sigma"), "dip_sigma", "is given without a dip", "add dip, or remove it");
    (void)within(table, "dip_sigma", out.dip_sigma_rad, 1e-6, 0.2, "rad");
  }
  return out;
}

/// The setup, and what the bias of any gyro may change by after its calibration.
std::pair<RateSetup, Stability> read_rate(const GroupNode& group, const InputSpec& input) {
  static const TomlNode nothing = [] {
    TomlNode node;
    node.kind = TomlNode::Kind::table;
    return node;
  }();
  std::vector<std::string> known = with_rate_keys({kPeriod.key, "max_faults", "stability"});
  for (const RateLimit& limit : kLimits) known.emplace_back(limit.figure.key);
  const TomlNode* node = group.node.find("rate");
  const TomlTable table(node == nullptr ? nothing : *node, group.file, group.prefix + "rate", known, FieldKind::rate);
  RateSetup out;
  if (input.rate_hz > 0.0) out.sample_period_s = 1.0 / input.rate_hz;
  if (!table.has(kPeriod.key) && !(input.rate_hz > 0.0))
    throw Refusal(
        FileError{group.file, group.node.line, group.prefix + "rate.sample_period_s", "is missing",
                  "give the time between two samples of the gyros in s: [group.rate] with sample_period_s = 0.01"});
  read_into(table, kPeriod, out.sample_period_s);
  for (const RateLimit& limit : kLimits) read_into(table, limit.figure, out.*limit.field);
  const std::int64_t faults = table.integer("max_faults", out.max_faults);
  if (faults < 1 || faults > kMotionDepth)
    table.fail(table.line_of("max_faults"), "max_faults", "is " + std::to_string(faults) + ", out of range",
               "give the most units that may be faulty at once, 1 to " + std::to_string(kMotionDepth));
  out.max_faults = static_cast<int>(faults);
  RateErrors usual;
  read_rate_bounds(table, usual);
  out.errors.fill(usual);
  return {out, read_stability(table, {})};
}

void read_magnetic(const GroupNode& group, const FieldLookup& lookup, ArrayFile& out) {
  const TomlNode* node = group.node.find("reference");
  if (node == nullptr)
    throw Refusal(FileError{group.file, group.node.line, group.prefix + "reference", "is missing",
                            "add [group.reference] with value = \"50.8 uT\", or with model = \"wmm\", latitude, "
                            "longitude and date"});
  out.magnetic = read_reference(group, *node, lookup, out.basis);
  out.gravity = {kInside_per_ut * out.magnetic.total_ut, kInside_per_ut * out.magnetic.total_sigma_ut,
                 GravityModel::magnetic};
  out.monitor = read_monitor(group);
}

/// The layout of the log is that of the file; what belongs to accelerometers alone is not.
InputSpec input_of(const TomlTable& table, const ArrayFile& tool, FieldKind field) {
  InputSpec out = tool.input;
  const std::string about = "state the unit of the group's columns, one of: " + accepted_raw_units(field);
  out.unit = table.checked(parse_raw_unit(table.need_text("unit", about), field), "unit", table.need("unit", about));
  out.corrected = false;
  out.rotation_columns.clear();
  out.second_rotation_columns.clear();
  out.known_attitudes.clear();
  return out;
}

/// It stands in the names of files and on command lines.
std::string read_name(const TomlTable& table, const char* usual) {
  constexpr std::size_t kLongest = 31;
  const std::string name = table.text("name", usual);
  const bool plain =
      name.size() <= kLongest && name.front() != '-' &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
  if (!plain)
    table.fail(table.line_of("name"), "name", "is " + in_quotes(name) + ", and names files and groups on command lines",
               "use 1 to 31 letters, digits, _ and -, not - first: name = \"mag\"");
  return name;
}

ArrayFile group_of(const TomlNode& node, const std::string& prefix, const ArrayFile& tool, const FieldLookup& lookup) {
  const std::string path = prefix.substr(0, prefix.size() - 1);
  const TomlTable any(node, tool.path, path, {"name", "field", "unit", "reference", "monitor", "rate", "sensor"});
  const FieldKind field = any.need_choice("field", {"magnetic", "rate"},
                                          "say what its sensors measure: field = \"magnetic\" or \"rate\"") == 0
                              ? FieldKind::magnetic
                              : FieldKind::rate;
  const TomlTable table(node, tool.path, path, group_keys(field), field);
  ArrayFile out;
  out.field = field;
  out.group = read_name(table, to_string(field));
  out.path = tool.path + "#" + out.group;
  out.name = tool.name + " " + out.group;
  out.text = tool.text;
  out.output_frame = tool.output_frame;
  out.input = input_of(table, tool, field);
  out.datasheet.reads = Reads::gravity;  // a sensor that points along the vector reads more
  const GroupNode group{node, tool.path, field, prefix};
  if (field == FieldKind::magnetic) read_magnetic(group, lookup, out);
  Stability since_calibration;
  if (field == FieldKind::rate) std::tie(out.rate, since_calibration) = read_rate(group, out.input);
  read_sensors(group, out);
  if (field == FieldKind::rate) out.stability.fill(since_calibration);
  out.fingerprint = fingerprint_of(out.datasheet, field);
  return out;
}

void refuse_shared(const std::vector<ArrayFile>& groups, const TomlNode& list, const std::string& file) {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::string prefix = "group[" + std::to_string(i + 1) + "].";
      if (groups[i].group == groups[j].group)
        throw Refusal(FileError{file, list.items[i].line, prefix + "name",
                                in_quotes(groups[i].group) + " is the name of two groups", "name them differently"});
      for (const std::string& column : groups[i].input.sensor_columns) {
        const auto& others = groups[j].input.sensor_columns;
        if (std::find(others.begin(), others.end(), column) != others.end())
          throw Refusal(FileError{file, list.items[i].line, prefix + "sensor",
                                  "column " + in_quotes(column) + " belongs to " + groups[j].group + " already",
                                  "give every sensor its own column of the log"});
      }
    }
  }
}

}  // namespace

void refuse_columns_of(const ArrayFile& tool, const std::vector<ArrayFile>& groups) {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const std::string& column : groups[i].input.sensor_columns) {
      const auto& own = tool.input.sensor_columns;
      if (std::find(own.begin(), own.end(), column) != own.end())
        throw Refusal(FileError{tool.path, 0, "group[" + std::to_string(i + 1) + "].sensor",
                                "column " + in_quotes(column) + " belongs to an accelerometer already",
                                "give every sensor its own column of the log"});
    }
  }
}

void refuse_gyros_of(const TomlNode& root, const ArrayFile& tool, const std::vector<ArrayFile>& groups) {
  const std::string& name = tool.motion.gyro.group;
  if (name.empty()) return;
  const int line = root.find("gyro")->find("group")->line;
  const auto refuse = [&tool, line](const std::string& what, const std::string& remedy) {
    throw Refusal(FileError{tool.path, line, "gyro.group", what, remedy});
  };
  std::string gyros;
  bool known = false;
  for (const ArrayFile& one : groups) {
    if (one.field != FieldKind::rate) continue;
    gyros += (gyros.empty() ? "" : ", ") + one.group;
    known = known || one.group == name;
  }
  if (!known)
    refuse("is " + in_quotes(name) + ", and no [[group]] of gyros is called so",
           gyros.empty() ? "add a [[group]] with field = \"rate\", or remove the key" : "name one of: " + gyros);
  if (!tool.motion.clocks.empty())
    refuse("does not go with [[clock]]: the rate of a group is that of a row, and is not interpolated",
           "log readings that were interpolated to one time (shortest_block in [motion]), and remove [[clock]]");
}

std::vector<std::string> with_rate_keys(std::vector<std::string> names) {
  for (const RateKey& key : kErrors) names.emplace_back(key.figure.key);
  return names;
}

void read_rate_bounds(const TomlTable& table, RateErrors& errors) {
  for (const RateKey& key : kErrors) read_into(table, key.figure, errors.*key.field);
}

std::vector<ArrayFile> read_groups(const TomlNode& root, const ArrayFile& tool, const FieldLookup& lookup) {
  std::vector<ArrayFile> out;
  const TomlNode* list = root.find("group");
  if (list == nullptr) return out;
  if (list->kind != TomlNode::Kind::array)
    throw Refusal(FileError{tool.path, list->line, "group", std::string("is ") + list->kind_name() + ", must be a list",
                            "write [[group]] with two brackets"});
  for (const TomlNode& node : list->items)
    out.push_back(group_of(node, "group[" + std::to_string(out.size() + 1) + "].", tool, lookup));
  refuse_shared(out, *list, tool.path);
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
