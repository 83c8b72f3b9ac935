// Recalibration in the monitor: who may ask for it, what it is fed, what adopting it empties.
#include <cmath>

#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

bool HealthMonitor::may_recalibrate() const noexcept {
  if (!kRecalibrates) return false;
  if (!configured_ || !set_aside_.empty()) return false;
  switch (mode_) {
    case Mode::nominal:
    case Mode::isolated:
    case Mode::degraded: return !episode_.open && !unproven_;
    case Mode::suspect:
      // A fit of three sensors never clears an alarm: nothing but the fit itself would vouch for it.
      if (size_class_ == SizeClass::critical) return false;
      return suspicion_ == Cause::contradiction || (suspicion_ == Cause::reference && !episode_.open);
    case Mode::recalibrating:
    case Mode::initial:
    case Mode::failed: return false;
  }
  return false;
}

Expected<void> HealthMonitor::request_recalibration() noexcept {
  if (!whole()) return fail(Errc::not_calibrated);
  if (!may_recalibrate()) return fail(Errc::wrong_state, -1, static_cast<double>(state_of(mode_)));
  // A fit takes the length at every station for gravity's: a steady push would end in the biases, and nothing would
  // show it. An offer is not fitted to the length, only tried by it, within limits that carry the bound.
  if (config_.acceleration_bound_mps2 > 0.0)
    return fail(Errc::may_accelerate, -1, config_.acceleration_bound_mps2, 0.0);
  recalibration_.withdraw_offer();
  recalibration_asked_ = true;
  seal();
  return {};
}

/// The condition for which the host asked is no news while the fit that may end it is being made; all else aborts it.
bool HealthMonitor::expected(HealthEvent event) const noexcept {
  return mode_ == Mode::recalibrating && base_ == Mode::suspect && suspicion_ == cause_of(event, verdict_.cause) &&
         (event == HealthEvent::reference || event == HealthEvent::contradiction);
}

Expected<void> HealthMonitor::offer_calibration(const SensorModel& model, const SensorArray& array) noexcept {
  if (!whole()) return fail(Errc::not_calibrated);
  if (!may_recalibrate()) return fail(Errc::wrong_state, -1, static_cast<double>(state_of(mode_)));
  const Expected<void> taken =
      recalibration_.offer({model_, array_, gravity_, limits_}, model, array, in_service_, clock_.last_s());
  recalibration_asked_ = taken.has_value();  // the host's last word counts
  seal();
  return taken;
}

void HealthMonitor::drop_request() noexcept {
  recalibration_asked_ = false;
  recalibration_.withdraw_offer();
}

EventMask HealthMonitor::advance_recalibration(double time_s) noexcept {
  EventMask raised = 0;
  if (mode_ == Mode::recalibrating || mode_ == Mode::initial) {
    switch (recalibration_.step({model_, array_, gravity_, limits_}, time_s)) {
      case Recalibration::Outcome::accepted: raised |= bit(HealthEvent::fit_accepted); break;
      case Recalibration::Outcome::rejected: raised |= bit(HealthEvent::fit_rejected); break;
      case Recalibration::Outcome::none: break;
    }
  }
  const bool due = recalibration_due_ && mode_ == Mode::isolated && clean_run_ >= config_.clean_blocks;
  if ((recalibration_asked_ || due) && may_recalibrate()) raised |= bit(HealthEvent::recalibrate);
  return raised;
}

SensorSet HealthMonitor::serve_fit(Action::Bits actions) noexcept {
  if (!kRecalibrates) return {};
  if ((actions & Action::start_fit) != 0) {
    recalibration_.start(in_service_);
    return in_service_;
  }
  if ((actions & Action::adopt_fit) != 0) {
    const SensorSet fitted = recalibration_.sensors();
    adopt();
    return fitted;
  }
  if ((actions & Action::discard_fit) != 0) recalibration_.stop();
  if ((actions & Action::restart_fit) != 0) recalibration_.forget();
  return {};
}

/// Where nobody has said over which span the coefficients hold, they hold where they were found.
void HealthMonitor::take_span(const StationStore& store) noexcept {
  const MonitorConfig unset;
  double low = store.station(0).temperature_degc, high = low;
  for (int k = 1; k < store.size(); ++k) {
    low = std::fmin(low, store.station(k).temperature_degc);
    high = std::fmax(high, store.station(k).temperature_degc);
  }
  if (config_.temperature_min_degc == unset.temperature_min_degc) temperature_min_degc_ = low;
  if (config_.temperature_max_degc == unset.temperature_max_degc) temperature_max_degc_ = high;
}

/// The collection goes with the sensors in service, and ends with them.
void HealthMonitor::follow_first_calibration(Mode from) noexcept {
  if (mode_ == Mode::initial) {
    if (from != Mode::initial || recalibration_.sensors() != in_service_) recalibration_.start(in_service_);
  } else if (from == Mode::initial && mode_ == Mode::failed) {
    recalibration_.stop();
  }
}

/// What was seen through the old coefficients says nothing about the new ones.
void HealthMonitor::adopt() noexcept {
  if (recalibration_.first()) {
    take_span(recalibration_.store());
    recalibration_.apply(model_, array_, gravity_, clock_.last_s(), false);
    if (!recalibration_.first()) calibrated_ = recalibration_.sensors();
    derive_limits();
    size_class_ = classify(in_service_);
  } else {
    recalibration_.apply(model_, array_, gravity_, clock_.last_s(), base_ == Mode::suspect);
  }
  coefficients_.forget();
  forget_near();
  three_sensor_fit_ = size_class_ == SizeClass::critical;
  check_.clear();
  verdict_.calibration = CalibrationFinding{};
  forget_episode();
  empty_windows();
  scan_ = FaultSetScan{};
  have_evidence_ = false;
  probation_.clear();
  on_probation_ = SensorSet{};
  clean_run_ = unbounded_run_ = 0;
  drift_rad_ = 0.0;
  sets_changed();
}

void HealthMonitor::follow_suspicion(HealthEvent event, Mode from) noexcept {
  switch (event) {
    case HealthEvent::alarm:
    case HealthEvent::contradiction:
    case HealthEvent::reference:
    case HealthEvent::set_aside:
    case HealthEvent::channel_lost:
    case HealthEvent::fit_accepted: suspicion_ = cause_of(event, verdict_.cause); break;
    case HealthEvent::culprit:
      suspicion_ = Cause::none;
      recalibration_due_ = config_.recalibrate_after_exclusion;
      break;
    default: break;
  }
  if (mode_ != Mode::suspect && mode_ != Mode::recalibrating) suspicion_ = Cause::none;
  // Once per exclusion, and only while there are sensors to spare; a request does not outlive the state that took it.
  if (mode_ == Mode::nominal || mode_ == Mode::degraded || mode_ == Mode::failed) recalibration_due_ = false;
  if (mode_ != from && event != HealthEvent::recalibrate) drop_request();
}

}  // namespace PLUMB_ABI
}  // namespace plumb
