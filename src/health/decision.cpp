// One event per step through the transition table, and what its actions do to the sets.
#include "block_view.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

SizeClass HealthMonitor::classify(SensorSet set) const noexcept {
  if (rank_of(array_, set) < 3) return SizeClass::rank_lost;
  if (!critical_sensors(array_, set).empty()) return SizeClass::critical;
  return set == array_.all() ? SizeClass::all_configured : SizeClass::reduced;
}

void HealthMonitor::sets_changed() noexcept {
  size_class_ = classify(in_service_);
  freshness_.allow_no_motion();
  if (slow_motion_.lately()) freshness_.lapse();  // how fast the others show it to move is not known
  map_ = least_squares(array_, in_service_);
  forget_near();
  mae_.clear_all_sensor();
  isolation_.pose(array_, in_service_ | set_aside_);
  trend_.clear();
  scatter_.clear();
  reference_study_.clear();
  const BlockTests tests(array_, gravity_, limits_, evidence_);
  rescan(tests);
  partial_ = !block_usable_.contains(in_service_) || !doubted().empty();
  if (!have_evidence_) return;
  publish_vector(tests);
  judge_again(tests);
}

/// What the last block says about the sensors that are left: the record of the change keeps what changed it. Not
/// inlined: its view would lie under everything else that a change of the sets calls.
[[gnu::noinline]] void HealthMonitor::judge_again(const BlockTests& tests) noexcept {
  const BlockView view = judge(tests);
  if (view.used.tested) publish_decision(view);
}

void HealthMonitor::forget_episode() noexcept {
  episode_.clear();
  isolation_.clear();
  answer_ = IsolationAnswer{};
  exhausted_ = false;
}

SensorSet move_sensors(Action::Bits actions, const NamedSensors& named, SensorLedger& s) noexcept {
  SensorSet moved;
  if ((actions & Action::exclude) != 0) {
    moved = named.culprits;
    s.excluded = s.excluded | moved;
    // The survivors were just found alive together, those set aside before among them: they serve again, however often
    // they were set aside. Setting aside is no conviction: beyond its own grade it may meet a healthy sensor time and
    // again, and only the grade that convicts may take a sensor out for good.
    s.in_service = (s.in_service | s.set_aside) - moved;
    s.set_aside = SensorSet{};
  }
  if ((actions & Action::set_aside) != 0) {
    moved = named.accused & s.in_service;
    s.in_service = s.in_service - moved;
    s.set_aside = s.set_aside | moved;
  }
  if ((actions & Action::mark_absent) != 0) {
    moved = named.lost - s.absent;
    s.in_service = s.in_service - moved;
    s.set_aside = s.set_aside - moved;
    s.excluded = s.excluded - moved;
    s.absent = s.absent | moved;
  }
  if ((actions & Action::mark_back) != 0) {
    moved = named.back & s.absent;
    s.absent = s.absent - moved;
    s.excluded = s.excluded | moved;
  }
  if ((actions & (Action::reinstate | Action::rearm)) != 0) {
    const bool reinstates = (actions & Action::reinstate) != 0;
    moved =
        reinstates ? SensorSet::of(((named.proven & (s.excluded | s.set_aside)) - s.readmitted).lowest()) : named.reset;
    if (reinstates) s.readmitted = s.readmitted | moved;
    s.excluded = s.excluded - moved;
    s.set_aside = s.set_aside - moved;
    s.absent = s.absent - moved;
    s.in_service = s.in_service | moved;
  }
  return moved;
}

/// What a decision means for everything that the monitor remembers beside the machine.
SensorSet HealthMonitor::carry_out(const Decision& decision, const DecisionState& after) noexcept {
  const SensorSet before = in_service_, posed_before = in_service_ | set_aside_;
  const Action::Bits actions = decision.actions;
  SensorSet named = decision.sensors;
  in_service_ = after.sensors.in_service;
  set_aside_ = after.sensors.set_aside;
  excluded_ = after.sensors.excluded;
  absent_ = after.sensors.absent;
  readmitted_ = after.sensors.readmitted;
  base_ = after.base;
  if ((actions & Action::exclude) != 0) {
    if (asserted_left_ > 0) asserted_left_ -= named.size() < asserted_left_ ? named.size() : asserted_left_;
    forget_episode();
  }
  if ((actions & Action::set_aside) != 0) last_grade_ = Grade::parity;
  if ((actions & Action::mark_absent) != 0) on_probation_ = on_probation_ - named;
  if ((actions & (Action::mark_back | Action::rearm)) != 0) gate_.welcome(named);
  if ((actions & Action::reinstate) != 0) {
    probation_.clear();
    on_probation_ = SensorSet{};
  }
  if ((actions & Action::rearm) != 0) forget_episode();
  if ((actions & (Action::start_fit | Action::discard_fit | Action::restart_fit | Action::adopt_fit)) != 0) {
    const SensorSet fitted = serve_fit(actions);
    if (named.empty()) named = fitted;
  }
  exhausted_ = after.exhausted;
  unproven_ = after.unproven;
  clean_run_ = after.clean_run;
  if ((actions & Action::unproven) != 0) have_predictions_ = false;
  if (before != in_service_) {
    recalibration_.forget();  // its stations were those of other sensors
    if (recalibration_.offered()) drop_request();
  }
  const bool posed_changed = posed_before != (in_service_ | set_aside_);
  if (posed_changed) {
    // The question is another one now: what was answered, and over how many stations, does not carry over.
    answer_ = IsolationAnswer{};
    episode_.take_back();
  }
  if (before != in_service_ || posed_changed) sets_changed();
  return named;
}

HealthEvent HealthMonitor::decide(EventMask raised, double time_s) noexcept {
  DecisionState state{mode_,     base_,      {in_service_, set_aside_, excluded_, absent_, readmitted_},
                      unproven_, exhausted_, clean_run_};
  DecisionInput input;
  input.raised = raised;
  input.named = {
      culprits(),   aside_,        gate_.lost() & array_.all(),
      gate_.back(), on_probation_, (reset_sensors_ - gate_.lost()) & (owes_calibration() ? array_.all() : calibrated_)};
  input.protection_within = unbounded_run_ < config_.clean_blocks;
  input.calibrated = !owes_calibration();
  input.clean_blocks = config_.clean_blocks;
  const Decision decision = plumb::decide(kTransitionTable, state, input, [this](SensorSet set) {
    return set == in_service_ ? size_class_ : classify(set);
  });
  const HealthEvent event = decision.event;
  const Mode from = mode_;
  const double statistic = verdict_.statistic, limit = verdict_.limit;
  const bool by_noise = event == HealthEvent::set_aside && noise_confirmed().contains(aside_);
  const bool refused = event == HealthEvent::contradiction && check_.refused();
  const SensorSet named = carry_out(decision, state);
  mode_ = state.mode;
  if (reset_pending_) {
    reset_pending_ = false;
    reset_sensors_ = SensorSet{};
  }
  follow_first_calibration(from);
  follow_suspicion(event, from);
  if (!decision.changed) return event;
  const Cause asked_by = recalibration_asked_ ? Cause::host_request : Cause::isolated_fault;
  const Cause cause = event == HealthEvent::recalibrate ? asked_by
                      : by_noise                        ? Cause::noisy
                      : refused                         ? Cause::calibration_contradicted
                                                        : cause_of(event, verdict_.cause);
  name_causes(named - in_service_, cause);
  verdict_.cause = cause;
  TransitionRecord& record = verdict_.transition;
  record.sequence = ++sequence_;
  record.time_s = time_s;
  record.from = state_of(from);
  record.to = state_of(mode_);
  record.event = event;
  record.cause = cause;
  record.grade = event == HealthEvent::culprit || event == HealthEvent::set_aside ? last_grade_ : Grade::none;
  record.sensors = named;
  record.statistic = statistic;
  record.limit = limit;
  if (event == HealthEvent::fit_rejected) {
    const Error refusal = recalibration_.progress(array_).last_refusal;
    record.statistic = refusal.value;
    record.limit = refusal.limit;
  }
  if (event == HealthEvent::recalibrate) recalibration_asked_ = recalibration_due_ = false;
  return event;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
