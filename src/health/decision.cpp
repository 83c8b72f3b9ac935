// One event per step through the transition table, and what its actions do to the sets.
#include "block_view.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

SizeClass HealthMonitor::classify() const noexcept {
  if (rank_of(array_, in_service_) < 3) return SizeClass::rank_lost;
  if (!critical_sensors(array_, in_service_).empty()) return SizeClass::critical;
  return in_service_ == array_.all() ? SizeClass::all_configured : SizeClass::reduced;
}

void HealthMonitor::sets_changed() noexcept {
  size_class_ = classify();
  map_ = least_squares(array_, in_service_);
  mae_.clear_all_sensor();
  isolation_.pose(array_, in_service_ | set_aside_);
  trend_.clear();
  scatter_.clear();
  reference_study_.clear();
  rescan();
  partial_ = !block_usable_.contains(in_service_) || !doubted().empty();
  if (!have_evidence_) return;
  publish_vector();
  // What the last block says about the sensors that are left: the record of the change keeps what changed it.
  const BlockView view = judge(evidence_);
  if (view.used.tested) publish_decision(view);
}

void HealthMonitor::forget_episode() noexcept {
  episode_.clear();
  isolation_.clear();
  answer_ = IsolationAnswer{};
  exhausted_ = false;
}

void HealthMonitor::retire(SensorSet culprits) noexcept {
  in_service_ = in_service_ - culprits;
  set_aside_ = set_aside_ - culprits;
  excluded_ = excluded_ | culprits;
  banned_ = banned_ | (culprits & readmitted_);  // readmitted once and convicted again: out for good
  if (asserted_left_ > 0) asserted_left_ -= culprits.size() < asserted_left_ ? culprits.size() : asserted_left_;
  forget_episode();
}

SensorSet HealthMonitor::move_channels(Action::Bits actions) noexcept {
  SensorSet named;
  if ((actions & Action::mark_absent) != 0) {
    named = (gate_.lost() & array_.all()) - absent_;
    in_service_ = in_service_ - named;
    set_aside_ = set_aside_ - named;
    excluded_ = excluded_ - named;
    absent_ = absent_ | named;
    on_probation_ = on_probation_ - named;
  }
  if ((actions & Action::mark_back) != 0) {
    named = gate_.back() & absent_;
    absent_ = absent_ - named;
    excluded_ = excluded_ | named;
    banned_ = banned_ | (named & readmitted_);
    gate_.welcome(named);
  }
  return named;
}

SensorSet HealthMonitor::return_to_service(Action::Bits actions) noexcept {
  SensorSet named;
  if ((actions & Action::reinstate) != 0) {
    named = SensorSet::of((on_probation_ & (excluded_ | set_aside_)).lowest());
    readmitted_ = readmitted_ | named;
    probation_.clear();
    on_probation_ = SensorSet{};
  }
  if ((actions & Action::rearm) != 0) {
    named = reset_sensors_ - gate_.lost();
    gate_.welcome(named);
    forget_episode();
  }
  excluded_ = excluded_ - named;
  set_aside_ = set_aside_ - named;
  absent_ = absent_ - named;
  in_service_ = in_service_ | named;
  return named;
}

SensorSet HealthMonitor::act(Action::Bits actions) noexcept {
  const SensorSet before = in_service_, posed_before = in_service_ | set_aside_;
  SensorSet named;
  if ((actions & Action::exclude) != 0) {
    named = culprits();
    retire(named);
    // The survivors were just found alive together, those set aside before among them: they serve again.
    in_service_ = in_service_ | set_aside_;
    set_aside_ = SensorSet{};
  }
  if ((actions & Action::set_aside) != 0) {
    named = aside_ & in_service_;
    in_service_ = in_service_ - named;
    set_aside_ = set_aside_ | named;
    banned_ = banned_ | (named & readmitted_);
    last_grade_ = Grade::parity;
  }
  if ((actions & (Action::mark_absent | Action::mark_back)) != 0) named = move_channels(actions);
  if ((actions & (Action::reinstate | Action::rearm)) != 0) named = return_to_service(actions);
  if ((actions & (Action::start_fit | Action::discard_fit | Action::restart_fit | Action::adopt_fit)) != 0) {
    const SensorSet fitted = serve_fit(actions);
    if (named.empty()) named = fitted;
  }
  if ((actions & Action::exhausted) != 0) exhausted_ = true;
  if ((actions & Action::unproven) != 0) {
    unproven_ = true;
    have_predictions_ = false;
  }
  if (before != in_service_) {
    clean_run_ = 0;
    recalibration_.forget();  // its stations were those of other sensors
  }
  const bool posed_changed = posed_before != (in_service_ | set_aside_);
  if (posed_changed) {
    // The question is another one now: what was answered, and over how many stations, does not carry over.
    answer_ = IsolationAnswer{};
    episode_.candidate = SensorSet{};
    episode_.agreeing.clear();
  }
  if (before != in_service_ || posed_changed) sets_changed();
  return named;
}

HealthEvent HealthMonitor::decide(EventMask raised, double time_s) noexcept {
  const HealthEvent event = first_taken(mode_, raised);
  const bool was_reset = reset_pending_;
  const Cell& cell = cell_of(mode_, event);
  const Mode from = mode_;
  const SensorSet sets[4] = {in_service_, set_aside_, excluded_, absent_};
  const double statistic = verdict_.statistic, limit = verdict_.limit;
  const bool by_noise = event == HealthEvent::set_aside && noise_confirmed_.contains(aside_);
  const SensorSet named = act(cell.actions);
  if (was_reset) {
    reset_pending_ = false;
    reset_sensors_ = SensorSet{};
  }

  TargetFacts facts;
  facts.size = size_class_;
  facts.unproven = unproven_;
  facts.earned = clean_run_ >= config_.clean_blocks && !unproven_;
  facts.base_suspect = base_ == Mode::suspect;
  facts.protection_within = unbounded_run_ < config_.clean_blocks;
  facts.calibrated = true;
  mode_ = resolve(from, cell.target, facts);
  follow_suspicion(event, from);

  const bool changed =
      mode_ != from || sets[0] != in_service_ || sets[1] != set_aside_ || sets[2] != excluded_ || sets[3] != absent_;
  if (!changed) return event;
  const Cause asked_by = recalibration_asked_ ? Cause::host_request : Cause::isolated_fault;
  const Cause cause = event == HealthEvent::recalibrate ? asked_by
                      : by_noise                        ? Cause::noisy
                                                        : cause_of(event, verdict_.cause);
  name_causes(named - in_service_, cause);
  if (event != HealthEvent::alarm && event != HealthEvent::clean_block) verdict_.cause = cause;
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
