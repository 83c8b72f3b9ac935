#include "plumb/verification/limits.hpp"

#include <cmath>

#include "../io/refusal.hpp"
#include "../io/toml_table.hpp"
#include "plumb/core/units.hpp"
#include "plumb/detection/estimate_error.hpp"
#include "plumb/detection/set_test.hpp"
#include "plumb/io/output_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

using io::Quantity;
using io::TomlTable;

constexpr int kMostFaults = 8;

const io::TomlNode& table_of(const io::TomlNode& root, const std::string& path) {
  const io::TomlNode* node = root.find("limits");
  if (node == nullptr || node->kind != io::TomlNode::Kind::table) {
    throw io::Refusal(io::FileError{path, node == nullptr ? 0 : node->line, "limits",
                                    node == nullptr ? "is missing" : "is not a table",
                                    "write [limits] and below it, for example, alert_limit = \"0.5 deg\""});
  }
  return *node;
}

/// A rate or a size above zero, where it is given.
std::optional<double> positive(const TomlTable& table, Quantity quantity, const char* key, double most,
                               const std::string& remedy) {
  if (!table.has(key)) return std::nullopt;
  const double value = table.need_quantity(quantity, key, remedy);
  if (!(value > 0.0 && value <= most)) table.fail(table.line_of(key), key, "is out of range", remedy);
  return value;
}

UserLimits read(const io::TomlNode& root, const std::string& path, const io::ArrayFile& array) {
  const TomlTable top(root, path, "", {"limits"});
  const TomlTable table(table_of(root, path), path, "limits",
                        {"alert_limit", "faults", "false_alarm_rate", "misleading_rate", "wrong_exclusion_rate",
                         "fault", "detect_within"},
                        array.field);
  UserLimits out = limits_of(array);
  out.file = path;
  if (const auto alert = positive(table, Quantity::angle, "alert_limit", kPi, "an angle: \"0.25 deg\"")) {
    out.alert_limit_rad = *alert;
    out.alert_limit_from = "limits file";
  }
  if (table.has("faults")) {
    const std::int64_t faults = table.integer("faults", 1);
    if (faults < 1 || faults > kMostFaults)
      table.fail(table.line_of("faults"), "faults", "is out of range", "how many sensors at once: 1 to 8");
    out.faults = static_cast<int>(faults);
    out.faults_from = "limits file";
  }
  out.false_alarm_rate =
      positive(table, Quantity::ratio, "false_alarm_rate", 1.0, "alarms of a healthy tool per block: 1e-3");
  out.misleading_rate = positive(table, Quantity::ratio, "misleading_rate", 1.0, "share of scenarios: 1e-3");
  out.wrong_exclusion_rate = positive(table, Quantity::ratio, "wrong_exclusion_rate", 1.0, "share of scenarios: 1e-3");
  out.fault_mps2 = positive(
      table, Quantity::acceleration, "fault", 100.0,
      array.field == io::FieldKind::magnetic ? "an error of a reading: \"500 nT\"" : "an acceleration: \"5 mg0\"");
  out.detect_within_s = positive(table, Quantity::time, "detect_within", 1e9, "a time: \"2 s\"");
  return out;
}

}  // namespace

UserLimits limits_of(const io::ArrayFile& array) {
  UserLimits out;
  out.alert_limit_rad = array.monitor.alert_limit_rad;
  out.alert_limit_from =
      array.monitor.alert_limit_rad == MonitorConfig{}.alert_limit_rad ? "default of the monitor" : "array file";
  out.faults_from = "default";
  out.acceleration_bound_mps2 = array.monitor.acceleration_bound_mps2;
  out.acceleration_turn_rad = plumb::acceleration_turn_rad(array.gravity, out.acceleration_bound_mps2);
  return out;
}

io::FileExpected<UserLimits> parse_limits(const std::string& text, const std::string& path,
                                          const io::ArrayFile& array) {
  const io::FileExpected<io::TomlNode> root = io::parse_toml(text, path);
  if (!root) return tl::unexpected<io::FileError>(root.error());
  try {
    return read(*root, path, array);
  } catch (const io::Refusal& refusal) {
    return tl::unexpected<io::FileError>(refusal.error());
  }
}

io::FileExpected<UserLimits> read_limits(const std::string& path, const io::ArrayFile& array) {
  const io::FileExpected<std::string> text = io::read_file(path);
  if (!text) return tl::unexpected<io::FileError>(text.error());
  return parse_limits(*text, path, array);
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
