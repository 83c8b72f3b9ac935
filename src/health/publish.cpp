// What a verdict says: the figures of the last block, who is in and who is out, what may be used.
#include <cmath>
#include <cstring>

#include "block_view.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Nearer to vertical than this, toolface is noise.
constexpr double kLeastInclination_rad = rad_from_deg(3.0);

/// Part of gravity across the tool's axis. No std::hypot, whose last digit is the C library's.
double across_tool(const Vec3& g) noexcept { return std::sqrt(g[0] * g[0] + g[1] * g[1]); }

/// A calibration that is known to no digit leaves less than nothing by rounding, or more than there are numbers for:
/// what such a vector is worth, nobody can tell. Doubles of no sign are ordered as their bits are, infinity and what is
/// no number behind all, and a sign is behind those: this is asked in every sample, also where doubles are software.
bool has_variances(const Mat3& covariance) noexcept {
  const auto variance = [&covariance](size_t k) {
    constexpr std::uint64_t kInfinity = 0x7FF0'0000'0000'0000U;
    std::uint64_t bits = 0;
    std::memcpy(&bits, &covariance[4 * k], sizeof bits);
    return bits < kInfinity;
  };
  return variance(0) && variance(1) && variance(2);
}

}  // namespace

void HealthMonitor::publish_decision(const BlockView& view) noexcept {
  verdict_.decided_by = view.decided_by;
  verdict_.statistic = view.statistic;
  verdict_.limit = view.limit;
  verdict_.margin = view.limit > 0.0 ? 1.0 - view.statistic / view.limit : 0.0;
  verdict_.parity = view.used.parity;
  verdict_.parity_limit = view.used.parity_rows > 0 ? view.used.parity_alarm_limit(limits_) : 0.0;
  verdict_.mae_worst_mps2 = view.mae_worst_mps2;
  verdict_.mae_worst_limit_mps2 = view.mae_limit_mps2;
  verdict_.triples_tested = view.triples_tested;
  verdict_.triples_passed = view.triples_passed;
  const bool whole = evidence_.usable.contains(in_service_);
  const LeastSquares map = whole ? map_ : least_squares(array_, in_service_ & evidence_.usable);
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double check = in_service_.has(i) ? 1.0 - dot(array_.axis(i), map.column[a]) : 0.0;
    verdict_.drift_mps2_per_h[a] = static_cast<float>(trend_.rate_mps2_per_h(i, check));
  }
}

void HealthMonitor::give_notice(double time_s) noexcept {
  Cause cause = Cause::none;
  if (inhibit_notice_) {
    cause = inhibited_ ? Cause::inhibited : Cause::released;
    inhibit_notice_ = false;
  } else if (calibration_notice_) {
    cause = Cause::calibration_contradicted;
    calibration_notice_ = false;
  } else if (reference_notice_ != ReferenceKind::none) {
    cause = reference_notice_ == ReferenceKind::common_scale ? Cause::common_scale : Cause::common_bias;
    reference_notice_ = ReferenceKind::none;
  }
  if (cause == Cause::none) return;
  TransitionRecord& record = verdict_.transition;
  record.sequence = ++sequence_;
  record.time_s = time_s;
  record.from = record.to = state_of(mode_);
  record.cause = cause;
  record.statistic = verdict_.statistic;
  record.limit = verdict_.limit;
}

std::uint16_t HealthMonitor::usable_bits() const noexcept {
  const bool vector = verdict_.validity == Validity::valid || verdict_.validity == Validity::degraded;
  const double across = across_tool(verdict_.gravity_mps2);
  const bool toolface = across >= std::sin(kLeastInclination_rad) * norm(verdict_.gravity_mps2);
  const bool reference = verdict_.reference.kind == ReferenceKind::none && suspicion_ != Cause::reference;
  const auto when = [](bool holds, std::uint16_t which) { return holds ? static_cast<unsigned>(which) : 0U; };
  return static_cast<std::uint16_t>(
      when(vector, Usable::vector) | when(vector, Usable::inclination) | when(vector && toolface, Usable::toolface) |
      when(verdict_.protection_available, Usable::protection_level) |
      when(size_class_ == SizeClass::all_configured || size_class_ == SizeClass::reduced, Usable::monitored) |
      when(is_fresh() && verdict_.validity != Validity::held && !slow_motion_.slow(), Usable::stationary) |
      when(!temperature_out_ && temperature_rate_.slow(), Usable::temperature) |
      when(!owes_calibration() && !three_sensor_fit_, Usable::calibration) | when(reference, Usable::reference));
}

/// Whether the vector of the last block is that of this sample too.
bool HealthMonitor::is_fresh() const noexcept {
  return !moving_ && have_evidence_ && freshness_.holds(config_, clock_.last_s() - evidence_time_s_);
}

Validity HealthMonitor::validity() const noexcept {
  if (mode_ == Mode::failed || owes_calibration() || !have_evidence_) return Validity::invalid;
  if (!has_variances(verdict_.covariance)) return Validity::invalid;
  if (!is_fresh()) return Validity::held;
  const bool bounded = scan_.protection_available && scan_.protection_rad <= config_.alert_limit_rad;
  if (slow_motion_.slow() && !bounded) return Validity::held;
  const Mode mode = published_mode();
  if (temperature_out_ || partial_) return Validity::unconfirmed;
  if (size_class_ == SizeClass::critical && three_sensor_fit_) return Validity::unconfirmed;
  if (mode == Mode::degraded) return Validity::degraded;
  // The length itself is in doubt: by it, and by nothing else, some explanations are taken for inconsistent.
  if (mode == Mode::suspect && suspicion_ == Cause::reference) return Validity::unconfirmed;
  // Bounds rest on the calibration, and that has not been borne out yet.
  const bool believed = isolation_.strict_grade() < 1 || check_.believed();
  if (check_.refused() || (episode_.open && !believed)) return Validity::unconfirmed;
  // An array that cannot bear another fault beside the suspected one has to have been at rest since before.
  if (!scan_.bears_more && !rest_.holds()) return Validity::unconfirmed;
  return bounded ? Validity::valid : Validity::unconfirmed;
}

/// Of an older vector the bound says nothing now.
bool HealthMonitor::protected_now(Validity validity) const noexcept {
  return scan_.protection_available && have_evidence_ && validity != Validity::held && !temperature_out_ &&
         !owes_calibration() && mode_ != Mode::failed;
}

void HealthMonitor::publish_vector(const BlockTests& tests) noexcept {
  const SensorSet used = in_service_ & evidence_.usable;
  const SetTest& t = tests.of(used);
  if (!t.tested) return;
  Mat3 covariance = calibration_covariance(array_, t, used);
  for (size_t k = 0; k < 9; ++k) covariance[k] += t.covariance[k];
  verdict_.covariance = turned_covariance(frame_, covariance);
  verdict_.gravity_mps2 = times(frame_, t.x_mps2);
  verdict_.norm_error_mps2 = t.norm_error_mps2;
}

/// What every sample changes.
void HealthMonitor::publish_sample(const Sample& sample) noexcept {
  Verdict& v = verdict_;
  v.time_s = sample.time_s;
  v.sample = counters_.samples;
  v.clipped = clipped_;
  v.not_finite = not_finite_;
  v.temperature_degc = last_temperature_degc_;
  v.temperature_rate_degc_per_min = temperature_rate_.degc_per_min();
  v.block_fill = block_.size();
  v.mae_all_mps2 = mae_.all_mps2();
  v.age_s = have_evidence_ ? clock_.last_s() - evidence_time_s_ : 0.0;
}

/// Whether anything but that has changed since the last verdict though neither a block nor an event says so: by the
/// host, by time alone, or in the fit that is being made.
bool HealthMonitor::news() const noexcept {
  const bool temperature_fine = (verdict_.usable & Usable::temperature) != 0;
  const bool fine_now = !temperature_out_ && temperature_rate_.slow();
  const bool stationary = (verdict_.usable & Usable::stationary) != 0;
  const bool inhibited = (verdict_.qualifiers & Qualifier::inhibited) != 0;
  // An offer that an inhibit keeps waiting raises no event, and is told all the same.
  const Validity now = validity();
  const bool fresh = now == Validity::invalid ? is_fresh() : now != Validity::held;
  const bool stationary_now = fresh && !slow_motion_.slow();
  const bool offered = verdict_.recalibration.offered != recalibration_.offered();
  return offered || verdict_.transition.sequence != 0 || verdict_.protection_available != protected_now(now) ||
         mode_ == Mode::recalibrating || mode_ == Mode::initial || verdict_.validity != now ||
         temperature_fine != fine_now || stationary != stationary_now || inhibited != inhibited_ ||
         verdict_.reference_mps2 != gravity_.g_mps2 || verdict_.reference_sigma_mps2 != gravity_.sigma_mps2;
}

void HealthMonitor::publish(const Sample& sample, bool ticked) noexcept {
  publish_sample(sample);
  Verdict& v = verdict_;
  v.tick = ticked && !moving_;
  v.state = state_of(mode_);
  v.qualifiers = static_cast<std::uint16_t>(
      (unproven_ ? Qualifier::unproven : 0) | (moving_ ? Qualifier::moving : 0) |
      (mode_ == Mode::initial ? Qualifier::initial_calibration : 0) |
      (!set_aside_.empty() ? Qualifier::provisional : 0) | (exhausted_ ? Qualifier::exhausted : 0) |
      (size_class_ == SizeClass::critical ? Qualifier::no_redundancy : 0) |
      (three_sensor_fit_ ? Qualifier::three_sensor_fit : 0) | (inhibited_ ? Qualifier::inhibited : 0) |
      (config_.acceleration_bound_mps2 > 0.0 ? 0 : Qualifier::standstill_assumed) |
      (stability_stated_ ? 0 : Qualifier::stability_unstated));
  v.config_hash = identity_;
  v.configured = array_.all();
  v.in_service = in_service_;
  v.set_aside = set_aside_;
  v.excluded = excluded_;
  v.absent = absent_;
  v.noisy = noisy_ & in_service_;
  v.stuck = stuck_ & in_service_;
  v.contradicted_clip = full_scale_ & in_service_;
  if (ticked) name_causes(SensorSet{}, Cause::none);
  v.sensor_cause = sensor_cause_;
  v.suspects = episode_.open ? scan_.suspects : SensorSet{};
  v.fewest_faults = scan_.fewest_faults;
  v.grade = last_grade_;
  v.strict_grade = isolation_.strict_grade();
  v.parity_grade = isolation_.parity_grade();
  v.live_hypotheses = live_;
  v.stations_on_record = episode_.stations.size();
  v.recalibration = recalibration_.progress(array_);
  v.recalibration.wanted_direction = times(frame_, v.recalibration.wanted_direction);
  if (ticked || v.transition.sequence != 0) v.rotation = rotation_request();
  v.wants_rotation =
      v.rotation.wanted || (state_of(mode_) == HealthState::recalibrating && v.recalibration.stations_wanted > 0);
  v.reference_mps2 = gravity_.g_mps2;
  v.reference_sigma_mps2 = gravity_.sigma_mps2;
  publish_claims(validity());
}

/// What the verdict claims of this sample.
void HealthMonitor::publish_claims(Validity validity) noexcept {
  Verdict& v = verdict_;
  v.validity = validity;
  v.protection_available = protected_now(validity);
  v.protection_level_rad = v.protection_available ? scan_.protection_rad : 0.0;
  v.faults_covered = static_cast<std::uint8_t>(v.protection_available ? scan_.covered : 0);
  const double sine = across_tool(v.gravity_mps2) / std::fmax(norm(v.gravity_mps2), 1e-9);
  const bool told =
      v.protection_available && v.protection_level_rad < 0.5 * kPi && sine_of(v.protection_level_rad) < sine;
  v.toolface_protection_rad = told ? angle_with_sine(sine_of(v.protection_level_rad) / sine) : kPi;
  v.usable = usable_bits();
  v.alert =
      !v.protection_available || !(v.protection_level_rad <= config_.alert_limit_rad) || v.validity != Validity::valid;
}

/// What was valid is only held, from now on and not from the next sample on.
void HealthMonitor::begin_time_base() noexcept {
  if (!configured_ || !whole()) return;  // the next block says so
  clock_.expect_new_time_base();
  freshness_.lapse();
  if (verdict_.validity != Validity::invalid) publish_claims(Validity::held);
  seal();
}

}  // namespace PLUMB_ABI
}  // namespace plumb
