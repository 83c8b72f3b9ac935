// One event of paper mode through the transition table, and what its actions do.
#include "plumb/paper/paper_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

SizeClass PaperMonitor::classify() const noexcept {
  if (rank_of(array_, in_service_) < 3) return SizeClass::rank_lost;
  if (!critical_sensors(array_, in_service_).empty()) return SizeClass::critical;
  return in_service_ == array_.all() ? SizeClass::all_configured : SizeClass::reduced;
}

void PaperMonitor::forget_episode() noexcept {
  episode_open_ = false;
  timed_out_ = false;
  alarmed_.clear();
  restart_pool();
}

/// Where sensors left, the published vector is freed of what they said.
void PaperMonitor::sets_changed(SensorSet before) noexcept {
  size_class_ = classify();
  clean_run_ = 0;
  restart_pool();
  if (!have_evidence_ || !before.contains(in_service_) || size_class_ == SizeClass::rank_lost) return;
  vector_mps2_ = paper_vector_in_use(fits(), raw_of(mean_), mean_.temperature_degc, in_service_);
  show_vector();
}

SensorSet PaperMonitor::move_channels(Action::Bits actions) noexcept {
  SensorSet named;
  if ((actions & Action::mark_absent) != 0) {
    named = (gate_.lost() & array_.all()) - absent_;
    in_service_ = in_service_ - named;
    excluded_ = excluded_ - named;
    absent_ = absent_ | named;
  }
  if ((actions & Action::mark_back) != 0) {
    named = gate_.back() & absent_;
    absent_ = absent_ - named;
    excluded_ = excluded_ | named;  // the paper has no probation: back by reset alone
    gate_.reinstate(named);
  }
  return named;
}

SensorSet PaperMonitor::act(Action::Bits actions) noexcept {
  const SensorSet before = in_service_;
  SensorSet named;
  if ((actions & Action::exclude) != 0) {  // step 8
    named = accused_;
    in_service_ = in_service_ - named;
    excluded_ = excluded_ | named;
    forget_episode();
  }
  if ((actions & (Action::mark_absent | Action::mark_back)) != 0) named = move_channels(actions);
  if ((actions & Action::rearm) != 0) {
    named = reset_sensors_ - gate_.lost();
    gate_.reinstate(named);
    excluded_ = excluded_ - named;
    absent_ = absent_ - named;
    in_service_ = in_service_ | named;
    forget_episode();
  }
  if ((actions & Action::start_fit) != 0) restart_pool();  // the store is for the stations of the fit now
  if ((actions & Action::adopt_fit) != 0) rest_ = candidate_;
  if ((actions & Action::timed_out) != 0) timed_out_ = true;
  if ((actions & Action::not_yet_validated) != 0) {
    not_yet_validated_ = true;
    clean_run_ = 0;
    clean_.clear();
  }
  if (before != in_service_) sets_changed(before);
  return named;
}

HealthEvent PaperMonitor::decide(EventMask raised, double time_s) noexcept {
  const HealthEvent event = first_taken(mode_, raised);
  const bool was_reset = reset_pending_;
  const Cell& cell = cell_of(mode_, event);
  const Mode from = mode_;
  const SensorSet sets[2] = {in_service_, excluded_};  // who leaves or joins the absent is one of these
  const SensorSet named = act(cell.actions);
  if (event == HealthEvent::fit_rejected) refused_ = in_service_;
  if (was_reset) {
    reset_pending_ = false;
    reset_sensors_ = SensorSet{};
  }

  TargetFacts facts;
  facts.size = size_class_;
  facts.not_yet_validated = not_yet_validated_;
  facts.enough_passed = clean_run_ >= config_.passed_blocks && !not_yet_validated_;
  facts.calibrated = true;
  mode_ = resolve(from, cell.target, facts);
  if (from == Mode::suspect && mode_ != Mode::suspect) restart_pool();

  const bool changed = mode_ != from || sets[0] != in_service_ || sets[1] != excluded_;
  if (!changed) return event;
  const Cause cause = cause_of(event, verdict_.cause);
  verdict_.cause = event == HealthEvent::passed_block ? verdict_.cause : cause;
  TransitionRecord& record = verdict_.transition;
  record.sequence = ++sequence_;
  record.time_s = time_s;
  record.from = state_of(from);
  record.to = state_of(mode_);
  record.event = event;
  record.cause = cause;
  record.sensors = named;
  record.statistic = verdict_.statistic;
  record.limit = verdict_.limit;
  return event;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
