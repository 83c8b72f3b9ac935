#include "plumb/io/records.hpp"

#include <cmath>
#include <cstdint>

#include "json_object.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/units.hpp"
#include "plumb/navigation/tilt.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// Length of the UTF-8 sequence that starts at `i`, 0 where it is not well formed.
std::size_t utf8_length(std::string_view text, std::size_t i) noexcept {
  const auto byte = [&text](std::size_t k) {
    return k < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[k])) : 0U;
  };
  const unsigned lead = byte(i);
  std::size_t length = 0;
  unsigned lowest = 0x80;  // of the second byte: rules out overlong forms, surrogates and > U+10FFFF
  unsigned highest = 0xBF;
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) length = 2;
  if (lead >= 0xE0 && lead <= 0xEF) length = 3;
  if (lead >= 0xF0 && lead <= 0xF4) length = 4;
  if (lead == 0xE0) lowest = 0xA0;
  if (lead == 0xED) highest = 0x9F;
  if (lead == 0xF0) lowest = 0x90;
  if (lead == 0xF4) highest = 0x8F;
  if (length == 0 || byte(i + 1) < lowest || byte(i + 1) > highest) return 0;
  for (std::size_t k = 2; k < length; ++k) {
    if (byte(i + k) < 0x80 || byte(i + k) > 0xBF) return 0;
  }
  return length;
}

void append_masks(Object& object, const Verdict& v, const SensorArray& array) {
  object.sensors("configured", v.configured, array);
  object.sensors("in_service", v.in_service, array);
  object.sensors("provisionally_excluded", v.provisionally_excluded, array);
  object.sensors("excluded", v.excluded, array);
  object.sensors("absent", v.absent, array);
  object.sensors("suspects", v.suspects, array);
  object.sensors("clipped", v.clipped, array);
  object.sensors("scattering", v.scattering, array);
  object.sensors("not_finite", v.not_finite, array);
  object.sensors("noisy", v.noisy, array);
  object.sensors("stuck", v.stuck, array);
  object.sensors("contradicted_clip", v.contradicted_clip, array);
  object.causes("sensor_cause", v, array.size());
  object.minimum_faults("minimum_faults", v, array.size());
}

/// null where no turn is asked for; `along` null where any does.
void append_rotation(Object& object, const Verdict& v, const Mat3& frame) {
  if (!v.rotation.wanted) {
    object.nothing("rotation");
    return;
  }
  Object inner = object.object("rotation");
  if (v.rotation.change_mps2 > 0.0) {
    inner.numbers("along", in_frame(frame, v.rotation.along));
  } else {
    inner.nothing("along");
  }
  inner.number("change_mps2", v.rotation.change_mps2);
  inner.number("angle_deg", deg_from_rad(v.rotation.angle_rad));
  inner.close();
}

/// null unless the length has been off.
void append_reference(Object& object, const Verdict& v, const Mat3& frame) {
  if (v.norm_mismatch.kind == NormMismatchKind::none) {
    object.nothing("norm_mismatch");
    return;
  }
  Object inner = object.object("norm_mismatch");
  inner.word("kind", to_string(v.norm_mismatch.kind));
  inner.whole("attitudes", v.norm_mismatch.attitudes);
  inner.number("length_mps2", v.norm_mismatch.length_mps2);
  inner.number_if(v.norm_mismatch.length_bound_mps2 > 0.0, "length_bound_mps2", v.norm_mismatch.length_bound_mps2);
  inner.number_if(v.norm_mismatch.configure_mps2 > 0.0, "configure_mps2", v.norm_mismatch.configure_mps2);
  inner.number_if(v.norm_mismatch.widened_mps2 > 0.0, "widened_mps2", v.norm_mismatch.widened_mps2);
  inner.numbers("bias_mps2", in_frame(frame, v.norm_mismatch.bias_mps2));
  inner.number_if(v.norm_mismatch.turn_rad > 0.0, "turn_deg", deg_from_rad(v.norm_mismatch.turn_rad));
  inner.close();
}

/// null unless the first attitudes contradict the calibration.
void append_contradiction(Object& object, const Verdict& v) {
  if (!v.calibration.contradicted) {
    object.nothing("calibration_contradicted");
    return;
  }
  Object inner = object.object("calibration_contradicted");
  inner.whole("attitudes", v.calibration.attitudes);
  inner.number("ratio", v.calibration.ratio);
  inner.flag("refused", v.calibration.refused);
  inner.number_if(v.calibration.tolerance_mps2 > 0.0, "tolerance_mps2", v.calibration.tolerance_mps2);
  inner.close();
}

/// null unless a fit is being made or one was refused.
void append_recalibration(Object& object, const Verdict& v, const SensorArray& array, const Mat3& frame) {
  const RecalibrationProgress& p = v.recalibration;
  const bool refused = p.last_refusal.code != Errc::ok;
  if (v.state != HealthState::recalibrating && !refused) {
    object.nothing("recalibration");
    return;
  }
  Object inner = object.object("recalibration");
  inner.word("phase", to_string(p.phase));
  inner.flag("offered", p.offered);
  inner.whole("stations", p.stations);
  inner.whole("held_out", p.held_out);
  inner.whole("stations_wanted", p.stations_wanted);
  inner.sensors("lacking", p.lacking, array);
  inner.numbers("wanted_direction", in_frame(frame, p.wanted_direction));
  if (refused) {
    inner.word("refused", describe(p.last_refusal.code));
  } else {
    inner.nothing("refused");
  }
  inner.close();
}

int triple_count(const TripleSet& set, const SensorArray& array) {
  int count = 0;
  for (int k = 0; k < array.triple_count(); ++k) count += set.has(k) ? 1 : 0;
  return count;
}

void append_vector(Object& object, const Verdict& v, const Mat3& frame) {
  const Vec3 gravity = in_frame(frame, v.gravity_mps2);
  const Mat3 covariance = covariance_in_frame(frame, v.covariance);
  const Tilt tilt = tilt_of(gravity, covariance);
  object.number_if(tilt.inclination_valid, "inclination_deg", deg_from_rad(tilt.inclination_rad));
  object.number_if(tilt.inclination_valid, "inclination_sigma_deg", deg_from_rad(tilt.inclination_sigma_rad));
  object.number_if(tilt.toolface_valid, "toolface_deg", deg_from_rad(tilt.toolface_rad));
  object.number_if(tilt.toolface_valid, "toolface_sigma_deg", deg_from_rad(tilt.toolface_sigma_rad));
  object.number_if(v.protection_available, "protection_level_calibrated_axes_deg",
                   deg_from_rad(v.protection_level_calibrated_axes_rad));
  object.number_if(v.protection_available, "protection_level_housing_deg",
                   deg_from_rad(v.protection_level_housing_rad));
  object.flag("protection_available", v.protection_available);
  object.whole("faults_covered", v.faults_covered);
  object.flag("alert", v.alert);
  object.number("age_s", v.age_s);
  object.numbers("gravity_mps2", gravity);
  object.numbers("covariance_mps2_2", covariance);
  object.numbers("latest_mps2", in_frame(frame, v.latest_mps2));
}

}  // namespace

void append_json_string(std::string& out, std::string_view text) {
  static constexpr char kHex[] = "0123456789abcdef";
  out += '"';
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const auto c = static_cast<unsigned char>(text[i]);
    if (length == 0) {
      out += "\\ufffd";
      ++i;
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    if (c < 0x20 || c == 0x7f) {
      out += "\\u00";
      out += kHex[c >> 4U];
      out += kHex[c & 15U];
    } else {
      out.append(text.substr(i, length));
    }
    i += length;
  }
  out += '"';
}

void append_json_number(std::string& out, double value) {
  if (std::isfinite(value)) {
    append_shortest(out, value);
  } else {
    out += "null";
  }
}

Vec3 in_frame(const Mat3& frame, const Vec3& v) noexcept { return times(frame, v); }

Mat3 covariance_in_frame(const Mat3& frame, const Mat3& covariance) noexcept {
  return turned_covariance(frame, covariance);
}

void append_event_json(std::string& out, const TransitionRecord& record, const SensorArray& array) {
  Object object(out);
  object.whole("sequence", record.sequence);
  object.number("t_s", record.time_s);
  object.word("from", to_string(record.from));
  object.word("to", to_string(record.to));
  object.word("event", to_string(record.event));
  object.word("cause", to_string(record.cause));
  object.word("grade", to_string(record.grade));
  object.sensors("sensors", record.sensors, array);
  object.number("statistic", record.statistic);
  object.number("limit", record.limit);
  object.close();
}

void append_verdict_json(std::string& out, const Verdict& v, const SensorArray& array, const Mat3& frame) {
  Object object(out);
  object.number("t_s", v.time_s);
  object.word("state", to_string(v.state));
  object.qualifiers("qualifiers", v.qualifiers);
  object.word("validity", to_string(v.validity));
  object.word("cause", to_string(v.cause));
  object.flag("tick", v.tick);
  object.flag("accepted", v.accepted);
  object.whole("transition", v.transition.sequence);
  object.word("decided_by", to_string(v.decided_by));
  object.number("statistic", v.statistic);
  object.number("limit", v.limit);
  object.number("margin", v.margin);
  append_masks(object, v, array);
  object.word("grade", to_string(v.grade));
  object.whole("confirmed_grade", v.confirmed_grade);
  object.whole("provisional_grade", v.provisional_grade);
  object.whole("consistent_hypotheses", v.consistent_hypotheses);
  object.whole("stations_on_record", v.stations_on_record);
  object.flag("wants_rotation", v.wants_rotation);
  append_rotation(object, v, frame);
  append_recalibration(object, v, array, frame);
  object.number("mae_all_mps2", v.mae_all_mps2);
  object.number("mae_worst_mps2", v.mae_worst_mps2);
  object.number("mae_worst_limit_mps2", v.mae_worst_limit_mps2);
  object.whole("triples_tested", triple_count(v.triples_tested, array));
  object.failing_triples("triples_failing", v, array);
  object.number("parity", v.parity);
  object.number("parity_limit", v.parity_limit);
  object.number("norm_error_mps2", v.norm_error_mps2);
  append_reference(object, v, frame);
  append_contradiction(object, v);
  object.drifts("drift_mps2_per_h", v, array.size());
  object.number("noise_factor", v.noise_factor);
  object.number("noise_correlation", v.noise_correlation);
  object.number("temperature_degc", v.temperature_degc);
  object.number("temperature_rate_degc_per_min", v.temperature_rate_degc_per_min);
  object.usable("usable", v.usable);
  append_vector(object, v, frame);
  if (v.snapshot_refusal == Errc::ok) {
    object.nothing("snapshot_refused");
  } else {
    object.word("snapshot_refused", describe(v.snapshot_refusal));
  }
  object.hash("config_hash", v.config_hash);
  object.close();
}

std::string event_json(const TransitionRecord& record, const SensorArray& array) {
  std::string out;
  append_event_json(out, record, array);
  return out;
}

std::string verdict_json(const Verdict& verdict, const SensorArray& array, const Mat3& frame) {
  std::string out;
  append_verdict_json(out, verdict, array, frame);
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
