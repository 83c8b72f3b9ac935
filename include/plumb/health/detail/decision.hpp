/// The decision layer without the evidence: which event a step takes, what its actions do to the sensors' places, and
/// where the machine goes. Small plain states, so that tests/health/induction_test.cpp can try all of them.
#pragma once

#include "plumb/array/sensor_units.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/health/monitor_config.hpp"
#include "plumb/health/transition_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Where every sensor stands. The first four partition the array (property S4).
struct SensorLedger {
  SensorSet in_service, provisionally_excluded, excluded, absent;
  SensorSet readmitted;  ///< have come back by probation once: not a second time

  static constexpr auto fields() noexcept {
    using L = SensorLedger;
    return field_list(&L::in_service, &L::provisionally_excluded, &L::excluded, &L::absent, &L::readmitted);
  }
};

/// Which sensors the events of a step are about.
struct NamedSensors {
  SensorSet isolated;   ///< found faulty at the confirmed grade, to be excluded
  SensorSet suspected;  ///< found faulty at the provisional grade or in motion, to be provisionally excluded
  SensorSet lost;       ///< channels that have fallen silent
  SensorSet back;       ///< channels that deliver again
  SensorSet proven;     ///< on probation, and through it; one unit at a time is reinstated
  SensorSet reset;      ///< named by the host
  SensorUnits units;    ///< of the array; by default every sensor is one
};

struct DecisionState {
  SensorLedger sensors;
  int clean_run = 0;  ///< passed blocks in a row
  Mode mode = Mode::suspect;
  Mode base = Mode::suspect;  ///< what recalibrating was entered from
  bool not_yet_validated = true;
  bool timed_out = false;

  static constexpr auto fields() noexcept {
    using S = DecisionState;
    return field_list(&S::sensors, within(&S::clean_run, 0, kMostPassedBlocks), up_to(&S::mode, Mode::failed),
                      up_to(&S::base, Mode::failed), &S::not_yet_validated, &S::timed_out);
  }
};

struct DecisionInput {
  EventMask raised = 0;
  EventMask from_motion = 0;  ///< what a monitor in motion found, beside what was raised
  NamedSensors named;
  /// The doubt has a bound within the alert limit, or an explanation by no more faults than the grade bears whose other
  /// sensors check one another.
  bool protection_within = false;
  bool calibrated = true;
  int passed_blocks = 3;  ///< R
};

struct Decision {
  HealthEvent event = HealthEvent::none;
  Action::Bits actions = Action::none;
  SensorSet sensors;         ///< those that changed their place for it
  bool changed = false;      ///< of state or of place: one record is due (property S15)
  bool from_motion = false;  ///< the event is what a monitor in motion found, and nothing else raised it
};

/// What is taken up of what a monitor in motion found: only what the table allows, and no exclusion that would leave
/// fewer than three directions. So nothing that is found in motion leads to `failed` (property S7).
template <class SizeOf>
EventMask heeded(const TransitionTable& table, const DecisionState& state, const DecisionInput& input,
                 SizeOf&& size_of) noexcept {
  constexpr EventMask kExcludes = bit(HealthEvent::provisional_exclusion);
  const EventMask found = taken_from_motion(table, state.mode, input.from_motion);
  const bool excludes = (found & kExcludes) != 0;
  const bool bears = excludes && size_of(state.sensors.in_service - input.named.suspected) != SizeClass::rank_lost;
  return bears ? found : found & ~kExcludes;
}

/// Carries out the part of the actions that moves sensors; returns those that the event is about.
SensorSet move_sensors(Action::Bits actions, const NamedSensors& named, SensorLedger& sensors) noexcept;

/// One step of the machine. `size_of(set)` tells what is left with a set in service (SizeClass).
template <class SizeOf>
Decision decide(const TransitionTable& table, DecisionState& state, const DecisionInput& input,
                SizeOf&& size_of) noexcept {
  Decision out;
  const EventMask motion = heeded(table, state, input, size_of) & ~input.raised;
  out.event = first_taken(table, state.mode, input.raised | motion);
  out.from_motion = (motion & bit(out.event)) != 0;
  const Cell& cell = table[static_cast<std::size_t>(state.mode)][static_cast<std::size_t>(out.event)];
  out.actions = cell.actions;
  const SensorLedger before = state.sensors;
  const Mode from = state.mode;
  out.sensors = move_sensors(cell.actions, input.named, state.sensors);

  if ((cell.actions & Action::start_fit) != 0) state.base = from;
  if ((cell.actions & Action::not_yet_validated) != 0) state.not_yet_validated = true;
  if ((cell.actions & (Action::exclude | Action::rearm | Action::adopt_fit)) != 0) state.timed_out = false;
  if ((cell.actions & Action::timed_out) != 0) state.timed_out = true;
  const bool anew = out.from_motion || (cell.actions & (Action::adopt_fit | Action::rearm)) != 0;
  if (anew || before.in_service != state.sensors.in_service) state.clean_run = 0;

  TargetFacts facts;
  facts.size = size_of(state.sensors.in_service);
  facts.not_yet_validated = state.not_yet_validated;
  facts.enough_passed = state.clean_run >= input.passed_blocks && !state.not_yet_validated;
  facts.base_suspect = state.base == Mode::suspect;
  facts.protection_within = input.protection_within;
  facts.calibrated = input.calibrated;
  state.mode = resolve(from, cell.target, facts);
  // In failed the qualifier tells that time ran out from that too few sensors are left.
  const bool fails = state.mode == Mode::failed && from != Mode::failed;
  if (fails && (cell.actions & Action::timed_out) == 0) state.timed_out = false;

  const SensorLedger& after = state.sensors;
  out.changed = state.mode != from || before.in_service != after.in_service ||
                before.provisionally_excluded != after.provisionally_excluded || before.excluded != after.excluded ||
                before.absent != after.absent;
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
