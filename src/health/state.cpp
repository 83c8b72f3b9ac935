#include "plumb/health/state.hpp"

#include "plumb/health/transition_table.hpp"

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
    case HealthEvent::culprit: return "culprit";
    case HealthEvent::set_aside: return "set_aside";
    case HealthEvent::patience_over: return "patience_over";
    case HealthEvent::contradiction: return "contradiction";
    case HealthEvent::alarm: return "alarm";
    case HealthEvent::reference: return "reference";
    case HealthEvent::fit_accepted: return "fit_accepted";
    case HealthEvent::fit_rejected: return "fit_rejected";
    case HealthEvent::probation_passed: return "probation_passed";
    case HealthEvent::recalibrate: return "recalibrate";
    case HealthEvent::clean_block: return "clean_block";
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
    case Cause::reference: return "reference";
    case Cause::moving: return "moving";
    case Cause::isolated_fault: return "isolated_fault";
    case Cause::contradiction: return "contradiction";
    case Cause::channel_lost: return "channel_lost";
    case Cause::channel_back: return "channel_back";
    case Cause::temperature: return "temperature";
    case Cause::patience: return "patience";
    case Cause::calibration: return "calibration";
    case Cause::probation: return "probation";
    case Cause::host_request: return "host_request";
    case Cause::time_fault: return "time_fault";
    case Cause::gap: return "gap";
    case Cause::clean: return "clean";
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
  }
  return "?";
}

Cause cause_of(HealthEvent event, Cause of_block) noexcept {
  switch (event) {
    case HealthEvent::reset: return Cause::host_request;
    case HealthEvent::channel_lost: return Cause::channel_lost;
    case HealthEvent::channel_back: return Cause::channel_back;
    case HealthEvent::culprit:
    case HealthEvent::set_aside: return Cause::isolated_fault;
    case HealthEvent::patience_over: return Cause::patience;
    case HealthEvent::contradiction: return Cause::contradiction;
    case HealthEvent::alarm: return of_block;
    case HealthEvent::reference: return Cause::reference;
    case HealthEvent::recalibrate:
    case HealthEvent::fit_accepted:
    case HealthEvent::fit_rejected: return Cause::calibration;
    case HealthEvent::probation_passed: return Cause::probation;
    case HealthEvent::clean_block: return Cause::clean;
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
    case Grade::parity: return "parity";
    case Grade::strict: return "strict";
    case Grade::asserted: return "asserted";
  }
  return "?";
}

const char* to_string(Mode mode) noexcept {
  switch (mode) {
    case Mode::nominal: return "nominal";
    case Mode::isolated: return "isolated";
    case Mode::suspect: return "suspect";
    case Mode::degraded: return "degraded";
    case Mode::recalibrating: return "recalibrating";
    case Mode::initial: return "recalibrating (initial)";
    case Mode::failed: return "failed";
  }
  return "?";
}

const char* to_string(Target target) noexcept {
  switch (target) {
    case Target::stay: return "stay";
    case Target::by_size: return "by size";
    case Target::by_size_if_proven: return "by size (unproven: suspect)";
    case Target::by_size_when_earned: return "by size when earned";
    case Target::suspect: return "suspect";
    case Target::suspect_or_failed: return "suspect (rank < 3: failed)";
    case Target::stay_or_failed: return "stay (rank < 3: failed)";
    case Target::by_protection: return "stay while bounded or isolable, else failed";
    case Target::recalibrating: return "recalibrating";
    case Target::base: return "by size; from suspect: suspect";
    case Target::rearm: return "suspect (rank < 3: stay; no calibration: recalibrating (initial))";
    case Target::failed: return "failed";
  }
  return "?";
}

const char* action_name(Action::Bits one) noexcept {
  switch (one) {
    case Action::exclude: return "exclude";
    case Action::set_aside: return "set aside";
    case Action::mark_absent: return "mark absent";
    case Action::mark_back: return "mark as back";
    case Action::discard_fit: return "discard fit";
    case Action::restart_fit: return "restart collection";
    case Action::adopt_fit: return "adopt fit";
    case Action::start_fit: return "start fit";
    case Action::reinstate: return "reinstate";
    case Action::rearm: return "return named sensors";
    case Action::exhausted: return "exhausted";
    case Action::unproven: return "unproven";
    case Action::count: return "count";
    default: return "?";
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
