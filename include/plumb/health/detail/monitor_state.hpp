/// All that a monitor holds beside what it said last, in parts: each is written to by its own functions, and by the
/// order of a step (health_monitor.cpp). What is asked of several parts at once stands here and changes none.
#pragma once

#include "plumb/health/detail/channel_facts.hpp"
#include "plumb/health/detail/decision.hpp"
#include "plumb/health/detail/diagnosis.hpp"
#include "plumb/health/detail/freshness.hpp"
#include "plumb/health/detail/in_force.hpp"
#include "plumb/health/detail/intake.hpp"
#include "plumb/health/detail/last_block.hpp"
#include "plumb/health/detail/requests.hpp"
#include "plumb/health/detail/settings.hpp"
#include "plumb/health/detail/studies.hpp"
#include "plumb/health/detail/window.hpp"
#include "plumb/health/monitor_counters.hpp"
#include "plumb/health/recalibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct MonitorState {
  Settings settings;
  InForce in_force;
  Service service;
  DecisionState machine;
  Intake intake;
  Window window;
  ChannelFacts facts;
  LastBlock last;
  Diagnosis diagnosis;
  Studies studies;
  Requests requests;
  Freshness freshness;  ///< of the vector of the last block
  Recalibration recalibration;
  MonitorCounters counters;

  SensorSet in_service() const noexcept { return machine.sensors.in_service; }
  SensorSet monitored() const noexcept { return machine.sensors.in_service | machine.sensors.provisionally_excluded; }
  SensorSet doubted() const noexcept { return facts.doubted() & in_service(); }
  /// What a monitor in motion found and the state machine has not taken up, while the tool moves.
  EventMask found_in_motion() const noexcept;
  /// While recalibrating the output is that of the state it came from.
  Mode published_mode() const noexcept { return machine.mode == Mode::recalibrating ? machine.base : machine.mode; }
  SizeClass classify(SensorSet set) const noexcept;
  /// Whether the vector of the last block is that of this sample too.
  bool is_fresh() const noexcept {
    return !last.moving && last.known && freshness.holds(settings.config, intake.clock.last_s() - last.time_s);
  }
  /// Whether a recalibration may begin: asked for by the host, by an offer, or due after an exclusion.
  bool may_recalibrate() const noexcept;
  /// What comes on top of the bound of a block's vector [rad]: what the tool turned by since the block before and
  /// inside this one, docs/theory.md, section 6 ...
  double motion_in_bound_rad() const noexcept;
  /// ... and what an allowed acceleration turns it by as well.
  double turn_in_bound_rad() const noexcept;

  Diagnosis::Terms diagnosis_terms() const noexcept {
    return {settings, in_force, machine, facts, last, studies.check};
  }
  JudgeTerms judge_terms() const noexcept {
    return {settings, in_force, window.mae, in_service(), machine.mode == Mode::suspect, last.partial};
  }
  Recalibration::InForce fit_terms() const noexcept {
    return {in_force.model, in_force.array, in_force.gravity, settings.limits};
  }

  /// What a step writes to that ends no block and raises no event.
  static constexpr auto changing() noexcept { return field_list(&MonitorState::window, &MonitorState::counters); }
  static constexpr auto core() noexcept {
    using S = MonitorState;
    return field_list(&S::in_force, &S::machine, &S::intake, &S::last, &S::requests, &S::freshness);
  }
  static constexpr auto fields() noexcept {
    using S = MonitorState;
    return field_list(&S::settings, &S::in_force, &S::service, &S::machine, &S::intake, &S::window, &S::facts, &S::last,
                      &S::diagnosis, &S::studies, &S::requests, &S::freshness, &S::recalibration, &S::counters);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
