// One event: through the transition table, and what it means for all that the monitor remembers beside the machine.
#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// The sensors in service are others: what follows from them follows anew.
void HealthMonitor::sets_changed() noexcept {
  MonitorState& s = state_;
  const SensorArray& array = s.in_force.array;
  s.service.size = s.classify(s.in_service());
  s.service.map = least_squares(array, s.in_service());
  s.freshness.allow_no_motion();
  if (s.studies.slow_motion.lately()) s.freshness.lapse();  // how fast the others show it to move is not known
  s.window.forget_near();
  s.window.mae.clear_all_sensor();
  s.diagnosis.pose(array, s.monitored());
  s.studies.trend.clear();
  s.studies.gravity.forget_attitudes();
  s.facts.forget_scatter();
  s.last.partial = !s.last.usable.contains(s.in_service()) || !s.doubted().empty();
}

/// What the last block says about the sensors that are left: the record of the change keeps what changed it. Not
/// inlined: its report would lie under everything else that a change of the sets calls.
[[gnu::noinline]] void HealthMonitor::judge_again() noexcept {
  MonitorState& s = state_;
  const BlockTests tests(s.in_force.array, s.in_force.gravity, s.settings.limits, s.last.evidence);
  s.diagnosis.rescan(s.diagnosis_terms(), tests, s.turn_in_bound_rad(), s.studies.gravity.turn_rad());
  keep_vector(tests);
  const BlockReport report = judge(tests, s.judge_terms());
  if (report.used.tested) keep_report(report);
}

/// What a decision leads to; `before`: where the sensors stood. The sensors that it names.
SensorSet HealthMonitor::carry_out(const Decision& decision, const SensorLedger& before) noexcept {
  MonitorState& s = state_;
  Diagnosis& d = s.diagnosis;
  const Action::Bits actions = decision.actions;
  SensorSet named = decision.sensors;
  if ((actions & Action::exclude) != 0) {
    d.spend_asserted(s.in_force.array.units().count(named));
    d.forget_episode();
  }
  if ((actions & Action::exclude_provisionally) != 0) d.grade_by_parity();
  if ((actions & Action::mark_absent) != 0) d.forget_probation_of(named);
  if ((actions & (Action::mark_back | Action::rearm)) != 0) s.intake.gate.reinstate(named);
  if ((actions & Action::reinstate) != 0) d.forget_probation();
  if ((actions & (Action::reinstate | Action::rearm)) != 0) {
    s.studies.check.forget_readings();  // of when the sensors were at fault
    s.studies.check.forget_doubt();
  }
  if ((actions & Action::rearm) != 0) d.forget_episode();
  if ((actions & (Action::start_fit | Action::discard_fit | Action::restart_fit | Action::adopt_fit)) != 0) {
    const SensorSet fitted = serve_fit(actions);
    if (named.empty()) named = fitted;
  }
  if ((actions & Action::not_yet_validated) != 0) d.forget_predictions();
  const bool serve_others = before.in_service != s.in_service();
  if (serve_others) {
    s.studies.check.forget_doubt();
    s.recalibration.forget();  // its stations were those of other sensors
    if (s.recalibration.offered()) drop_request();
  }
  const bool posed_others = (before.in_service | before.provisionally_excluded) != s.monitored();
  if (posed_others) d.withdraw_answer();
  if (serve_others || posed_others) sets_changed();
  return named;
}

HealthEvent HealthMonitor::decide(EventMask raised, EventMask from_motion, double time_s) noexcept {
  MonitorState& s = state_;
  const Diagnosis& d = s.diagnosis;
  const SensorSet all = s.in_force.array.all(), lost = s.intake.gate.lost();
  const bool calibrated = !s.in_force.owes_calibration();
  // Who is found faulty at rest comes first: one event excludes for one reason.
  const bool by_rest = from_motion == 0 || (raised & bit(HealthEvent::provisional_exclusion)) != 0;
  DecisionInput input;
  input.raised = raised;
  input.from_motion = from_motion;
  input.named = {d.isolated(s.diagnosis_terms()),
                 by_rest ? d.aside() : s.requests.motion.to_exclude(s.in_service()),
                 lost & all,
                 s.intake.gate.back(),
                 d.on_probation(),
                 (s.requests.reset_sensors - lost) & (calibrated ? s.in_force.calibrated : all),
                 s.in_force.array.units()};
  input.protection_within = d.unbounded_run() < s.settings.config.passed_blocks;
  input.calibrated = calibrated;
  input.passed_blocks = s.settings.config.passed_blocks;
  const SensorLedger before = s.machine.sensors;
  const Mode from = s.machine.mode;
  const Decision decision = plumb::decide(kTransitionTable, s.machine, input, [&s, before](SensorSet set) {
    return set == before.in_service ? s.service.size : s.classify(set);
  });
  const HealthEvent event = decision.event;
  const bool by_noise =
      event == HealthEvent::provisional_exclusion && d.noise_confirmed(s.in_force.array, s.facts).contains(d.aside());
  const bool refused = event == HealthEvent::no_consistent_hypothesis && s.studies.check.refused();
  const SensorSet named = carry_out(decision, before);
  s.requests.reset_sensors = s.requests.reset_pending ? SensorSet{} : s.requests.reset_sensors;
  s.requests.reset_pending = false;
  follow_first_calibration(from);
  const Cause of_event = decision.from_motion ? Cause::parity_in_motion : cause_of(event, s.last.cause);
  follow_suspicion(event, from, of_event);
  follow_finding(decision);
  if (!decision.changed) return event;
  const Cause asked_by = s.requests.recalibration_asked ? Cause::host_request : Cause::isolated_fault;
  const Cause cause = event == HealthEvent::recalibrate ? asked_by
                      : decision.from_motion            ? of_event
                      : by_noise                        ? Cause::noisy
                      : refused                         ? Cause::calibration_contradicted
                                                        : of_event;
  record(event, from, cause, named, time_s);
  if (event == HealthEvent::recalibrate) s.requests.recalibration_asked = s.requests.recalibration_due = false;
  return event;
}

/// A faulty sensor may hide part of a slow movement: what was valid by that is so no more.
void HealthMonitor::follow_finding(const Decision& decision) noexcept {
  InMotion& motion = state_.requests.motion;
  if (decision.from_motion) {
    state_.freshness.lapse();
    motion.served = motion.served | decision.sensors;
  }
  motion.follow(state_.machine.sensors.provisionally_excluded);
}

/// One record for each change of state or of a set (property S15).
void HealthMonitor::record(HealthEvent event, Mode from, Cause cause, SensorSet named, double time_s) noexcept {
  MonitorState& s = state_;
  s.facts.name_causes(named - s.in_service(), cause, s.in_service());
  s.last.cause = cause;
  const bool graded = event == HealthEvent::exclusion || event == HealthEvent::provisional_exclusion;
  TransitionRecord& out = verdict_.transition;
  out.sequence = ++s.requests.sequence;
  out.time_s = time_s;
  out.from = state_of(from);
  out.to = state_of(s.machine.mode);
  out.event = event;
  out.cause = cause;
  out.grade = graded ? s.diagnosis.last_grade() : Grade::none;
  out.sensors = named;
  out.statistic = s.last.statistic;
  out.limit = s.last.limit;
  s.requests.alarm_notice = Cause::none;  // what opened an episode has led to this, or is less than it
  if (event != HealthEvent::fit_rejected) return;
  const Error refusal = s.recalibration.progress(s.in_force.array).last_refusal;
  out.statistic = refusal.value;
  out.limit = refusal.limit;
}

/// What the host or the evidence said without changing anything: a record of its own.
void HealthMonitor::give_notice(double time_s) noexcept {
  Requests& asked = state_.requests;
  Cause cause = Cause::none;
  HealthEvent event = HealthEvent::none;
  if (asked.alarm_notice != Cause::none) {
    cause = asked.alarm_notice;
    event = HealthEvent::alarm;
    asked.alarm_notice = Cause::none;
  } else if (asked.inhibit_notice) {
    cause = asked.inhibited ? Cause::inhibited : Cause::released;
    asked.inhibit_notice = false;
  } else if (asked.calibration_notice) {
    cause = Cause::calibration_contradicted;
    asked.calibration_notice = false;
  } else if (asked.reference_notice != NormMismatchKind::none) {
    cause = asked.reference_notice == NormMismatchKind::common_scale ? Cause::common_scale : Cause::common_bias;
    asked.reference_notice = NormMismatchKind::none;
  }
  if (cause == Cause::none) return;
  TransitionRecord& out = verdict_.transition;
  out.sequence = ++asked.sequence;
  out.time_s = time_s;
  out.from = out.to = state_of(state_.machine.mode);
  out.event = event;
  out.cause = cause;
  out.statistic = state_.last.statistic;
  out.limit = state_.last.limit;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
