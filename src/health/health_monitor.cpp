// The order of one step: admit, gate, convert, collect, judge, decide, publish.
#include "plumb/health/health_monitor.hpp"

#include <cmath>
#include <type_traits>

namespace plumb {
inline namespace PLUMB_ABI {

static_assert(std::is_trivially_copyable<HealthMonitor>::value, "a copy is an assignment");
static_assert(noexcept(std::declval<HealthMonitor&>().step(std::declval<const Sample&>())));

namespace {

/// What the host's freeze leaves of the events: it holds back what moves sensors on evidence and what replaces the
/// calibration. Both are levels or come again with the next block.
/// An isolation timeout that ends recalibration leads back to where that began, but not past what speaks against the
/// tool at the same time (S17; the model in model/ found it).
EventMask allowed(const MonitorState& s, EventMask raised) noexcept {
  if (s.machine.mode == Mode::recalibrating && (raised & kKeptEvents) != 0)
    raised &= ~bit(HealthEvent::isolation_timeout);
  constexpr EventMask kFrozen = bit(HealthEvent::exclusion) | bit(HealthEvent::provisional_exclusion) |
                                bit(HealthEvent::probation_passed) | bit(HealthEvent::recalibrate) |
                                bit(HealthEvent::fit_accepted);
  return s.requests.inhibited ? raised & ~kFrozen : raised;
}

}  // namespace

const Verdict& HealthMonitor::step(const Sample& sample) noexcept {
  verdict_.transition = TransitionRecord{};
  verdict_.tick = false;
  verdict_.accepted = false;
  if (!configured_ && core_sum_ == kNeverConfigured) return verdict_;
  if (!core_holds()) return lose_memory(sample);
  Intake& intake = state_.intake;
  verdict_.time_s = sample.time_s;
  count_up(state_.counters.samples);
  const Arrival arrival = intake.clock.admit(sample.time_s, state_.settings.config.max_gap_s);
  GateResult gate;
  const SensorSet lost = intake.gate.lost(), back = intake.gate.back();
  if (arrival != Arrival::refused) gate = intake.gate.gate(sample);
  if (arrival == Arrival::refused) {
    state_.freshness.note_nothing();
  } else if (gate.gap) {
    state_.freshness.note_gap();
  } else if (arrival == Arrival::in_order) {
    collect_sample(sample, gate);
  }
  // Nothing is decided, and nothing written to that the sum is over, before that has been found as it was left.
  if (lost == intake.gate.lost() && back == intake.gate.back() && !is_eventful(arrival, gate)) {
    publish_sample(state_, sample, verdict_);
    return verdict_;
  }
  if (!steady_holds()) return lose_memory(sample);
  if (arrival == Arrival::refused) {
    refuse(sample);
  } else {
    serve(sample, arrival, gate);
  }
  seal();
  return verdict_;
}

/// Whether a step does more than collect its sample.
bool HealthMonitor::is_eventful(Arrival arrival, const GateResult& gate) const noexcept {
  const MonitorState& s = state_;
  const Requests& asked = s.requests;
  const SensorSet absent = s.machine.sensors.absent;
  const int window = s.settings.config.window;
  const bool fits = s.machine.mode == Mode::recalibrating || s.machine.mode == Mode::initial ||
                    asked.recalibration_asked || asked.recalibration_due;
  return arrival != Arrival::in_order || gate.gap || s.window.block.size() >= window ||
         s.intake.silence.is_due(window) || fits || asked.reset_pending || asked.pending != 0 ||
         !((s.intake.gate.lost() & s.in_force.array.all()) - absent).empty() ||
         !(s.intake.gate.back() & absent).empty() || asked.has_notice() ||
         (asked.motion.any() && s.found_in_motion() != 0) || has_news(s, verdict_);
}

/// One sample into the block and the windows.
void HealthMonitor::collect_sample(const Sample& sample, GateResult& gate) noexcept {
  MonitorState& s = state_;
  Window& window = s.window;
  const Readings y = s.intake.read(s.in_force, s.settings, sample, gate);
  const bool begins = window.block.size() == 0;
  window.note_channels(gate);
  if (s.intake.note_conditions(s.in_force, s.settings, sample, begins)) count_up(s.counters.temperature_out);
  if (begins) s.freshness.begin_block(sample.time_s);
  s.freshness.note(s.in_force.array, s.in_service(), gate.usable, y, s.last.evidence);
  s.intake.silence.add(gate.usable, s.in_force.array.size());
  verdict_.accepted = true;
  const RowPlace place = window.place_of(gate.usable, s.in_service());
  if (place == RowPlace::left_out) return;
  if (place == RowPlace::begins_block) {
    s.intake.gate.begin_block();
    window.begin_block();
  }
  const double count = sample.count > 0 ? sample.count : 1;
  window.add(s.in_force, s.service.map, s.settings.frame, s.in_service(), y, gate.usable, count);
  if (s.studies.slow_motion.slow()) compare_in_motion(y, gate.usable);
  window.raw.add(sample.raw, gate.usable, s.intake.temperature_degc);
}

/// The row that ends a block may be the first of another attitude: the block's vector is held against it, too. Apart
/// from `serve`, beneath which the stack is deepest.
[[gnu::noinline]] void HealthMonitor::compare_with_block(const Sample& sample, GateResult& gate) noexcept {
  const Readings y = state_.intake.read(state_.in_force, state_.settings, sample, gate);
  state_.freshness.compare(state_.in_force.array, state_.in_service(), gate.usable, y, state_.last.evidence);
  if (state_.studies.slow_motion.slow()) compare_in_motion(y, gate.usable);
}

/// In slow motion one sensor may feel the whole of what the bound holds: the vector tells how much it is.
/// A faulty sensor can pull it back. So what the sensors depart by since the block has to be one movement, too: beyond
/// that no reading departs by more than its noise.
void HealthMonitor::compare_in_motion(const Readings& y, SensorSet usable) noexcept {
  const MonitorState& s = state_;
  const LeastSquares& map = s.service.map;
  const SensorSet in_service = s.in_service();
  if (!usable.contains(in_service) || !map.valid) return;
  state_.freshness.compare_vectors(s.window.latest_mps2, s.last.gravity_mps2);
  Readings away{};
  for (std::size_t a = 0; a < away.size(); ++a) away[a] = y[a] - s.last.evidence.mean_mps2[a];
  const Vec3 moved = map.estimate(away);
  for (int i = 0; i < s.in_force.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    if (in_service.has(i)) state_.freshness.compare_residual(i, away[a] - dot(s.in_force.array.axis(i), moved));
  }
}

/// The sample is refused and the windows stay as they are; what was valid is now only held. What is rare is cold: small
/// rather than fast in a file that is compiled for speed.
[[gnu::cold]] void HealthMonitor::refuse(const Sample& sample) noexcept {
  count_up(state_.counters.time_refused);
  const bool asked = state_.requests.reset_pending;
  const Validity held = verdict_.validity == Validity::invalid ? Validity::invalid : Validity::held;
  state_.last.cause = Cause::time_fault;
  verdict_.sample = state_.counters.samples;
  verdict_.cause = Cause::time_fault;
  publish_claims(state_, held, verdict_);
  if (!asked) return;
  // The host's key is served whatever the clock does.
  take_event(bit(HealthEvent::reset), 0, state_.intake.clock.last_s());
  state_.last.cause = Cause::time_fault;
  publish_now(sample, false);
}

[[gnu::cold]] void HealthMonitor::empty_windows() noexcept {
  state_.intake.gate.begin_block();
  state_.window.begin_block();
  state_.window.mae.clear();
  state_.diagnosis.leave_station();
  state_.diagnosis.end_rest();
  state_.studies.slow_motion.lapse();
}

[[gnu::cold]] void HealthMonitor::serve_gap(Arrival arrival) noexcept {
  if (arrival == Arrival::new_time_base) {
    state_.last.known = false;  // its age is no longer known
    state_.studies.trend.clear();
    state_.studies.temperature_rate.clear();
  }
  count_up(state_.counters.gaps);
  state_.last.cause = Cause::gap;
  empty_windows();
  if (arrival != Arrival::in_order) state_.freshness.lapse();
}

/// The events of a row: of the block that it completes, and of channels that fall silent or deliver again.
EventMask HealthMonitor::serve_rows(const Sample& sample, GateResult& gate, bool& ticked) noexcept {
  MonitorState& s = state_;
  const MonitorConfig& config = s.settings.config;
  EventMask raised = 0;
  ticked = s.window.block.size() >= config.window;
  if (ticked) {
    raised |= tick(sample);
    compare_with_block(sample, gate);
  }
  const SensorSet absent = s.machine.sensors.absent, all = s.in_force.array.all();
  if (s.intake.silence.is_due(config.window)) {
    const SensorSet silent = s.intake.silence.close(s.in_force.array.size(), config.missing_confirm);
    if (!silent.empty()) s.intake.gate.mark_lost(silent - absent);
  }
  if (!((s.intake.gate.lost() & all) - absent).empty()) raised |= bit(HealthEvent::channel_lost);
  if (!(s.intake.gate.back() & absent).empty()) raised |= bit(HealthEvent::channel_back);
  return raised;
}

/// One event through the machine. Where it changes the sensors that serve, the last block is judged once more, by those
/// that are left, before anything is published.
HealthEvent HealthMonitor::take_event(EventMask raised, EventMask from_motion, double time_s) noexcept {
  const SensorSet in_service = state_.in_service(), monitored = state_.monitored();
  const HealthEvent taken = decide(raised, from_motion, time_s);
  const bool others = in_service != state_.in_service() || monitored != state_.monitored();
  if (others && state_.last.known) judge_again();
  return taken;
}

/// What a sample leads to that is not merely collected.
void HealthMonitor::serve(const Sample& sample, Arrival arrival, GateResult& gate) noexcept {
  if (arrival != Arrival::in_order || gate.gap) {
    serve_gap(arrival);
    if (!gate.gap) collect_sample(sample, gate);
  }
  Requests& asked = state_.requests;
  bool ticked = false;
  EventMask raised = asked.reset_pending ? bit(HealthEvent::reset) : 0;
  if (!gate.gap) raised |= serve_rows(sample, gate, ticked);
  raised |= advance_recalibration(sample.time_s);
  raised = allowed(state_, raised | asked.pending);
  const EventMask motion = state_.found_in_motion();
  const bool any = (raised | motion) != 0;
  const HealthEvent taken = any ? take_event(raised, motion, sample.time_s) : HealthEvent::none;
  if (verdict_.transition.sequence == 0) give_notice(sample.time_s);
  const bool channel = taken == HealthEvent::channel_lost || taken == HealthEvent::channel_back;
  asked.pending = channel || taken == HealthEvent::reset ? raised & kKeptEvents : 0;
  if (ticked || any || arrival != Arrival::in_order || has_news(state_, verdict_)) {
    publish_now(sample, ticked);
  } else {
    verdict_.cause = state_.last.cause;
    publish_sample(state_, sample, verdict_);
  }
}

void HealthMonitor::publish_now(const Sample& sample, bool ticked) noexcept {
  if (ticked) state_.facts.name_causes(SensorSet{}, Cause::none, state_.in_service());
  publish(state_, sample, ticked, ticked || verdict_.transition.sequence != 0, verdict_);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
