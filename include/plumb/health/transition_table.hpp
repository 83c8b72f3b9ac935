/// The state machine as one constexpr table: it runs in the monitor, static_asserts in
/// src/health/transition_table.cpp prove it total, and `plumb model` prints it. By hand: model/state_table.txt.
///
/// Two departures from the design's drawing, both to make the code's table exact: "recalibrating" before
/// any calibration has been accepted is a mode of its own (`initial`), and provisional exclusion (reversible)
/// is an event of its own, because its target differs from that of an exclusion.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/health/state.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Row of the table: a state, with recalibrating split in two.
enum class Mode : std::uint8_t { nominal, isolated, suspect, degraded, recalibrating, initial, failed };
inline constexpr int kModeCount = 7;
const char* to_string(Mode mode) noexcept;

constexpr HealthState state_of(Mode mode) noexcept {
  switch (mode) {
    case Mode::nominal: return HealthState::nominal;
    case Mode::isolated: return HealthState::isolated;
    case Mode::suspect: return HealthState::suspect;
    case Mode::degraded: return HealthState::degraded_3_sensor;
    case Mode::recalibrating:
    case Mode::initial: return HealthState::recalibrating;
    case Mode::failed: return HealthState::failed;
  }
  return HealthState::failed;
}

/// Where a cell leads; some depend on what is left in service after the cell's actions.
enum class Target : std::uint8_t {
  stay,
  by_size,               ///< failed, degraded, nominal or isolated, by rank, critical sensors and count
  by_size_if_validated,  ///< by size, but who is not yet validated goes to suspect, or stays there
  by_size_when_passed,   ///< by size after R passed blocks (not yet validated: excited ones), else stay
  suspect,
  suspect_or_failed,  ///< failed where rank < 3
  stay_or_failed,     ///< failed where rank < 3
  by_protection,      ///< stay while the doubt has a bound or a way out, else failed
  recalibrating,
  base,   ///< back where recalibration came from: suspect, or by size
  rearm,  ///< rank < 3: stay; no calibration: initial; else suspect(not yet validated)
  failed,
};
const char* to_string(Target target) noexcept;

/// What a cell does besides moving.
struct Action {
  using Bits = std::uint16_t;
  static constexpr Bits none = 0;
  static constexpr Bits exclude = 1;                ///< latch the isolated sensors out
  static constexpr Bits exclude_provisionally = 2;  ///< take the suspected sensors out of service, reversibly
  static constexpr Bits mark_absent = 4;
  static constexpr Bits mark_back = 8;  ///< absent -> excluded, open to probation
  static constexpr Bits discard_fit = 16;
  static constexpr Bits restart_fit = 32;  ///< drop the collected stations
  static constexpr Bits adopt_fit = 64;
  static constexpr Bits start_fit = 128;
  static constexpr Bits reinstate = 256;
  static constexpr Bits rearm = 512;               ///< return the named sensors, forget the episode
  static constexpr Bits timed_out = 1024;          ///< set the qualifier
  static constexpr Bits not_yet_validated = 2048;  ///< validation begins anew
  static constexpr Bits count = 4096;              ///< recorded, nothing else
  static constexpr int kinds = 13;                 ///< how many there are, one bit each
};
/// The word for one action; "?" where `one` is not exactly one of them.
const char* action_name(Action::Bits one) noexcept;

enum class CellKind : std::uint8_t { taken, ignored, held, impossible };

struct Cell {
  CellKind kind : 7;
  /// Also taken where the event is what a monitor in motion found (property S7); elsewhere such an event is none.
  bool from_motion : 1;
  Target target;
  Action::Bits actions;

  constexpr Cell() noexcept : Cell(CellKind::impossible, Target::failed, Action::none) {}
  constexpr Cell(CellKind what, Target where, Action::Bits does, bool in_motion = false) noexcept
      : kind(what), from_motion(in_motion), target(where), actions(does) {}
};
static_assert(sizeof(Cell) == 4, "105 of them are in every image");

namespace table_detail {

/// A cell with the event that it is for: `on(E::alarm).to(T::suspect).does(A::discard_fit)`.
struct Entry {
  HealthEvent event = HealthEvent::none;
  Cell cell;

  constexpr Entry to(Target target) const { return {event, {CellKind::taken, target, cell.actions}}; }
  constexpr Entry does(Action::Bits actions) const { return {event, {cell.kind, cell.target, actions}}; }
  constexpr Entry also_from_motion() const { return {event, {cell.kind, cell.target, cell.actions, true}}; }
  constexpr Entry ignored() const { return {event, {CellKind::ignored, Target::stay, Action::none}}; }
  constexpr Entry held() const { return {event, {CellKind::held, Target::stay, Action::none}}; }
  /// Not reachable; were it reached, the monitor would fail.
  constexpr Entry impossible() const { return {event, {CellKind::impossible, Target::failed, Action::none}}; }
};
constexpr Entry on(HealthEvent event) { return {event, {}}; }

using A = Action;
using E = HealthEvent;
using T = Target;
/// Every event once, in rank order: asserted in src/health/transition_table.cpp.
using Row = std::array<Entry, kEventCount>;

constexpr Row kInService = {
    on(E::reset).ignored(),
    on(E::channel_lost).to(T::by_size).does(A::mark_absent),
    on(E::channel_back).to(T::stay).does(A::mark_back),
    on(E::exclusion).to(T::by_size).does(A::exclude),
    on(E::provisional_exclusion).to(T::suspect_or_failed).does(A::exclude_provisionally).also_from_motion(),
    on(E::isolation_timeout).impossible(),
    on(E::no_consistent_hypothesis).to(T::suspect),
    on(E::alarm).to(T::suspect).also_from_motion(),
    on(E::norm_mismatch).to(T::suspect),
    on(E::fit_accepted).impossible(),
    on(E::fit_rejected).impossible(),
    on(E::probation_passed).to(T::by_size).does(A::reinstate),
    on(E::recalibrate).to(T::recalibrating).does(A::start_fit),
    on(E::passed_block).to(T::stay).does(A::count),
    on(E::none).ignored(),
};
constexpr Row kSuspect = {
    on(E::reset).ignored(),
    on(E::channel_lost).to(T::stay_or_failed).does(A::mark_absent),
    on(E::channel_back).to(T::stay).does(A::mark_back),
    on(E::exclusion).to(T::by_size_if_validated).does(A::exclude),
    on(E::provisional_exclusion).to(T::stay_or_failed).does(A::exclude_provisionally).also_from_motion(),
    on(E::isolation_timeout).to(T::by_protection).does(A::timed_out),
    on(E::no_consistent_hypothesis).to(T::stay).does(A::count),
    on(E::alarm).to(T::stay).does(A::count).also_from_motion(),
    on(E::norm_mismatch).to(T::stay).does(A::count),
    on(E::fit_accepted).impossible(),
    on(E::fit_rejected).impossible(),
    on(E::probation_passed).held(),
    on(E::recalibrate).to(T::recalibrating).does(A::start_fit),
    on(E::passed_block).to(T::by_size_when_passed).does(A::count),
    on(E::none).ignored(),
};
constexpr Row kDegraded = {
    on(E::reset).ignored(),
    on(E::channel_lost).to(T::by_size).does(A::mark_absent),
    on(E::channel_back).to(T::stay).does(A::mark_back),
    on(E::exclusion).impossible(),
    on(E::provisional_exclusion).impossible(),
    on(E::isolation_timeout).impossible(),
    on(E::no_consistent_hypothesis).to(T::suspect),
    on(E::alarm).to(T::suspect).also_from_motion(),
    on(E::norm_mismatch).to(T::suspect),
    on(E::fit_accepted).impossible(),
    on(E::fit_rejected).impossible(),
    on(E::probation_passed).to(T::by_size).does(A::reinstate),
    on(E::recalibrate).to(T::recalibrating).does(A::start_fit),
    on(E::passed_block).to(T::stay).does(A::count),
    on(E::none).ignored(),
};
constexpr Row kRecalibrating = {
    on(E::reset).ignored(),
    on(E::channel_lost).to(T::suspect_or_failed).does(A::mark_absent | A::discard_fit),
    on(E::channel_back).to(T::stay).does(A::mark_back),
    on(E::exclusion).to(T::by_size_if_validated).does(A::exclude | A::discard_fit),
    on(E::provisional_exclusion).to(T::suspect_or_failed).does(A::exclude_provisionally | A::discard_fit),
    on(E::isolation_timeout).to(T::base).does(A::discard_fit),
    on(E::no_consistent_hypothesis).to(T::suspect).does(A::discard_fit),
    on(E::alarm).to(T::suspect).does(A::discard_fit),
    on(E::norm_mismatch).to(T::suspect).does(A::discard_fit),
    on(E::fit_accepted).to(T::suspect).does(A::adopt_fit | A::not_yet_validated),
    on(E::fit_rejected).to(T::base).does(A::discard_fit),
    on(E::probation_passed).held(),
    on(E::recalibrate).ignored(),
    on(E::passed_block).to(T::stay).does(A::count),
    on(E::none).ignored(),
};
constexpr Row kInitial = {
    on(E::reset).ignored(),
    on(E::channel_lost).to(T::stay_or_failed).does(A::mark_absent | A::restart_fit),
    on(E::channel_back).to(T::stay).does(A::mark_back),
    on(E::exclusion).to(T::stay_or_failed).does(A::exclude | A::restart_fit),
    on(E::provisional_exclusion).to(T::stay_or_failed).does(A::exclude_provisionally | A::restart_fit),
    on(E::isolation_timeout).to(T::stay).does(A::restart_fit),
    on(E::no_consistent_hypothesis).to(T::stay).does(A::restart_fit),
    on(E::alarm).to(T::stay).does(A::restart_fit),
    on(E::norm_mismatch).to(T::stay).does(A::restart_fit),
    on(E::fit_accepted).to(T::suspect).does(A::adopt_fit | A::not_yet_validated),
    on(E::fit_rejected).to(T::stay).does(A::count),
    on(E::probation_passed).held(),
    on(E::recalibrate).ignored(),
    on(E::passed_block).to(T::stay).does(A::count),
    on(E::none).ignored(),
};
constexpr Row kFailed = {
    on(E::reset).to(T::rearm).does(A::rearm | A::not_yet_validated),
    on(E::channel_lost).to(T::stay).does(A::mark_absent),
    on(E::channel_back).to(T::stay).does(A::mark_back),
    on(E::exclusion).ignored(),
    on(E::provisional_exclusion).ignored(),
    on(E::isolation_timeout).ignored(),
    on(E::no_consistent_hypothesis).ignored(),
    on(E::alarm).ignored(),
    on(E::norm_mismatch).ignored(),
    on(E::fit_accepted).ignored(),
    on(E::fit_rejected).ignored(),
    on(E::probation_passed).ignored(),
    on(E::recalibrate).ignored(),
    on(E::passed_block).ignored(),
    on(E::none).ignored(),
};

struct ModeRow {
  Mode mode = Mode::failed;
  Row row;
};
constexpr std::array<ModeRow, kModeCount> kRows = {{
    {Mode::nominal, kInService},
    {Mode::isolated, kInService},
    {Mode::suspect, kSuspect},
    {Mode::degraded, kDegraded},
    {Mode::recalibrating, kRecalibrating},
    {Mode::initial, kInitial},
    {Mode::failed, kFailed},
}};

}  // namespace table_detail

using TransitionTable = std::array<std::array<Cell, kEventCount>, kModeCount>;

namespace table_detail {

constexpr TransitionTable table_of(const std::array<ModeRow, kModeCount>& rows) {
  TransitionTable table{};
  for (const ModeRow& one : rows) {
    for (const Entry& entry : one.row) {
      table[static_cast<std::size_t>(one.mode)][static_cast<std::size_t>(entry.event)] = entry.cell;
    }
  }
  return table;
}

}  // namespace table_detail

inline constexpr TransitionTable kTransitionTable = table_detail::table_of(table_detail::kRows);

constexpr const Cell& cell_of(Mode mode, HealthEvent event) noexcept {
  return kTransitionTable[static_cast<std::size_t>(mode)][static_cast<std::size_t>(event)];
}

/// Events that apply at one step, one bit each.
using EventMask = std::uint32_t;
constexpr EventMask bit(HealthEvent event) noexcept { return EventMask{1} << static_cast<unsigned>(event); }

/// The event that a step takes: the first in rank order that the mode neither ignores nor holds; none where there is no
/// such. An ignored event must not block those behind it, else one level could livelock the rest.
constexpr HealthEvent first_taken(const TransitionTable& table, Mode mode, EventMask raised) noexcept {
  for (int e = 0; e < kEventCount; ++e) {
    if ((raised & bit(static_cast<HealthEvent>(e))) == 0) continue;
    const CellKind kind = table[static_cast<std::size_t>(mode)][static_cast<std::size_t>(e)].kind;
    if (kind == CellKind::taken || kind == CellKind::impossible) return static_cast<HealthEvent>(e);
  }
  return HealthEvent::none;
}
constexpr HealthEvent first_taken(Mode mode, EventMask raised) noexcept {
  return first_taken(kTransitionTable, mode, raised);
}

/// What the mode takes up of the events that a monitor in motion raises.
EventMask taken_from_motion(const TransitionTable& table, Mode mode, EventMask raised) noexcept;

/// What is left in service after an action.
enum class SizeClass : std::uint8_t { rank_lost, critical, all_configured, reduced };

constexpr Mode mode_by_size(SizeClass size) noexcept {
  switch (size) {
    case SizeClass::rank_lost: return Mode::failed;
    case SizeClass::critical: return Mode::degraded;
    case SizeClass::all_configured: return Mode::nominal;
    case SizeClass::reduced: return Mode::isolated;
  }
  return Mode::failed;
}

/// Facts that resolve a conditional target, taken after the cell's actions.
struct TargetFacts {
  SizeClass size = SizeClass::rank_lost;
  bool not_yet_validated = false;
  bool enough_passed = false;  ///< R passed blocks in a row (not yet validated: over stations that move every sensor)
  bool base_suspect = false;   ///< recalibration came from suspect
  bool protection_within = false;  ///< a bound within the alert limit, or a way out (`DecisionInput`)
  bool calibrated = false;
};

constexpr Mode resolve(Mode from, Target target, const TargetFacts& facts) noexcept {
  const bool lost = facts.size == SizeClass::rank_lost;
  switch (target) {
    case Target::stay: return from;
    case Target::by_size: return mode_by_size(facts.size);
    case Target::by_size_if_validated:
      return lost || !facts.not_yet_validated ? mode_by_size(facts.size) : Mode::suspect;
    case Target::by_size_when_passed: return facts.enough_passed ? mode_by_size(facts.size) : from;
    case Target::suspect: return Mode::suspect;
    case Target::suspect_or_failed: return lost ? Mode::failed : Mode::suspect;
    case Target::stay_or_failed: return lost ? Mode::failed : from;
    case Target::by_protection: return facts.protection_within ? from : Mode::failed;
    case Target::recalibrating: return Mode::recalibrating;
    case Target::base: return facts.base_suspect ? Mode::suspect : mode_by_size(facts.size);
    case Target::rearm: return lost ? from : facts.calibrated ? Mode::suspect : Mode::initial;
    case Target::failed: return Mode::failed;
  }
  return Mode::failed;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
