#include "plumb/render/monitor_summary.hpp"

#include <fmt/format.h>

#include "plumb/core/units.hpp"
#include "plumb/io/field_json.hpp"
#include "plumb/io/records.hpp"
#include "plumb/navigation/tilt.hpp"
#include "plumb/render/calibration_notes.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/measured_words.hpp"
#include "plumb/render/run_findings.hpp"
#include "plumb/render/sensor_notes.hpp"
#include "plumb/render/timeline.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

/// What a recalibration is at, or why the last one was refused; empty where there was none.
std::string recalibration_text(const Verdict& v, const SensorArray& sensors, const Mat3& frame) {
  const RecalibrationProgress& p = v.recalibration;
  if (v.state != HealthState::recalibrating) {
    return p.last_refusal.code == Errc::ok ? ""
                                           : fmt::format("recalibrate refused: {}\n", describe(p.last_refusal.code));
  }
  std::string out =
      fmt::format("recalibrate {}: {}, {} held out", to_string(p.phase), count_text(p.stations, "station"), p.held_out);
  if (p.stations_wanted > 0) {
    const Tilt tilt = tilt_of(io::in_frame(frame, p.wanted_direction), Mat3{});
    out += fmt::format(", {} more wanted, best at inclination {:.0f} deg", p.stations_wanted,
                       deg_from_rad(tilt.inclination_rad));
    if (tilt.toolface_valid) out += fmt::format(", toolface {:.0f} deg", deg_from_rad(tilt.toolface_rad));
  }
  if (!p.lacking.empty()) out += fmt::format("; too little change along {}", sensor_names(p.lacking, sensors));
  if (p.last_refusal.code != Errc::ok)
    out += fmt::format("; the last fit was refused: {}", describe(p.last_refusal.code));
  return out + "\n";
}

/// "a1, a3 (noisy)": with the cause where a channel shows one of its own.
std::string names_with_causes(SensorSet set, const Verdict& v, const SensorArray& sensors) {
  std::string out;
  for (int i = 0; i < sensors.size(); ++i) {
    if (!set.has(i)) continue;
    const Cause cause = v.sensor_cause[static_cast<std::size_t>(i)];
    const bool shown = cause == Cause::noisy || cause == Cause::stuck || cause == Cause::clipped;
    out += (out.empty() ? "" : ", ") + std::string(sensors.row(i).id.data());
    if (shown) out += fmt::format(" ({})", to_string(cause));
  }
  return out.empty() ? "-" : out;
}

/// What of drift the run allowed for; the paper's method allows for none.
std::string drift_of(const io::ArrayFile& array, double days) {
  if (array.monitor.mode == MonitorMode::paper) return "none allowed for: the paper's algorithm takes none";
  return drift_words(array, days);
}

}  // namespace

std::string summary_text(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors,
                         double days, const MotionTold& motion) {
  const Mat3& frame = array.output_frame;
  const Verdict& v = run.last;
  std::string out = fmt::format("\nstate       {}: {}\n", to_string(v.state), meaning(v.state));
  out += fmt::format("log         {}, {}, {}, {} skipped\n", count_text(run.samples, "sample"),
                     count_text(run.blocks, "block at rest", "blocks at rest"), count_text(run.transitions, "change"),
                     count_text(run.log.rows_bad, "bad row"));
  const bool failed = v.state == HealthState::failed;
  out += fmt::format("in service  {}\n", failed ? "none" : sensor_names(v.in_service, sensors));
  out += fmt::format("excluded    {}\n", names_with_causes(v.excluded, v, sensors));
  if (!v.provisionally_excluded.empty())
    out += fmt::format("provisional {}\n", names_with_causes(v.provisionally_excluded, v, sensors));
  if (!v.absent.empty()) out += fmt::format("absent      {}\n", sensor_names(v.absent, sensors));
  out += recalibration_text(v, sensors, frame);
  double inclination_deg = 0.0;
  const bool known = inclination_of(v.gravity_mps2, frame, inclination_deg);
  out += fmt::format("inclination {}, {} ({})\n",
                     known ? angle_words(inclination_deg, inclination_sigma_of(v, frame)) + " deg" : "not known",
                     to_string(v.validity),
                     v.alert && v.validity >= Validity::degraded
                         ? "not to be used: the alert is on, the error may be above the alert limit"
                         : meaning(v.validity));
  out += "protection  ";
  out += v.protection_available
             ? fmt::format(
                   "the direction is within {:.3f} deg of the truth in the calibrated axes, within {:.3f} deg in "
                   "the housing\n",
                   deg_from_rad(v.protection_level_calibrated_axes_rad), deg_from_rad(v.protection_level_housing_rad))
             : std::string("no bound on the error can be given\n");
  out += notes_text(run, array, sensors) + findings_text(v, array) + "drift       " + drift_of(array, days) + "\n" +
         motion_text(motion, array);
  return in_field_words(std::move(out), array.field);
}

std::string summary_json(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors,
                         double days, const io::Json& roll_test, const MotionTold& motion) {
  nlohmann::ordered_json s;
  if (!array.group.empty()) s["group"] = array.group;
  s["state"] = to_string(run.last.state);
  s["output"] = to_string(run.last.validity);
  s["samples"] = run.samples;
  s["blocks"] = run.blocks;
  s["blocks_in_motion"] = run.counts.known ? io::Json(run.counts.blocks_in_motion) : io::Json();
  s["changes"] = run.transitions;
  s["rows_bad"] = run.log.rows_bad;
  s["last_time_s"] = run.last_time_s;
  s["interrupted"] = run.interrupted;
  s["days_since_calibration"] = days;
  for (int i = 0; i < sensors.size(); ++i) {
    io::Json& one = s["sensors"].emplace_back(io::object({{"id", sensors.row(i).id.data()}}));
    put_sensor_counts(one, run, array, sensors, i);
  }
  s["common_cause"] = common_cause_json(run, array, sensors);
  if (!roll_test.is_null()) s["roll_test"] = roll_test;
  if (motion.any()) s["motion"] = motion_json(motion, array);
  s["last_verdict"] = io::parsed(io::verdict_json(run.last, sensors, array.output_frame));
  return io::in_field_units(io::object({{"summary", std::move(s)}}), array.field).dump() + "\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
