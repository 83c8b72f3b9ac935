#include "verdict_row.hpp"

#include <cstring>
#include <limits>

#include "plumb/io/records.hpp"
#include "row_parts.hpp"

namespace plumb_python {
namespace {

int bits_set(std::uint64_t word) {
  int out = 0;
  for (; word != 0; word &= word - 1) ++out;
  return out;
}

void write_transition(const plumb::TransitionRecord& t, VerdictRow& row) {
  row.transition = t.sequence;
  row.transition_from = number(t.from);
  row.transition_to = number(t.to);
  row.transition_event = number(t.event);
  row.transition_cause = number(t.cause);
  row.transition_grade = number(t.grade);
  row.transition_sensors = t.sensors.bits;
  row.transition_time_s = t.time_s;
  row.transition_statistic = t.statistic;
  row.transition_limit = t.limit;
}

void write_sensors(const plumb::Verdict& v, VerdictRow& row) {
  row.configured = v.configured.bits;
  row.in_service = v.in_service.bits;
  row.provisionally_excluded = v.provisionally_excluded.bits;
  row.excluded = v.excluded.bits;
  row.absent = v.absent.bits;
  row.suspects = v.suspects.bits;
  row.clipped = v.clipped.bits;
  row.scattering = v.scattering.bits;
  row.not_finite = v.not_finite.bits;
  row.noisy = v.noisy.bits;
  row.stuck = v.stuck.bits;
  row.contradicted_clip = v.contradicted_clip.bits;
  copy_to(row.sensor_cause, v.sensor_cause);
  copy_to(row.minimum_faults, v.minimum_faults);
  copy_to(row.drift_mps2_per_h, v.drift_mps2_per_h);
}

void write_tests(const plumb::Verdict& v, VerdictRow& row) {
  row.decided_by = number(v.decided_by);
  row.statistic = v.statistic;
  row.limit = v.limit;
  row.margin = v.margin;
  row.grade = number(v.grade);
  row.confirmed_grade = v.confirmed_grade;
  row.provisional_grade = v.provisional_grade;
  row.consistent_hypotheses = v.consistent_hypotheses;
  row.stations_on_record = v.stations_on_record;
  row.block_fill = v.block_fill;
  row.mae_all_mps2 = v.mae_all_mps2;
  row.mae_worst_mps2 = v.mae_worst_mps2;
  row.mae_worst_limit_mps2 = v.mae_worst_limit_mps2;
  int tested = 0, failing = 0;
  for (std::size_t k = 0; k < v.triples_tested.bits.size(); ++k) {
    tested += bits_set(v.triples_tested.bits[k]);
    failing += bits_set(v.triples_tested.bits[k] & ~v.triples_passed.bits[k]);
  }
  row.triples_tested = static_cast<std::uint16_t>(tested);
  row.triples_failing = static_cast<std::uint16_t>(failing);
  row.parity = v.parity;
  row.parity_limit = v.parity_limit;
  row.norm_error_mps2 = v.norm_error_mps2;
}

void write_findings(const plumb::Verdict& v, const plumb::Mat3& frame, VerdictRow& row) {
  row.reference_mps2 = v.reference_mps2;
  row.reference_sigma_mps2 = v.reference_sigma_mps2;
  const plumb::NormMismatch& r = v.norm_mismatch;
  row.norm_mismatch_kind = number(r.kind);
  row.norm_mismatch_attitudes = r.attitudes;
  row.norm_mismatch_length_mps2 = r.length_mps2;
  row.norm_mismatch_length_bound_mps2 = r.length_bound_mps2;
  row.norm_mismatch_widened_mps2 = r.widened_mps2;
  copy_to(row.norm_mismatch_bias_mps2, plumb::io::in_frame(frame, r.bias_mps2));
  row.norm_mismatch_turn_rad = r.turn_rad;
  row.gravity_offset_mps2 = r.configure_mps2 > 0.0 ? r.length_mps2 : 0.0;
  row.gravity_to_configure_mps2 = r.configure_mps2;
  const plumb::CalibrationFinding& c = v.calibration;
  row.calibration_contradicted = c.contradicted;
  row.calibration_refused = c.refused;
  row.calibration_attitudes = c.attitudes;
  row.calibration_ratio = c.contradicted ? c.ratio : 0.0;
  row.calibration_tolerance_mps2 = c.tolerance_mps2;
  row.noise_factor = v.noise_factor;
  row.noise_correlation = v.noise_correlation;
  row.temperature_degc = v.temperature_degc;
  row.temperature_rate_degc_per_min = v.temperature_rate_degc_per_min;
}

void write_vector(const plumb::Verdict& v, const plumb::Mat3& frame, VerdictRow& row) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  copy_to(row.gravity_mps2, plumb::io::in_frame(frame, v.gravity_mps2));
  copy_to(row.covariance, plumb::io::covariance_in_frame(frame, v.covariance));
  row.age_s = v.age_s;
  copy_to(row.latest_mps2, plumb::io::in_frame(frame, v.latest_mps2));
  row.protection_available = v.protection_available;
  row.protection_level_calibrated_axes_rad = v.protection_available ? v.protection_level_calibrated_axes_rad : kNone;
  row.protection_level_housing_rad = v.protection_available ? v.protection_level_housing_rad : kNone;
  row.toolface_protection_housing_rad = v.protection_available ? v.toolface_protection_housing_rad : kNone;
  row.faults_covered = v.faults_covered;
  row.usable = v.usable;
  row.alert = v.alert;
}

void write_wishes(const plumb::Verdict& v, const plumb::Mat3& frame, VerdictRow& row) {
  row.wants_rotation = v.wants_rotation;
  copy_to(row.turn_along, plumb::io::in_frame(frame, v.rotation.along));
  row.turn_change_mps2 = v.rotation.change_mps2;
  row.turn_angle_rad = v.rotation.angle_rad;
  const plumb::RecalibrationProgress& p = v.recalibration;
  row.recalibration_phase = number(p.phase);
  row.recalibration_offered = p.offered;
  row.recalibration_stations = p.stations;
  row.recalibration_held_out = p.held_out;
  row.stations_wanted = p.stations_wanted;
  row.recalibration_lacking = p.lacking.bits;
  copy_to(row.recalibration_wanted_direction, plumb::io::in_frame(frame, p.wanted_direction));
  row.recalibration_refusal = static_cast<std::uint16_t>(p.last_refusal.code);
}

std::string error_text(int code) {
  if (code < 0 || code > static_cast<int>(plumb::kLastErrc))
    refuse("unknown error code", "give the code from a verdict");
  return plumb::describe(static_cast<plumb::Errc>(code));
}

}  // namespace

void write_row(const plumb::Verdict& v, const plumb::Mat3& frame, VerdictRow& row) {
  std::memset(&row, 0, sizeof row);
  row.time_s = v.time_s;
  row.sample = v.sample;
  row.state = number(v.state);
  row.validity = number(v.validity);
  row.cause = number(v.cause);
  row.tick = v.tick;
  row.accepted = v.accepted;
  row.qualifiers = v.qualifiers;
  row.snapshot_refusal = static_cast<std::uint16_t>(v.snapshot_refusal);
  row.config_hash = v.config_hash;
  write_transition(v.transition, row);
  write_sensors(v, row);
  write_tests(v, row);
  write_findings(v, frame, row);
  write_vector(v, frame, row);
  write_wishes(v, frame, row);
}

void bind_verdict_row(py::module_& module) {
#define PLUMB_DESCRIPTOR(type, name, extent, what) PYBIND11_FIELD_DESCRIPTOR(VerdictRow, name),
  py::detail::npy_format_descriptor<VerdictRow>::register_dtype(
      std::vector<py::detail::field_descriptor>{PLUMB_VERDICT_ROW(PLUMB_DESCRIPTOR)});
#undef PLUMB_DESCRIPTOR
  module.attr("verdict_dtype") = py::dtype::of<VerdictRow>();
  py::dict fields;
#define PLUMB_TEXT(type, name, extent, what) fields[#name] = py::str(what);
  PLUMB_VERDICT_ROW(PLUMB_TEXT)
#undef PLUMB_TEXT
  module.attr("VERDICT_FIELDS") = fields;
  module.attr("STATES") = names(plumb::HealthState::failed);
  module.attr("VALIDITIES") = names(plumb::Validity::valid);
  module.attr("CAUSES") = names(plumb::kLastCause);
  module.attr("EVENTS") = names(plumb::HealthEvent::none);
  module.attr("GRADES") = names(plumb::Grade::assumed);
  module.attr("NORM_MISMATCH_KINDS") = names(plumb::NormMismatchKind::common_bias);
  module.attr("RECALIBRATION_PHASES") = names(plumb::RecalibrationPhase::accepted);
  module.attr("QUALIFIERS") = names(plumb::io::kQualifierNames);
  module.attr("USABLE") = names(plumb::io::kUsableNames);
  module.def("error_text", &error_text, py::arg("code"),
             "What a code of recalibration_refusal or snapshot_refusal means, in words.");
}

}  // namespace plumb_python
