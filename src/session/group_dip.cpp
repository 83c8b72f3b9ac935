#include "plumb/session/group_dip.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

constexpr double kNt_per_inside = 1e3 / io::kInside_per_ut;

double dip_of(const Vec3& gravity, const Vec3& field) {
  return std::asin(std::clamp(dot(gravity, field) / (norm(gravity) * norm(field)), -1.0, 1.0));
}

double allowed_of(const TrackPoint& gravity, const TrackPoint& field, const io::MagneticReference& reference) {
  return gravity.bound_rad + field.bound_rad + kDipSigmas * reference.dip_sigma_rad;
}

/// The bound of the field's direction holds its noise, disturbance, calibration and a faulty magnetometer: all of it is
/// a turn. Its length may be off by noise and disturbance.
FieldReading reading_of(const TrackPoint& field, double alignment_rad) {
  FieldReading out;
  out.field_nt = scaled(field.vector, kNt_per_inside);
  out.turn_rad = field.bound_rad + alignment_rad;
  return out;
}

FieldReference reference_of(const io::ArrayFile& group, const TrackPoint& field) {
  const io::MagneticReference& known = group.magnetic;
  const double off = group.monitor.acceleration_bound_mps2 + kDipSigmas * std::sqrt(3.0) * field.sigma;
  return {1e3 * known.total_ut,
          {1e3 * known.total_sigma_ut, kNt_per_inside * off},
          known.dip_rad,
          {known.dip_sigma_rad, 0.0}};
}

bool is_fault(DipVerdict verdict) noexcept {
  return verdict == DipVerdict::fault || verdict == DipVerdict::unexplained;
}

io::Json named_json(const DipAnswer& answer, const SensorArray& array) {
  return answer.named < 0 ? io::Json() : io::Json(array.row(answer.named).id.data());
}

}  // namespace

bool DipCheck::add(const TrackPoint& gravity, const TrackPoint& field, const io::MagneticReference& reference) {
  const double dip_rad = dip_of(gravity.vector, field.vector), allowed_rad = allowed_of(gravity, field, reference);
  const double excess_rad = std::fabs(dip_rad - reference.dip_rad) - allowed_rad;
  least_rad = checked == 0 ? dip_rad : std::fmin(least_rad, dip_rad);
  most_rad = checked == 0 ? dip_rad : std::fmax(most_rad, dip_rad);
  widest_allowed_rad = std::fmax(widest_allowed_rad, allowed_rad);
  ++checked;
  if (excess_rad <= 0.0) return false;  // what is not a number does not agree
  if (disagreeing++ == 0) first_s = field.end_s;
  worst_excess_rad = std::fmax(worst_excess_rad, excess_rad);
  return true;
}

GroupDip::GroupDip(const io::ArrayFile& tool, const io::ArrayFile& group) : tool_(tool), group_(group) {}

void GroupDip::judge(const HealthMonitor& monitor, std::unique_ptr<MonitorSetup> setup) {
  monitor_ = &monitor;
  setup_ = std::move(setup);
}

io::FileExpected<void> GroupDip::put(const DipEvent& event) {
  io::FileExpected<void> done;
  for (const Sink& sink : sinks_) {
    if (done) done = sink(event);
  }
  return done;
}

io::FileExpected<void> GroupDip::take(const TrackPoint& block, bool is_field) {
  (is_field ? last_field_ : last_gravity_) = block;
  waiting_ = waiting_ || is_field;
  io::FileExpected<void> done = compare();
  if (done && !is_field) done = judge_three(block);
  return done;
}

/// Every block of the field once, with the first of gravity that it meets.
io::FileExpected<void> GroupDip::compare() {
  if (!waiting_ || !last_gravity_ || !last_gravity_->meets(*last_field_)) return {};
  waiting_ = false;
  const TrackPoint &gravity = *last_gravity_, &field = *last_field_;
  if (!gravity.usable || !field.usable) return {};
  const bool before = std::exchange(disagree_, check_.add(gravity, field, group_.magnetic));
  if (disagree_ == before) return {};
  DipEvent event;
  event.kind = disagree_ ? DipEventKind::disagree : DipEventKind::agree;
  event.time_s = std::fmax(gravity.end_s, field.end_s);
  event.dip_rad = dip_of(gravity.vector, field.vector);
  event.allowed_rad = allowed_of(gravity, field, group_.magnetic);
  return put(event);
}

io::FileExpected<void> GroupDip::judge_three(const TrackPoint& gravity) {
  if (monitor_ == nullptr || !last_field_ || !last_field_->usable || !last_field_->meets(gravity)) return {};
  const DipReport said =
      watch_.add(*monitor_, *setup_, reading_of(*last_field_, static_cast<double>(tool_.monitor.alignment_bound_rad)),
                 reference_of(group_, *last_field_));
  if (said.answer.verdict == DipVerdict::not_judged) return {};
  const DipAnswer before = three_.last.answer;
  now_s_ = gravity.end_s;
  three_.last = said;
  ++three_.judged;
  three_.protected_by_dip += said.protected_by_dip ? 1 : 0;
  if (said.answer.named >= 0) three_.named = three_.named.with(said.answer.named);
  if (is_fault(said.answer.verdict) && three_.faulty++ == 0) three_.first_fault_s = gravity.end_s;
  const bool changed = said.answer.verdict != before.verdict || said.answer.named != before.named;
  if (!changed) return {};
  DipEvent event;
  event.kind = DipEventKind::judged;
  event.time_s = gravity.end_s;
  event.answer = said.answer;
  return put(event);
}

std::string GroupDip::doubt() const {
  if (check_.disagreeing > 0) return "gravity and the field of " + group_.group + " disagree by the dip";
  if (three_.faulty > 0) return "the dip of " + group_.group + " contradicts the three accelerometers left";
  return "";
}

void GroupDip::append(const Verdict& verdict, std::string& object) const {
  if (!verdict.tick || three_.judged == 0 || verdict.time_s != now_s_) return;
  const DipReport& r = three_.last;
  const SensorArray& array = monitor_->array();
  const Vec3 shown = times(tool_.output_frame, r.gravity_mps2);
  const io::Json dip =
      io::object({{"group", group_.group},
                  {"verdict", to_string(r.answer.verdict)},
                  {"named", named_json(r.answer, array)},
                  {"suspects", io::ids_of(r.answer.suspects, array)},
                  {"protected", r.protected_by_dip},
                  {"protection_level_calibrated_axes_deg", deg_from_rad(r.protection_level_calibrated_axes_rad)},
                  {"protection_level_housing_deg", deg_from_rad(r.protection_level_housing_rad)},
                  {"gravity_mps2", io::Json::array({shown[0], shown[1], shown[2]})}});
  object.insert(object.size() - 1, ",\"dip\":" + dip.dump());
}

std::string dip_event_json(const DipEvent& event, const io::ArrayFile& group, const SensorArray& accelerometers) {
  io::Json out = io::object({{"t_s", event.time_s}, {"group", group.group}});
  if (event.kind == DipEventKind::judged) {
    out["event"] = "dip_judged";
    out["verdict"] = to_string(event.answer.verdict);
    out["named"] = named_json(event.answer, accelerometers);
    out["suspects"] = io::ids_of(event.answer.suspects, accelerometers);
  } else {
    out["event"] = event.kind == DipEventKind::disagree ? "dip_disagrees" : "dip_agrees";
    out["dip_deg"] = deg_from_rad(event.dip_rad);
    out["expected_deg"] = deg_from_rad(group.magnetic.dip_rad);
    out["allowed_deg"] = deg_from_rad(event.allowed_rad);
  }
  return out.dump();
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
