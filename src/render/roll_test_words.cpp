#include "plumb/render/roll_test_words.hpp"
#include "plumb/render/figures.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "plumb/core/units.hpp"
#include "plumb/io/records.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

bool is_validated(const Verdict& v) { return (v.qualifiers & Qualifier::not_yet_validated) == 0; }
bool in_doubt(const Verdict& v) { return v.state == HealthState::suspect && (is_validated(v) || !v.suspects.empty()); }

/// The sensor along whose axis gravity has to change; -1 where the turn is about no single sensor.
int sensor_along(const Vec3& along, const SensorArray& array) {
  constexpr double kRounding = 1e-9;
  for (int i = 0; i < array.size(); ++i) {
    if (norm(minus(array.axis(i), along)) < kRounding) return i;
  }
  return -1;
}

/// The monitor's own request, in words.
std::string turn_text(const RotationRequest& turn, const SensorArray& array, const Mat3& frame) {
  if (!(turn.change_mps2 > 0.0)) return fmt::format("a turn by {:.0f} deg or more", deg_from_rad(turn.angle_rad));
  const Vec3 along = io::in_frame(frame, turn.along);
  const int sensor = sensor_along(turn.along, array);
  const std::string whose = sensor < 0 ? "" : fmt::format(", the axis of {}", array.row(sensor).id.data());
  return fmt::format("a turn that changes gravity by {:.2f} m/s^2 along ({}, {}, {}){}", turn.change_mps2,
                     fixed_words(along[0], 3), fixed_words(along[1], 3), fixed_words(along[2], 3), whose);
}

std::string missing_text(const session::RollTest& test, const HealthMonitor& monitor, const Mat3& frame) {
  const Verdict& v = test.run.last;
  const MonitorConfig& config = monitor.config();
  if (test.run.blocks == 0)
    return fmt::format("no block was at rest: hold the tool still for {} or more at a time",
                       count_text(config.window, "row"));
  if (v.wants_rotation && v.rotation.change_mps2 > 0.0)
    return "still missing is " + turn_text(v.rotation, monitor.array(), frame);
  return fmt::format("still missing {} {} in a row in which all sensors agree",
                     by_count(config.passed_blocks, "is", "are"),
                     count_text(config.passed_blocks, "block at rest", "blocks at rest"));
}

/// "a3 excluded, a5 absent": whoever does not serve in the run.
std::string out_of_service_text(const Verdict& v, const SensorArray& array) {
  const std::pair<SensorSet, const char*> sets[] = {
      {v.excluded, "excluded"}, {v.provisionally_excluded, "provisionally excluded"}, {v.absent, "absent"}};
  std::string out;
  for (const auto& [set, word] : sets) {
    if (!set.empty()) out += fmt::format("{} {}; ", sensor_names(set, array), word);
  }
  return out;
}

std::string doubt_text(const Verdict& v, const SensorArray& array, const Mat3& frame) {
  std::string out = fmt::format("ended in suspect ({}: {})", to_string(v.cause), explain(v.cause));
  if (!v.suspects.empty()) out += fmt::format(", suspected are {}", sensor_names(v.suspects, array));
  if (v.wants_rotation && v.rotation.wanted) out += "; remedy: " + turn_text(v.rotation, array, frame);
  return out;
}

}  // namespace

std::string roll_test_text(const session::RollTest& test, const std::string& path, const HealthMonitor& monitor,
                           const Mat3& frame) {
  const Verdict& v = test.run.last;
  const SensorArray& array = monitor.array();
  std::string out = fmt::format("plumb: roll test {}: {}, {}", path, count_text(test.run.samples, "sample"),
                                count_text(test.attitudes, "attitude at rest", "attitudes at rest"));
  if (test.run.log.rows_bad > 0) out += fmt::format(", {} skipped", count_text(test.run.log.rows_bad, "bad row"));
  out += "; ";
  if (v.state == HealthState::failed) {
    const bool timed_out = (v.qualifiers & Qualifier::timed_out) != 0;
    const std::string why = timed_out ? explain(Cause::isolation_timeout) : "too few sensors are left";
    return out +
           fmt::format("ended in failed, because {}: no output of the run is valid until a reset (--host)\n", why);
  }
  out += out_of_service_text(v, array);
  if (in_doubt(v)) out += doubt_text(v, array, frame) + "; ";
  out += is_validated(v) ? fmt::format("validated: {}", sensor_names(v.in_service, array))
                         : "not validated: " + missing_text(test, monitor, frame);
  return out + fmt::format("; the run begins in {}\n", to_string(v.state));
}

io::Json roll_test_json(const session::RollTest& test, const HealthMonitor& monitor, const Mat3& frame) {
  return io::object({{"samples", test.run.samples},
                     {"rows_bad", test.run.log.rows_bad},
                     {"blocks", test.run.blocks},
                     {"attitudes", test.attitudes},
                     {"validated", is_validated(test.run.last)},
                     {"last_verdict", io::parsed(io::verdict_json(test.run.last, monitor.array(), frame))}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
