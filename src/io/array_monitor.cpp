#include <algorithm>
#include <vector>

#include "array_parts.hpp"
#include "plumb/paper/paper_rule.hpp"
#include "text_tools.hpp"
#include "toml_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// Keys in the order of the fields of MonitorConfig, which is the order of the indices of `checked`; then those that
/// are none of its fields.
const std::vector<std::string>& known_keys() {
  static const std::vector<std::string> names = with_stability_keys({"mode",
                                                                     "window",
                                                                     "delta_f",
                                                                     "false_alarm_rate",
                                                                     "rejection_rate",
                                                                     "assumed_faults",
                                                                     "isolation_stations",
                                                                     "isolation_timeout",
                                                                     "passed_blocks",
                                                                     "forget_blocks",
                                                                     "probation_stations",
                                                                     "missing_confirm",
                                                                     "max_age_samples",
                                                                     "max_gap",
                                                                     "max_age",
                                                                     "station_angle",
                                                                     "distinct_attitude_angle",
                                                                     "clear_fraction",
                                                                     "alert_limit",
                                                                     "integrity_risk",
                                                                     "fault_prior",
                                                                     "reset_key",
                                                                     "temperature_min",
                                                                     "temperature_max",
                                                                     "isolation_timeout_blocks",
                                                                     "alarm_form",
                                                                     "recalibrate",
                                                                     "alert_frame",
                                                                     "alignment_bound",
                                                                     "acceleration_bound",
                                                                     "triple_false_alarm_rate"});
  return names;
}

/// A vector that adds to that of the field and that no check can tell from it.
const char* bound_key(FieldKind field) noexcept {
  return field == FieldKind::magnetic ? "disturbance_bound" : "acceleration_bound";
}

const std::vector<std::string>& known_keys(FieldKind field) {
  static const std::vector<std::string> magnetic = [] {
    std::vector<std::string> names = known_keys();
    std::replace(names.begin(), names.end(), std::string(bound_key(FieldKind::gravity)),
                 std::string(bound_key(FieldKind::magnetic)));
    return names;
  }();
  return field == FieldKind::magnetic ? magnetic : known_keys();
}

int whole(const TomlTable& table, const char* key, int fallback) {
  const std::int64_t value = table.integer(key, fallback);
  if (value < -1 || value > 1000000000) {
    table.fail(table.line_of(key), key, "is " + std::to_string(value) + ", out of range",
               "give a count, usually below 100");
  }
  return static_cast<int>(value);
}

MonitorConfig filled(const TomlTable& table) {
  MonitorConfig config;
  config.mode = table.choice("mode", {"plumb", "paper"}, 0) == 1 ? MonitorMode::paper : MonitorMode::plumb;
  config.window = whole(table, "window", config.window);
  config.delta_f_mps2 =
      table.quantity(Quantity::acceleration, "delta_f", config.mode == MonitorMode::paper ? kPaperDeltaF_mps2 : 0.0);
  config.false_alarm_rate = table.quantity(Quantity::ratio, "false_alarm_rate", config.false_alarm_rate);
  config.rejection_rate = table.quantity(Quantity::ratio, "rejection_rate", config.rejection_rate);
  config.assumed_faults = whole(table, "assumed_faults", config.assumed_faults);
  config.isolation_stations = whole(table, "isolation_stations", config.isolation_stations);
  config.isolation_timeout = whole(table, "isolation_timeout", config.isolation_timeout);
  config.passed_blocks = whole(table, "passed_blocks", config.passed_blocks);
  config.forget_blocks = whole(table, "forget_blocks", config.forget_blocks);
  config.probation_stations = whole(table, "probation_stations", config.probation_stations);
  config.missing_confirm = whole(table, "missing_confirm", config.missing_confirm);
  config.max_gap_s = table.quantity(Quantity::time, "max_gap", config.max_gap_s);
  config.max_age_s = table.quantity(Quantity::time, "max_age", config.max_age_s);
  config.max_age_samples = whole(table, "max_age_samples", config.max_age_samples);
  config.station_angle_rad = table.quantity(Quantity::angle, "station_angle", config.station_angle_rad);
  config.distinct_attitude_angle_rad =
      table.quantity(Quantity::angle, "distinct_attitude_angle", config.distinct_attitude_angle_rad);
  config.clear_fraction = table.quantity(Quantity::ratio, "clear_fraction", config.clear_fraction);
  config.alert_limit_rad = table.quantity(Quantity::angle, "alert_limit", config.alert_limit_rad);
  config.integrity_risk = table.quantity(Quantity::ratio, "integrity_risk", config.integrity_risk);
  config.fault_prior = table.quantity(Quantity::ratio, "fault_prior", config.fault_prior);
  const std::int64_t key = table.integer("reset_key", static_cast<std::int64_t>(config.reset_key));
  if (key < 0)
    table.fail(table.line_of("reset_key"), "reset_key", "is negative",
               "give a whole number, 0 or more, for example 0x706c756d62");
  config.reset_key = static_cast<std::uint64_t>(key);
  config.temperature_min_degc = table.quantity(Quantity::temperature, "temperature_min", config.temperature_min_degc);
  config.temperature_max_degc = table.quantity(Quantity::temperature, "temperature_max", config.temperature_max_degc);
  config.recalibrate_after_exclusion = table.choice("recalibrate", {"never", "after-exclusion"}, 0) == 1;
  config.isolation_timeout_blocks = whole(table, "isolation_timeout_blocks", config.isolation_timeout_blocks);
  config.acceleration_bound_mps2 =
      table.quantity(Quantity::acceleration, bound_key(table.field_of()), config.acceleration_bound_mps2);
  const bool average = table.choice("alarm_form", {"every-tool", "average-tool"}, 0) == 1;
  config.alarm_form = average ? AlarmForm::average_tool : AlarmForm::every_tool;
  config.triple_false_alarm_rate =
      table.quantity(Quantity::ratio, "triple_false_alarm_rate", config.triple_false_alarm_rate);
  config.alignment_bound_rad = alignment_bound_of(
      table.quantity(Quantity::angle, "alignment_bound", static_cast<double>(config.alignment_bound_rad)));
  const bool axes = table.choice("alert_frame", {"housing", "calibrated-axes"}, 0) == 1;
  config.alert_frame = axes ? AlertFrame::calibrated_axes : AlertFrame::housing;
  return config;
}

/// Unit in which MonitorConfig holds the field of a key, for messages.
std::string unit_of(const std::string& key, FieldKind field) {
  if (key == "delta_f" || key == bound_key(field)) return std::string(" ") + units_of(field).coarse;
  if (key == "max_gap" || key == "max_age") return " s";
  if (key == "station_angle" || key == "distinct_attitude_angle" || key == "alert_limit" || key == "alignment_bound")
    return " rad";
  if (key == "temperature_min" || key == "temperature_max") return " degC";
  return "";
}

/// The refusal of `plumb::checked` in the words of the file.
[[noreturn]] void refuse_field(const TomlTable& table, const Error& error) {
  const bool known = error.index >= 0 && static_cast<std::size_t>(error.index) < known_keys().size();
  const std::string key = known ? known_keys(table.field_of())[static_cast<std::size_t>(error.index)] : "";
  const int line = table.line_of(key.c_str());
  if (error.code == Errc::not_finite) table.fail(line, key, "is not finite", "write a finite number");
  const std::string unit = unit_of(key, table.field_of());
  const bool vector = key == "delta_f" || key == bound_key(table.field_of());
  const double shown = vector ? units_of(table.field_of()).coarse_per_inside : 1.0;
  table.fail(line, key, "is " + brief(shown * error.value) + unit + ", out of range",
             std::string("give a value ") + (error.value < error.limit ? "of at least " : "of at most ") +
                 brief(shown * error.limit) + unit);
}

TomlNode no_table() {
  TomlNode nothing;
  nothing.kind = TomlNode::Kind::table;
  return nothing;
}

/// Of the node of the file, or of `nothing`, which must outlive it.
TomlTable monitor_table(const GroupNode& group, const TomlNode& nothing) {
  const TomlNode* node = group.node.find("monitor");
  return {node == nullptr ? nothing : *node, group.file, group.prefix + "monitor", known_keys(group.field),
          group.field};
}

}  // namespace

MonitorConfig read_monitor(const GroupNode& group) {
  const TomlNode nothing = no_table();
  const TomlTable table = monitor_table(group, nothing);
  const Expected<MonitorConfig> config = plumb::checked(filled(table));
  if (!config) refuse_field(table, config.error());
  if (group.field != FieldKind::gravity && config->mode == MonitorMode::paper)
    table.fail(table.line_of("mode"), "mode", "is \"paper\", which knows gravity only",
               "remove the key: sensors of another field are watched in mode \"plumb\"");
  return *config;
}

Stability read_usual_stability(const GroupNode& group) {
  const TomlNode nothing = no_table();
  return read_stability(monitor_table(group, nothing), {});
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
