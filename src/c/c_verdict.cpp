// From a verdict to its C form.
#include <algorithm>

#include "c_api.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace c_api {
namespace {

std::uint8_t byte(bool b) noexcept { return b ? 1 : 0; }
template <class E>
std::uint8_t number(E e) noexcept {
  return static_cast<std::uint8_t>(e);
}
template <size_t N>
void copy_to(double (&to)[N], const std::array<double, N>& from) noexcept {
  std::copy(from.begin(), from.end(), to);
}

void write_sets(const Verdict& v, plumb_verdict& out) noexcept {
  out.configured = v.configured.bits;
  out.in_service = v.in_service.bits;
  out.provisionally_excluded = v.provisionally_excluded.bits;
  out.excluded = v.excluded.bits;
  out.absent = v.absent.bits;
  out.suspects = v.suspects.bits;
  out.clipped = v.clipped.bits;
  out.scattering = v.scattering.bits;
  out.not_finite = v.not_finite.bits;
  out.noisy = v.noisy.bits;
  out.stuck = v.stuck.bits;
  out.contradicted_clip = v.contradicted_clip.bits;
  for (size_t i = 0; i < static_cast<size_t>(kCapacity); ++i) {
    out.sensor_cause[i] = number(v.sensor_cause[i]);
    out.minimum_faults[i] = v.minimum_faults[i];
    out.drift_mps2_per_h[i] = static_cast<double>(v.drift_mps2_per_h[i]);
  }
}

void write_figures(const Verdict& v, plumb_verdict& out) noexcept {
  out.confirmed_grade = v.confirmed_grade;
  out.provisional_grade = v.provisional_grade;
  out.consistent_hypotheses = v.consistent_hypotheses;
  out.stations_on_record = v.stations_on_record;
  out.stations_wanted = v.recalibration.stations_wanted;
  out.block_fill = v.block_fill;
  out.statistic = v.statistic;
  out.limit = v.limit;
  out.margin = v.margin;
  out.mae_all_mps2 = v.mae_all_mps2;
  out.mae_worst_mps2 = v.mae_worst_mps2;
  out.mae_worst_limit_mps2 = v.mae_worst_limit_mps2;
  out.parity = v.parity;
  out.parity_limit = v.parity_limit;
  out.norm_error_mps2 = v.norm_error_mps2;
  out.reference_mps2 = v.reference_mps2;
  out.reference_sigma_mps2 = v.reference_sigma_mps2;
  out.temperature_degc = v.temperature_degc;
  out.noise_factor = v.noise_factor;
  out.noise_correlation = v.noise_correlation;
  const bool offset = v.norm_mismatch.configure_mps2 > 0.0;
  out.gravity_offset_mps2 = offset ? v.norm_mismatch.length_mps2 : 0.0;
  out.gravity_to_configure_mps2 = v.norm_mismatch.configure_mps2;
  out.calibration_ratio = v.calibration.contradicted ? v.calibration.ratio : 0.0;
  out.calibration_tolerance_mps2 = v.calibration.tolerance_mps2;
  copy_to(out.gravity_mps2, v.gravity_mps2);
  copy_to(out.covariance, v.covariance);
  out.age_s = v.age_s;
  copy_to(out.latest_mps2, v.latest_mps2);
  out.protection_level_calibrated_axes_rad = v.protection_level_calibrated_axes_rad;
  out.protection_level_housing_rad = v.protection_level_housing_rad;
  out.toolface_protection_housing_rad = v.toolface_protection_housing_rad;
  copy_to(out.turn_along, v.rotation.along);
  out.turn_change_mps2 = v.rotation.change_mps2;
  out.turn_angle_rad = v.rotation.angle_rad;
}

}  // namespace

void no_verdict(plumb_verdict& out) noexcept {
  out = plumb_verdict{};
  out.struct_size = sizeof(plumb_verdict);
  out.state = out.transition.from = out.transition.to = PLUMB_SUSPECT;
  out.transition.event = number(HealthEvent::none);
  out.validity = PLUMB_INVALID;
  out.alert = 1;
  out.noise_factor = out.noise_correlation = 1.0;
}

plumb_error write(const Verdict& v, plumb_verdict* to, int argument) noexcept {
  const plumb_error e = check_struct(to, argument);
  if (e.code != PLUMB_OK) return e;
  plumb_verdict out{};
  out.struct_size = to->struct_size;
  out.sample = v.sample;
  out.time_s = v.time_s;
  out.state = number(v.state);
  out.validity = number(v.validity);
  out.cause = number(v.cause);
  out.decided_by = number(v.decided_by);
  out.grade = number(v.grade);
  out.qualifiers = v.qualifiers;
  out.tick = byte(v.tick);
  out.accepted = byte(v.accepted);
  out.alert = byte(v.alert);
  out.protection_available = byte(v.protection_available);
  out.wants_rotation = byte(v.wants_rotation);
  out.recalibration_phase = number(v.recalibration.phase);
  out.faults_covered = v.faults_covered;
  out.usable = v.usable;
  const TransitionRecord& t = v.transition;
  out.transition = {t.sequence, number(t.from), number(t.to), number(t.event), number(t.cause), number(t.grade),
                    {0, 0, 0},  t.sensors.bits, t.time_s,     t.statistic,     t.limit};
  write_sets(v, out);
  write_figures(v, out);
  *to = out;
  return answer(PLUMB_OK);
}

static_assert(PLUMB_C_SENSORS >= kCapacity, "room for every sensor");
static_assert(static_cast<int>(HealthState::failed) == PLUMB_FAILED, "the states are numbered alike");
static_assert(static_cast<int>(Validity::invalid) == PLUMB_INVALID && static_cast<int>(Validity::valid) == PLUMB_VALID,
              "the validities are numbered alike");
static_assert(Qualifier::standstill_assumed == PLUMB_STANDSTILL_ASSUMED, "bits alike");
static_assert(Qualifier::stability_unstated == PLUMB_STABILITY_UNSTATED, "bits alike");
static_assert(Qualifier::uncertainty_unstated == PLUMB_UNCERTAINTY_UNSTATED, "bits alike");
static_assert(Qualifier::alignment_unstated == PLUMB_ALIGNMENT_UNSTATED, "bits alike");
static_assert(Qualifier::not_yet_validated == PLUMB_NOT_YET_VALIDATED && Qualifier::moving == PLUMB_MOVING &&
                  Qualifier::initial_calibration == PLUMB_INITIAL_CALIBRATION &&
                  Qualifier::provisional == PLUMB_PROVISIONAL && Qualifier::no_redundancy == PLUMB_NO_REDUNDANCY &&
                  Qualifier::timed_out == PLUMB_TIMED_OUT && Qualifier::three_sensor_fit == PLUMB_THREE_SENSOR_FIT &&
                  Qualifier::inhibited == PLUMB_INHIBITED,
              "bits alike");
static_assert(static_cast<int>(HealthEvent::none) == PLUMB_EVENT_NONE &&
                  static_cast<int>(HealthEvent::alarm) == PLUMB_EVENT_ALARM,
              "the events are numbered alike");
static_assert(static_cast<int>(Grade::assumed) == PLUMB_GRADE_ASSUMED, "the grades are numbered alike");
static_assert(static_cast<int>(RecalibrationPhase::accepted) == PLUMB_RECALIBRATION_ACCEPTED, "the phases, too");
static_assert(Usable::reference == PLUMB_USABLE_REFERENCE && Usable::monitored == PLUMB_USABLE_MONITORED, "bits alike");

}  // namespace c_api
}  // namespace PLUMB_ABI
}  // namespace plumb
