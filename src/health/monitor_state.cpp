#include "plumb/health/detail/monitor_state.hpp"
#include "plumb/detection/estimate_error.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

SizeClass MonitorState::classify(SensorSet set) const noexcept {
  if (rank_of(in_force.array, set) < 3) return SizeClass::rank_lost;
  if (!critical_sensors(in_force.array, set).empty()) return SizeClass::critical;
  return set == in_force.array.all() ? SizeClass::all_configured : SizeClass::reduced;
}

bool MonitorState::may_recalibrate() const noexcept {
  if (!kRecalibrates || !machine.sensors.provisionally_excluded.empty()) return false;
  switch (machine.mode) {
    case Mode::nominal:
    case Mode::isolated:
    case Mode::degraded: return !diagnosis.episode().open && !machine.not_yet_validated;
    case Mode::suspect:
      // A fit of three sensors never clears an alarm: nothing but the fit itself would corroborate it.
      if (service.size == SizeClass::critical) return false;
      return diagnosis.suspicion() == Cause::no_consistent_hypothesis ||
             (diagnosis.suspicion() == Cause::norm_mismatch && !diagnosis.episode().open);
    case Mode::recalibrating:
    case Mode::initial:
    case Mode::failed: return false;
  }
  return false;
}

/// At rest, rest decides; beyond the temperatures nothing is rejected. An alarm is taken up where it changes anything:
/// outside `suspect`, and inside it once blocks have passed, which then count no more.
EventMask MonitorState::found_in_motion() const noexcept {
  const InMotion& motion = requests.motion;
  const SensorSet away = motion.to_exclude(in_service());
  const bool moves = last.moving || studies.slow_motion.slow();
  if ((!motion.found.alarm && away.empty()) || !moves || intake.temperature_out) return 0;
  const bool alarms = machine.mode != Mode::suspect || machine.clean_run > 0;
  const EventMask alarm = alarms ? bit(HealthEvent::alarm) : EventMask{0};
  const bool excludes = !away.empty() && !requests.inhibited && rank_of(in_force.array, in_service() - away) == 3;
  const EventMask found = excludes ? alarm | bit(HealthEvent::provisional_exclusion) : alarm;
  return taken_from_motion(kTransitionTable, machine.mode, found);
}

double MonitorState::motion_in_bound_rad() const noexcept {
  const double g_mps2 = in_force.gravity.g_mps2;
  const double now_rad = std::fmax(diagnosis.drift_rad(), studies.slow_motion.now_rad()) +
                         std::sqrt(3.0 * last.evidence.spread_mps2_sq) / g_mps2;
  return std::fmax(now_rad, studies.slow_motion.bound_rad(g_mps2));
}

double MonitorState::turn_in_bound_rad() const noexcept {
  return motion_in_bound_rad() + acceleration_turn_rad(in_force.gravity, settings.limits.acceleration_mps2);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
