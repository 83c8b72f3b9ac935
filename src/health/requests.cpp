// What a host may ask of a monitor between two steps.
#include <cmath>

#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

Expected<void> HealthMonitor::reset(std::uint64_t key, SensorSet sensors) noexcept {
  if (!whole()) return fail(Errc::not_calibrated);
  if (key != state_.settings.config.reset_key) return fail(Errc::wrong_key);
  state_.requests.reset_pending = true;
  state_.requests.reset_sensors = sensors & state_.in_force.array.all();
  seal();
  return {};
}

Expected<void> HealthMonitor::set_gravity(const GravityReference& gravity) noexcept {
  const Expected<void> sound = plausible(gravity);
  if (!sound) return sound;
  if (!whole()) return fail(Errc::not_calibrated);
  MonitorState& s = state_;
  s.in_force.gravity = gravity;
  if (s.studies.gravity.withdraw()) verdict_.norm_mismatch = NormMismatch{};
  s.window.forget_near();
  // Stations under one gravity and stations under another do not make one fit.
  if (!(std::fabs(gravity.g_mps2 - s.in_force.store_g_mps2) <= gravity.sigma_mps2)) {
    s.recalibration.forget();
    s.in_force.store_g_mps2 = gravity.g_mps2;
  }
  s.diagnosis.forget_votes();
  s.studies.check.forget_readings();
  // What rested on the former gravity is not claimed until the next sample.
  const bool claims = verdict_.validity != Validity::invalid && verdict_.validity != Validity::held;
  if (claims) publish_claims(s, validity_of(s), verdict_);
  seal();
  return {};
}

Expected<void> HealthMonitor::set_rotation(const Rotation& rotation) noexcept {
  if (!std::isfinite(norm(rotation.rate_radps))) return fail(Errc::not_finite, 0, norm(rotation.rate_radps));
  if (!whole()) return fail(Errc::not_calibrated);
  state_.intake.rotation = rotation;
  seal();
  return {};
}

void HealthMonitor::set_motion(const MotionFinding& finding) noexcept {
  InMotion& motion = state_.requests.motion;
  const SensorArray& array = state_.in_force.array;
  const SensorSet excluded = array.units().whole(finding.excluded & array.all());
  if (finding.alarm == motion.found.alarm && excluded == motion.found.excluded) return;
  if (!configured_ || !whole()) return;  // the next block says so
  motion.found = {finding.alarm, excluded};
  motion.follow(state_.machine.sensors.provisionally_excluded);
  seal();
}

/// What was valid is only held, from now on and not from the next sample on.
void HealthMonitor::begin_time_base() noexcept {
  if (!configured_ || !whole()) return;  // the next block says so
  state_.intake.clock.expect_new_time_base();
  state_.freshness.lapse();
  if (verdict_.validity != Validity::invalid) publish_claims(state_, Validity::held, verdict_);
  seal();
}

void HealthMonitor::inhibit(bool frozen) noexcept {
  if (!whole()) return;  // the next block says so
  Requests& asked = state_.requests;
  asked.inhibit_notice = asked.inhibit_notice != (frozen != asked.inhibited);
  asked.inhibited = frozen;
  seal();
}

Expected<void> HealthMonitor::request_recalibration() noexcept {
  if (!whole()) return fail(Errc::not_calibrated);
  const auto state = static_cast<double>(state_of(state_.machine.mode));
  if (!kRecalibrates || !configured_ || !state_.may_recalibrate()) return fail(Errc::wrong_state, -1, state);
  // A fit takes the length at every station for gravity's: a steady push would end in the biases, and nothing would
  // show it. An offer is not fitted to the length, only tried by it, within limits that carry the bound.
  const double bound_mps2 = state_.settings.config.acceleration_bound_mps2;
  if (bound_mps2 > 0.0) return fail(Errc::may_accelerate, -1, bound_mps2, 0.0);
  state_.recalibration.withdraw_offer();
  state_.requests.recalibration_asked = true;
  seal();
  return {};
}

Expected<void> HealthMonitor::offer_calibration(const SensorModel& model, const SensorArray& array) noexcept {
  if (!whole()) return fail(Errc::not_calibrated);
  const auto state = static_cast<double>(state_of(state_.machine.mode));
  if (!kRecalibrates || !configured_ || !state_.may_recalibrate()) return fail(Errc::wrong_state, -1, state);
  const double now_s = state_.intake.clock.last_s();
  const Expected<void> taken = state_.recalibration.offer(state_.fit_terms(), model, array, state_.in_service(), now_s);
  state_.requests.recalibration_asked = taken.has_value();  // the host's last word counts
  seal();
  return taken;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
