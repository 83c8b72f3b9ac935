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
