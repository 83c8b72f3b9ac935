#include "plumb/io/motion_records.hpp"

#include <cmath>

#include "json_object.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr const char* kColumns[] = {
    "t_s",           "force_t_s",        "fx_mps2",        "fy_mps2",        "fz_mps2",       "bound_mps2",
    "validity",      "dominant",         "gyro_assumed",   "block_t_s",      "block_fx_mps2", "block_fy_mps2",
    "block_fz_mps2", "block_bound_mps2", "block_validity", "block_dominant", "alarm",         "suspects",
    "isolated",      "excluded",         "cause",          "gyros_disagree"};

void append_cell(std::string& out, double value) {
  if (std::isfinite(value)) append_shortest(out, value);
  out += ',';
}

/// Seven cells; all but the validity are empty where there is no force.
void append_force(std::string& out, const SpecificForce& force, const Mat3& frame) {
  const bool known = force.validity != ForceValidity::none;
  const Vec3 f = in_frame(frame, force.force_mps2);
  const double nothing = std::nan("");
  append_cell(out, known ? force.time_s : nothing);
  for (const double part : f) append_cell(out, known ? part : nothing);
  append_cell(out, known ? force.bound_mps2 : nothing);
  out.append(to_string(force.validity)).append(",");
  if (known) out += to_string(force.dominant);
  out += ',';
}

/// "a1 a3": no comma, so that it is one cell.
void append_ids(std::string& out, SensorSet set, const SensorArray& array) {
  bool first = true;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    if (!first) out += ' ';
    first = false;
    out += array.row(i).id.data();
  }
  out += ',';
}

}  // namespace

const char* to_string(MotionEventKind kind) noexcept {
  switch (kind) {
    case MotionEventKind::alarm: return "alarm";
    case MotionEventKind::isolated: return "isolated";
    case MotionEventKind::excluded: return "excluded";
    case MotionEventKind::alarm_over: return "alarm_over";
    case MotionEventKind::forgotten: return "forgotten";
    case MotionEventKind::gyros_disagree: return "gyros_disagree";
  }
  return "?";
}

void append_motion_event_json(std::string& out, const MotionEvent& event, const SensorArray& array) {
  Object object(out);
  object.number("t_s", event.time_s);
  object.word("motion", to_string(event.kind));
  object.sensors("sensors", event.sensors, array);
  object.word("cause", to_string(event.cause));
  object.whole("least_faults", event.least_faults);
  object.close();
}

std::string inclination_csv_header() {
  return "t_s,span_s,status,inclination_deg,low_deg,high_deg,widest,gyro_assumed\n";
}

void append_inclination_row(std::string& out, const InclinationInterval& interval) {
  const bool known = interval.status == InclinationStatus::known;
  const bool full = known || interval.status == InclinationStatus::contradicts_gravity;
  const double nothing = std::nan("");
  append_cell(out, full ? interval.time_s : nothing);
  append_cell(out, full ? interval.span_s : nothing);
  out.append(to_string(interval.status)).append(",");
  for (const double angle_rad : {interval.inclination_rad, interval.low_rad, interval.high_rad})
    append_cell(out, known ? deg_from_rad(angle_rad) : nothing);
  if (known) out += to_string(interval.widest);
  out += known && interval.gyro_assumed ? ",1\n" : ",0\n";
}

std::string motion_csv_header() {
  std::string out;
  for (const char* column : kColumns) out.append(out.empty() ? "" : ",").append(column);
  return out + "\n";
}

void append_motion_row(std::string& out, double time_s, const MotionVerdict& verdict, const SensorArray& array,
                       const Mat3& frame) {
  append_cell(out, time_s);
  append_force(out, verdict.sample, frame);
  out += verdict.sample.gyro_assumed ? "1," : "0,";
  if (verdict.block_ended) {
    append_force(out, verdict.block, frame);
  } else {
    out.append(7, ',');
  }
  out += verdict.alarm ? "1," : "0,";
  append_ids(out, verdict.suspects, array);
  append_ids(out, verdict.isolated, array);
  append_ids(out, verdict.excluded, array);
  out.append(to_string(verdict.cause)).append(verdict.gyros_disagree ? ",1\n" : ",0\n");
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
