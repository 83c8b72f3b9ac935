/// What waits for its step: what the host asked for, what a block said beside an event that came first, and what is to
/// be reported without a change of state.
#pragma once

#include "plumb/core/sensor_set.hpp"
#include "plumb/health/motion_finding.hpp"
#include "plumb/health/reference_study.hpp"
#include "plumb/health/transition_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What a block said is a level: a channel event that ranks before it must not make it unsaid.
inline constexpr EventMask kKeptEvents =
    bit(HealthEvent::alarm) | bit(HealthEvent::no_consistent_hypothesis) | bit(HealthEvent::norm_mismatch);

/// What a monitor in motion found, as the host passed it on, and what became of it.
struct InMotion {
  MotionFinding found;
  /// Those that were provisionally excluded for it and still are; and those that rest reinstated since, while the
  /// finding stays as it was: on memory alone no sensor is excluded twice.
  SensorSet served;

  bool any() const noexcept { return found.alarm || !found.excluded.empty(); }
  SensorSet to_exclude(SensorSet in_service) const noexcept { return (found.excluded & in_service) - served; }
  void follow(SensorSet provisionally_excluded) noexcept {
    served = served & (found.excluded | provisionally_excluded);
  }

  static constexpr auto fields() noexcept { return field_list(&InMotion::found, &InMotion::served); }
};

struct Requests {
  SensorSet reset_sensors;
  EventMask pending = 0;       ///< block events that a channel event pushed back
  std::uint32_t sequence = 0;  ///< of the last record
  bool reset_pending = false;
  bool recalibration_asked = false, recalibration_due = false;  ///< by the host; by the policy, after an exclusion
  bool inhibited = false;                                       ///< as the host left it
  bool inhibit_notice = false, calibration_notice = false;
  Cause alarm_notice = Cause::none;  ///< of an alarm that opened an episode and is not on record yet
  NormMismatchKind reference_notice = NormMismatchKind::none;
  InMotion motion;

  /// Something is to be reported though nothing has changed.
  bool has_notice() const noexcept {
    return inhibit_notice || calibration_notice || alarm_notice != Cause::none ||
           reference_notice != NormMismatchKind::none;
  }

  static constexpr auto core() noexcept {
    using R = Requests;
    return field_list(&R::reset_pending, &R::recalibration_asked, &R::recalibration_due, &R::inhibited,
                      &R::inhibit_notice, &R::calibration_notice, &R::alarm_notice, &R::reference_notice);
  }
  static constexpr auto fields() noexcept {
    using R = Requests;
    return field_list(&R::reset_sensors, &R::pending, &R::sequence, &R::reset_pending, &R::recalibration_asked,
                      &R::recalibration_due, &R::inhibited, &R::inhibit_notice, &R::calibration_notice,
                      up_to(&R::alarm_notice, kLastCause), up_to(&R::reference_notice, NormMismatchKind::common_bias),
                      &R::motion);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
