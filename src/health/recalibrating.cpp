// Recalibration in the monitor: what the fit is fed, and what adopting it empties.
#include <cmath>

#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

void HealthMonitor::drop_request() noexcept {
  state_.requests.recalibration_asked = false;
  state_.recalibration.withdraw_offer();
}

EventMask HealthMonitor::advance_recalibration(double time_s) noexcept {
  if (!kRecalibrates) return 0;
  MonitorState& s = state_;
  EventMask raised = 0;
  if (s.machine.mode == Mode::recalibrating || s.machine.mode == Mode::initial) {
    switch (s.recalibration.step(s.fit_terms(), time_s)) {
      case Recalibration::Outcome::accepted: raised |= bit(HealthEvent::fit_accepted); break;
      case Recalibration::Outcome::rejected: raised |= bit(HealthEvent::fit_rejected); break;
      case Recalibration::Outcome::none: break;
    }
  }
  const bool due = s.requests.recalibration_due && s.machine.mode == Mode::isolated &&
                   s.machine.clean_run >= s.settings.config.passed_blocks;
  if ((s.requests.recalibration_asked || due) && configured_ && s.may_recalibrate())
    raised |= bit(HealthEvent::recalibrate);
  return raised;
}

SensorSet HealthMonitor::serve_fit(Action::Bits actions) noexcept {
  if (!kRecalibrates) return {};
  Recalibration& fit = state_.recalibration;
  if ((actions & Action::start_fit) != 0) {
    fit.start(state_.in_service());
    return state_.in_service();
  }
  if ((actions & Action::adopt_fit) != 0) {
    const SensorSet fitted = fit.sensors();
    adopt();
    return fitted;
  }
  if ((actions & Action::discard_fit) != 0) fit.stop();
  if ((actions & Action::restart_fit) != 0) fit.forget();
  return {};
}

/// Where it is not stated over which span the coefficients hold, they hold where they were found.
void HealthMonitor::take_span(const StationStore& store) noexcept {
  const MonitorConfig unset;
  const MonitorConfig& config = state_.settings.config;
  double low = store.station(0).temperature_degc, high = low;
  for (int k = 1; k < store.size(); ++k) {
    low = std::fmin(low, store.station(k).temperature_degc);
    high = std::fmax(high, store.station(k).temperature_degc);
  }
  if (config.temperature_min_degc == unset.temperature_min_degc) state_.in_force.temperature_min_degc = low;
  if (config.temperature_max_degc == unset.temperature_max_degc) state_.in_force.temperature_max_degc = high;
}

/// The collection goes with the sensors in service, and ends with them.
void HealthMonitor::follow_first_calibration(Mode from) noexcept {
  Recalibration& fit = state_.recalibration;
  const Mode mode = state_.machine.mode;
  if (mode == Mode::initial) {
    if (from != Mode::initial || fit.sensors() != state_.in_service()) fit.start(state_.in_service());
  } else if (from == Mode::initial && mode == Mode::failed) {
    fit.stop();
  }
}

/// What was seen through the old coefficients says nothing about the new ones.
void HealthMonitor::adopt() noexcept {
  MonitorState& s = state_;
  InForce& now = s.in_force;
  Recalibration& fit = s.recalibration;
  const double now_s = s.intake.clock.last_s();
  if (fit.first()) {
    take_span(fit.store());
    fit.apply(now.model, now.array, now.gravity, now_s, false);
    if (!fit.first()) now.calibrated = fit.sensors();
    s.service.size = s.classify(s.in_service());
  } else {
    fit.apply(now.model, now.array, now.gravity, now_s, s.machine.base == Mode::suspect);
  }
  derive_limits();
  s.intake.coefficients.forget();
  now.three_sensor_fit = s.service.size == SizeClass::critical;
  s.studies.check.clear();
  s.diagnosis.begin_anew();
  empty_windows();
  s.last.known = false;
  sets_changed();
}

void HealthMonitor::follow_suspicion(HealthEvent event, Mode from, Cause cause) noexcept {
  MonitorState& s = state_;
  const Mode mode = s.machine.mode;
  switch (event) {
    case HealthEvent::alarm:
    case HealthEvent::no_consistent_hypothesis:
    case HealthEvent::norm_mismatch:
    case HealthEvent::provisional_exclusion:
    case HealthEvent::channel_lost:
    case HealthEvent::fit_accepted:
      // What rest found stays the cause that keeps the monitor in suspect.
      if (cause != Cause::parity_in_motion || s.diagnosis.suspicion() == Cause::none) s.diagnosis.suspect_for(cause);
      break;
    case HealthEvent::exclusion:
      s.diagnosis.suspect_for(Cause::none);
      s.requests.recalibration_due = s.settings.config.recalibrate_after_exclusion;
      break;
    default: break;
  }
  if (mode != Mode::suspect && mode != Mode::recalibrating) s.diagnosis.suspect_for(Cause::none);
  // Once per exclusion, and only while there are sensors to spare; a request does not outlive the state that took it.
  if (mode == Mode::nominal || mode == Mode::degraded || mode == Mode::failed) s.requests.recalibration_due = false;
  if (mode != from && event != HealthEvent::recalibrate) drop_request();
}

}  // namespace PLUMB_ABI
}  // namespace plumb
