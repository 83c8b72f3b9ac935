#include "plumb/health/detail/publish.hpp"

#include <cmath>
#include <cstring>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Nearer to vertical than this, toolface is noise.
constexpr double kLeastInclination_rad = rad_from_deg(3.0);

/// Part of gravity across the tool's axis. No std::hypot, whose last digit is the C library's.
double across_tool(const Vec3& g) noexcept { return std::sqrt(g[0] * g[0] + g[1] * g[1]); }

/// A calibration that is known to no digit leaves less than nothing by rounding, or more than there are numbers for:
/// what such a vector is worth is not known. Doubles of no sign are ordered as their bits are, infinity and what is
/// no number behind all, and a sign is behind those: this is asked in every sample, also where doubles are software.
bool has_variances(const Mat3& covariance) noexcept {
  const auto variance = [&covariance](size_t k) {
    constexpr std::uint64_t kBitsOfInfinity = 0x7FF0'0000'0000'0000U;
    std::uint64_t bits = 0;
    std::memcpy(&bits, &covariance[4 * k], sizeof bits);
    return bits < kBitsOfInfinity;
  };
  return variance(0) && variance(1) && variance(2);
}

std::uint16_t qualifiers_of(const MonitorState& s) noexcept {
  const auto when = [](bool holds, std::uint16_t which) { return holds ? static_cast<unsigned>(which) : 0U; };
  return static_cast<std::uint16_t>(
      when(s.machine.not_yet_validated, Qualifier::not_yet_validated) | when(s.last.moving, Qualifier::moving) |
      when(s.machine.mode == Mode::initial, Qualifier::initial_calibration) |
      when(!s.machine.sensors.provisionally_excluded.empty(), Qualifier::provisional) |
      when(s.machine.timed_out, Qualifier::timed_out) |
      when(s.service.size == SizeClass::critical, Qualifier::no_redundancy) |
      when(s.in_force.three_sensor_fit, Qualifier::three_sensor_fit) |
      when(s.requests.inhibited, Qualifier::inhibited) |
      when(!(s.settings.config.acceleration_bound_mps2 > 0.0), Qualifier::standstill_assumed) |
      when(!s.settings.stability_stated, Qualifier::stability_unstated) |
      when(!s.in_force.array.taken_for_exact().empty(), Qualifier::uncertainty_unstated) |
      when(!(s.settings.config.alignment_bound_rad > 0.0F), Qualifier::alignment_unstated));
}

void publish_sensors(const MonitorState& s, Verdict& v) noexcept {
  const SensorLedger& sensors = s.machine.sensors;
  v.configured = s.in_force.array.all();
  v.in_service = sensors.in_service;
  v.provisionally_excluded = sensors.provisionally_excluded;
  v.excluded = sensors.excluded;
  v.absent = sensors.absent;
  v.noisy = s.facts.noisy() & sensors.in_service;
  v.stuck = s.facts.stuck() & sensors.in_service;
  v.contradicted_clip = s.facts.full_scale() & sensors.in_service;
  v.scattering = s.last.scattering;
  v.sensor_cause = s.facts.causes();
}

void publish_diagnosis(const MonitorState& s, Verdict& v) noexcept {
  const Diagnosis& d = s.diagnosis;
  v.suspects = d.episode().open ? d.scan().suspects : SensorSet{};
  v.minimum_faults = d.scan().minimum_faults;
  v.grade = d.last_grade();
  v.confirmed_grade = d.isolation().confirmed_grade();
  v.provisional_grade = d.isolation().provisional_grade();
  v.consistent_hypotheses = d.live();
  v.stations_on_record = d.episode().stations.size();
}

/// Bounds rest on the calibration: it is refused, has not been corroborated yet, or contradicts itself so far.
bool is_calibration_in_doubt(const MonitorState& s) noexcept {
  const CalibrationCheck& check = s.studies.check;
  if (!s.diagnosis.episode().open) return check.doubted();
  return check.refused() || (!check.believed() && s.diagnosis.isolation().confirmed_grade() >= 1);
}

}  // namespace

Validity validity_of(const MonitorState& s) noexcept {
  const DecisionState& machine = s.machine;
  if (machine.mode == Mode::failed || s.in_force.owes_calibration() || !s.last.known) return Validity::invalid;
  if (!has_variances(s.last.covariance)) return Validity::invalid;
  if (!s.is_fresh()) return Validity::held;
  const bool bounded = s.diagnosis.bounded(alert_limit_in_axes_rad(s.settings.config));
  if (s.studies.slow_motion.slow() && !bounded) return Validity::held;
  const Mode mode = s.published_mode();
  if (s.intake.temperature_out || s.last.partial) return Validity::unconfirmed;
  if (s.service.size == SizeClass::critical && s.in_force.three_sensor_fit) return Validity::unconfirmed;
  if (mode == Mode::degraded) return Validity::degraded;
  // The length itself is in doubt: by it, and by nothing else, some explanations are taken for inconsistent.
  if (mode == Mode::suspect && s.diagnosis.suspicion() == Cause::norm_mismatch) return Validity::unconfirmed;
  if (is_calibration_in_doubt(s)) return Validity::unconfirmed;
  // An array that cannot bear another fault beside the suspected one has to have been at rest since before.
  if (!s.diagnosis.scan().bears_more && !s.diagnosis.rested()) return Validity::unconfirmed;
  return bounded ? Validity::valid : Validity::unconfirmed;
}

bool is_protected(const MonitorState& s, Validity validity) noexcept {
  if (validity == Validity::valid) return true;  // all of what follows was asked for it
  return s.diagnosis.scan().protection_available && s.last.known && validity != Validity::held &&
         !s.intake.temperature_out && !s.in_force.owes_calibration() && s.machine.mode != Mode::failed;
}

double housing_level_rad(const MonitorState& s) noexcept {
  return std::fmin(s.diagnosis.scan().protection_rad + static_cast<double>(s.settings.config.alignment_bound_rad), kPi);
}

std::uint16_t usable_bits(const MonitorState& s, Validity validity) noexcept {
  const bool vector = validity == Validity::valid || validity == Validity::degraded;
  const Vec3& g = s.last.gravity_mps2;
  const bool toolface = across_tool(g) >= std::sin(kLeastInclination_rad) * norm(g);
  const bool reference =
      s.studies.gravity.told() == NormMismatchKind::none && s.diagnosis.suspicion() != Cause::norm_mismatch;
  const bool monitored = s.service.size == SizeClass::all_configured || s.service.size == SizeClass::reduced;
  const auto when = [](bool holds, std::uint16_t which) { return holds ? static_cast<unsigned>(which) : 0U; };
  return static_cast<std::uint16_t>(
      when(vector, Usable::vector) | when(vector, Usable::inclination) | when(vector && toolface, Usable::toolface) |
      when(is_protected(s, validity), Usable::protection_level) | when(monitored, Usable::monitored) |
      when(s.is_fresh() && validity != Validity::held && !s.studies.slow_motion.slow(), Usable::stationary) |
      when(!s.intake.temperature_out && s.studies.temperature_rate.slow(), Usable::temperature) |
      when(!s.in_force.owes_calibration() && !s.in_force.three_sensor_fit, Usable::calibration) |
      when(reference, Usable::reference));
}

bool has_news(const MonitorState& s, const Verdict& last) noexcept {
  const bool temperature_fine = (last.usable & Usable::temperature) != 0;
  const bool fine_now = !s.intake.temperature_out && s.studies.temperature_rate.slow();
  const bool stationary = (last.usable & Usable::stationary) != 0;
  const bool inhibited = (last.qualifiers & Qualifier::inhibited) != 0;
  // An offer that an inhibit keeps waiting raises no event, and is reported all the same.
  const Validity now = validity_of(s);
  const bool fresh = now == Validity::invalid ? s.is_fresh() : now != Validity::held;
  const bool stationary_now = fresh && !s.studies.slow_motion.slow();
  const bool offered = last.recalibration.offered != s.recalibration.offered();
  return offered || last.transition.sequence != 0 || last.protection_available != is_protected(s, now) ||
         s.machine.mode == Mode::recalibrating || s.machine.mode == Mode::initial || last.validity != now ||
         temperature_fine != fine_now || stationary != stationary_now || inhibited != s.requests.inhibited ||
         last.reference_mps2 != s.in_force.gravity.g_mps2 || last.reference_sigma_mps2 != s.in_force.gravity.sigma_mps2;
}

void publish_report(const MonitorState& s, const BlockReport& report, Verdict& v) noexcept {
  v.decided_by = report.decided_by;
  v.statistic = report.statistic;
  v.limit = report.limit;
  v.margin = report.limit > 0.0 ? 1.0 - report.statistic / report.limit : 0.0;
  v.parity = report.used.parity;
  v.parity_limit = report.used.parity_rows > 0 ? report.used.parity_alarm_limit(s.settings.limits) : 0.0;
  v.mae_worst_mps2 = report.mae_worst_mps2;
  v.mae_worst_limit_mps2 = report.mae_limit_mps2;
  v.triples_tested = report.triples_tested;
  v.triples_passed = report.triples_passed;
  const SensorArray& array = s.in_force.array;
  const double sense = s.in_force.model.reads == Reads::gravity ? 1.0 : -1.0;  // inside, readings count as gravity does
  const SensorSet in_service = s.in_service(), usable = s.last.evidence.usable;
  const LeastSquares map = usable.contains(in_service) ? s.service.map : least_squares(array, in_service & usable);
  for (int i = 0; i < array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double check = in_service.has(i) ? 1.0 - dot(array.axis(i), map.column[a]) : 0.0;
    v.drift_mps2_per_h[a] = static_cast<float>(sense * s.studies.trend.rate_mps2_per_h(i, check));
  }
}

void publish_sample(const MonitorState& s, const Sample& sample, Verdict& v) noexcept {
  v.time_s = sample.time_s;
  v.sample = s.counters.samples;
  v.clipped = s.window.clipped;
  v.not_finite = s.window.not_finite;
  v.latest_mps2 = s.window.latest_mps2;
  v.temperature_degc = s.intake.temperature_degc;
  v.temperature_rate_degc_per_min = s.studies.temperature_rate.degc_per_min();
  v.block_fill = s.window.block.size();
  v.mae_all_mps2 = s.window.mae.all_mps2();
  v.age_s = s.last.known ? s.intake.clock.last_s() - s.last.time_s : 0.0;
}

void publish(const MonitorState& s, const Sample& sample, bool ticked, bool turns, Verdict& v) noexcept {
  publish_sample(s, sample, v);
  v.tick = ticked && !s.last.moving;
  v.cause = s.last.cause;
  v.state = state_of(s.machine.mode);
  v.qualifiers = qualifiers_of(s);
  v.config_hash = s.settings.identity;
  publish_sensors(s, v);
  publish_diagnosis(s, v);
  v.gravity_mps2 = s.last.gravity_mps2;
  v.covariance = s.last.covariance;
  v.norm_error_mps2 = s.last.norm_error_mps2;
  v.noise_factor = s.last.noise_factor;
  v.noise_correlation = s.last.noise_correlation;
  v.calibration = s.studies.check.finding();
  v.recalibration = s.recalibration.progress(s.in_force.array);
  v.recalibration.wanted_direction = times(s.settings.frame, v.recalibration.wanted_direction);
  if (turns) v.rotation = s.diagnosis.rotation_request(s.diagnosis_terms());
  v.wants_rotation =
      v.rotation.wanted || (v.state == HealthState::recalibrating && v.recalibration.stations_wanted > 0);
  v.reference_mps2 = s.in_force.gravity.g_mps2;
  v.reference_sigma_mps2 = s.in_force.gravity.sigma_mps2;
  publish_claims(s, validity_of(s), v);
}

void publish_claims(const MonitorState& s, Validity validity, Verdict& v) noexcept {
  v.validity = validity;
  v.protection_available = is_protected(s, validity);
  v.protection_level_calibrated_axes_rad = v.protection_available ? s.diagnosis.scan().protection_rad : 0.0;
  v.protection_level_housing_rad = v.protection_available ? housing_level_rad(s) : 0.0;
  v.faults_covered = static_cast<std::uint8_t>(v.protection_available ? s.diagnosis.scan().covered : 0);
  const Vec3& g = s.last.gravity_mps2;
  const double sine = across_tool(g) / std::fmax(norm(g), 1e-9);
  const double level_rad = v.protection_level_housing_rad;
  const bool told = v.protection_available && level_rad < 0.5 * kPi && sine_of(level_rad) < sine;
  v.toolface_protection_housing_rad = told ? angle_with_sine(sine_of(level_rad) / sine) : kPi;
  v.usable = usable_bits(s, validity);
  const bool within =
      v.protection_available && v.protection_level_calibrated_axes_rad <= alert_limit_in_axes_rad(s.settings.config);
  v.alert = !within || validity != Validity::valid;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
