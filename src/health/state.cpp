#include "plumb/health/state.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

const char* to_string(HealthState state) noexcept {
  switch (state) {
    case HealthState::nominal: return "nominal";
    case HealthState::suspect: return "suspect";
    case HealthState::isolated: return "isolated";
    case HealthState::degraded_3_sensor: return "degraded";
    case HealthState::recalibrating: return "recalibrating";
    case HealthState::failed: return "failed";
  }
  return "?";
}

const char* to_string(HealthEvent event) noexcept {
  switch (event) {
    case HealthEvent::reset: return "reset";
    case HealthEvent::channel_lost: return "channel_lost";
    case HealthEvent::channel_back: return "channel_back";
    case HealthEvent::exclusion: return "exclusion";
    case HealthEvent::provisional_exclusion: return "provisional_exclusion";
    case HealthEvent::isolation_timeout: return "isolation_timeout";
    case HealthEvent::no_consistent_hypothesis: return "no_consistent_hypothesis";
    case HealthEvent::alarm: return "alarm";
    case HealthEvent::norm_mismatch: return "norm_mismatch";
    case HealthEvent::fit_accepted: return "fit_accepted";
    case HealthEvent::fit_rejected: return "fit_rejected";
    case HealthEvent::probation_passed: return "probation_passed";
    case HealthEvent::recalibrate: return "recalibrate";
    case HealthEvent::passed_block: return "passed_block";
    case HealthEvent::none: return "none";
  }
  return "?";
}

const char* to_string(Cause cause) noexcept {
  switch (cause) {
    case Cause::none: return "none";
    case Cause::power_on: return "power_on";
    case Cause::parity: return "parity";
    case Cause::norm: return "norm";
    case Cause::mae: return "mae";
    case Cause::norm_mismatch: return "norm_mismatch";
    case Cause::moving: return "moving";
    case Cause::isolated_fault: return "isolated_fault";
    case Cause::no_consistent_hypothesis: return "no_consistent_hypothesis";
    case Cause::channel_lost: return "channel_lost";
    case Cause::channel_back: return "channel_back";
    case Cause::temperature: return "temperature";
    case Cause::isolation_timeout: return "isolation_timeout";
    case Cause::calibration: return "calibration";
    case Cause::probation: return "probation";
    case Cause::host_request: return "host_request";
    case Cause::time_fault: return "time_fault";
    case Cause::gap: return "gap";
    case Cause::passed_block: return "passed_block";
    case Cause::noisy: return "noisy";
    case Cause::stuck: return "stuck";
    case Cause::clipped: return "clipped";
    case Cause::rotating: return "rotating";
    case Cause::inhibited: return "inhibited";
    case Cause::released: return "released";
    case Cause::common_scale: return "common_scale";
    case Cause::common_bias: return "common_bias";
    case Cause::snapshot_refused: return "snapshot_refused";
    case Cause::memory: return "memory";
    case Cause::calibration_contradicted: return "calibration_contradicted";
    case Cause::parity_in_motion: return "parity_in_motion";
  }
  return "?";
}

Cause cause_of(HealthEvent event, Cause of_block) noexcept {
  switch (event) {
    case HealthEvent::reset: return Cause::host_request;
    case HealthEvent::channel_lost: return Cause::channel_lost;
    case HealthEvent::channel_back: return Cause::channel_back;
    case HealthEvent::exclusion:
    case HealthEvent::provisional_exclusion: return Cause::isolated_fault;
    case HealthEvent::isolation_timeout: return Cause::isolation_timeout;
    case HealthEvent::no_consistent_hypothesis: return Cause::no_consistent_hypothesis;
    case HealthEvent::alarm: return of_block;
    case HealthEvent::norm_mismatch: return Cause::norm_mismatch;
    case HealthEvent::recalibrate:
    case HealthEvent::fit_accepted:
    case HealthEvent::fit_rejected: return Cause::calibration;
    case HealthEvent::probation_passed: return Cause::probation;
    case HealthEvent::passed_block: return Cause::passed_block;
    case HealthEvent::none: return Cause::none;
  }
  return Cause::none;
}

const char* to_string(Validity validity) noexcept {
  switch (validity) {
    case Validity::valid: return "valid";
    case Validity::degraded: return "degraded";
    case Validity::unconfirmed: return "unconfirmed";
    case Validity::held: return "held";
    case Validity::invalid: return "invalid";
  }
  return "?";
}

const char* to_string(Grade grade) noexcept {
  switch (grade) {
    case Grade::none: return "none";
    case Grade::provisional: return "provisional";
    case Grade::confirmed: return "confirmed";
    case Grade::assumed: return "assumed";
  }
  return "?";
}

}  // namespace PLUMB_ABI
}  // namespace plumb
