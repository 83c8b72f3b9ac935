/// The state machine as one constexpr table: it runs in the monitor, it is proven total by the
/// static_asserts at the end of this file, and `plumb model` prints it. By hand: model/state_table.txt.
///
/// Two departures from the design's drawing, both to make the code's table exact: "recalibrating" before
/// any calibration has been accepted is a mode of its own (`initial`), and setting a sensor aside (parity
/// grade, reversible) is an event of its own, because its target differs from that of a latched culprit.
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
  by_size,              ///< failed, degraded, nominal or isolated, by rank, critical sensors and count
  by_size_if_proven,    ///< by size, but who is unproven goes to suspect, or stays there
  by_size_when_earned,  ///< by size after R clean blocks (unproven: excited ones), else stay
  suspect,
  suspect_or_failed,  ///< failed where rank < 3
  stay_or_failed,     ///< failed where rank < 3
  by_protection,      ///< stay while the doubt has a bound or a way out, else failed
  recalibrating,
  base,   ///< back where recalibration came from: suspect, or by size
  rearm,  ///< rank < 3: stay; no calibration: initial; else suspect(unproven)
  failed,
};
const char* to_string(Target target) noexcept;

/// What a cell does besides moving.
struct Action {
  using Bits = std::uint16_t;
  static constexpr Bits none = 0;
  static constexpr Bits exclude = 1;    ///< latch the culprits out
  static constexpr Bits set_aside = 2;  ///< take the accused out of service, reversibly
  static constexpr Bits mark_absent = 4;
  static constexpr Bits mark_back = 8;  ///< absent -> excluded, open to probation
  static constexpr Bits discard_fit = 16;
  static constexpr Bits restart_fit = 32;  ///< drop the collected stations
  static constexpr Bits adopt_fit = 64;
  static constexpr Bits start_fit = 128;
  static constexpr Bits reinstate = 256;
  static constexpr Bits rearm = 512;       ///< return the named sensors, forget the episode
  static constexpr Bits exhausted = 1024;  ///< set the qualifier
  static constexpr Bits unproven = 2048;   ///< trust must be earned again
  static constexpr Bits count = 4096;      ///< recorded, nothing else
  static constexpr int kinds = 13;         ///< how many there are, one bit each
};
/// The word for one action; "?" where `one` is not exactly one of them.
const char* action_name(Action::Bits one) noexcept;

enum class CellKind : std::uint8_t { taken, ignored, held, impossible };

struct Cell {
  CellKind kind = CellKind::impossible;
  Target target = Target::failed;
  Action::Bits actions = Action::none;
};

namespace table_detail {

constexpr Cell go(Target target, Action::Bits actions = Action::none) { return {CellKind::taken, target, actions}; }
constexpr Cell ignored() { return {CellKind::ignored, Target::stay, Action::none}; }
constexpr Cell held() { return {CellKind::held, Target::stay, Action::none}; }
/// Not reachable; were it reached, the monitor would trust nothing.
constexpr Cell impossible() { return {CellKind::impossible, Target::failed, Action::none}; }

using A = Action;
using T = Target;
using Row = std::array<Cell, kEventCount>;

// Order of columns: reset, channel_lost, channel_back, culprit, set_aside, patience_over, contradiction,
// alarm, reference, fit_accepted, fit_rejected, probation_passed, recalibrate, clean_block, none.
constexpr Row kInService = {
    ignored(),
    go(T::by_size, A::mark_absent),
    go(T::stay, A::mark_back),
    go(T::by_size, A::exclude),
    go(T::suspect_or_failed, A::set_aside),
    impossible(),
    go(T::suspect),
    go(T::suspect),
    go(T::suspect),
    impossible(),
    impossible(),
    go(T::by_size, A::reinstate),
    go(T::recalibrating, A::start_fit),
    go(T::stay, A::count),
    ignored(),
};
constexpr Row kSuspect = {
    ignored(),
    go(T::stay_or_failed, A::mark_absent),
    go(T::stay, A::mark_back),
    go(T::by_size_if_proven, A::exclude),
    go(T::stay_or_failed, A::set_aside),
    go(T::by_protection, A::exhausted),
    go(T::stay, A::count),
    go(T::stay, A::count),
    go(T::stay, A::count),
    impossible(),
    impossible(),
    held(),
    go(T::recalibrating, A::start_fit),
    go(T::by_size_when_earned, A::count),
    ignored(),
};
constexpr Row kDegraded = {
    ignored(),
    go(T::by_size, A::mark_absent),
    go(T::stay, A::mark_back),
    impossible(),
    impossible(),
    impossible(),
    go(T::suspect),
    go(T::suspect),
    go(T::suspect),
    impossible(),
    impossible(),
    go(T::by_size, A::reinstate),
    go(T::recalibrating, A::start_fit),
    go(T::stay, A::count),
    ignored(),
};
constexpr Row kRecalibrating = {
    ignored(),
    go(T::suspect_or_failed, A::mark_absent | A::discard_fit),
    go(T::stay, A::mark_back),
    go(T::by_size_if_proven, A::exclude | A::discard_fit),
    go(T::suspect_or_failed, A::set_aside | A::discard_fit),
    go(T::base, A::discard_fit),
    go(T::suspect, A::discard_fit),
    go(T::suspect, A::discard_fit),
    go(T::suspect, A::discard_fit),
    go(T::suspect, A::adopt_fit | A::unproven),
    go(T::base, A::discard_fit),
    held(),
    ignored(),
    go(T::stay, A::count),
    ignored(),
};
constexpr Row kInitial = {
    ignored(),
    go(T::stay_or_failed, A::mark_absent | A::restart_fit),
    go(T::stay, A::mark_back),
    go(T::stay_or_failed, A::exclude | A::restart_fit),
    go(T::stay_or_failed, A::set_aside | A::restart_fit),
    go(T::stay, A::restart_fit),
    go(T::stay, A::restart_fit),
    go(T::stay, A::restart_fit),
    go(T::stay, A::restart_fit),
    go(T::suspect, A::adopt_fit | A::unproven),
    go(T::stay, A::count),
    held(),
    ignored(),
    go(T::stay, A::count),
    ignored(),
};
constexpr Row kFailed = {
    go(T::rearm, A::rearm | A::unproven),
    go(T::stay, A::mark_absent),
    go(T::stay, A::mark_back),
    ignored(),
    ignored(),
    ignored(),
    ignored(),
    ignored(),
    ignored(),
    ignored(),
    ignored(),
    ignored(),
    ignored(),
    ignored(),
    ignored(),
};

}  // namespace table_detail

using TransitionTable = std::array<std::array<Cell, kEventCount>, kModeCount>;

inline constexpr TransitionTable kTransitionTable = {
    table_detail::kInService,     table_detail::kInService, table_detail::kSuspect, table_detail::kDegraded,
    table_detail::kRecalibrating, table_detail::kInitial,   table_detail::kFailed,
};

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
  bool unproven = false;
  bool earned = false;             ///< R clean blocks in a row (unproven: over stations that move every sensor)
  bool base_suspect = false;       ///< recalibration came from suspect
  bool protection_within = false;  ///< a bound within the alert limit, or a way out (`DecisionInput`)
  bool calibrated = false;
};

constexpr Mode resolve(Mode from, Target target, const TargetFacts& facts) noexcept {
  const bool lost = facts.size == SizeClass::rank_lost;
  switch (target) {
    case Target::stay: return from;
    case Target::by_size: return mode_by_size(facts.size);
    case Target::by_size_if_proven: return lost || !facts.unproven ? mode_by_size(facts.size) : Mode::suspect;
    case Target::by_size_when_earned: return facts.earned ? mode_by_size(facts.size) : from;
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

// ---- Facts about the table that hold at compile time -------------------------------------------

namespace table_detail {

/// Every cell was written down: a defaulted cell is `impossible` with target failed, so an impossible
/// cell must be one of the listed ones and nothing else may be left at its default.
constexpr int count_impossible() {
  int n = 0;
  for (const auto& row : kTransitionTable) {
    for (const auto& cell : row) n += cell.kind == CellKind::impossible ? 1 : 0;
  }
  return n;
}
constexpr bool kinds_are_consistent() {
  for (const auto& row : kTransitionTable) {
    for (const auto& cell : row) {
      const bool idle = cell.target == Target::stay && cell.actions == Action::none;
      if ((cell.kind == CellKind::ignored || cell.kind == CellKind::held) && !idle) return false;
      if (cell.kind == CellKind::taken && idle) return false;
      if (cell.kind == CellKind::impossible && cell.target != Target::failed) return false;
    }
  }
  return true;
}
/// S5: failed is left by reset alone, whatever the facts.
constexpr bool failed_is_latched() {
  for (int e = 0; e < kEventCount; ++e) {
    const Target t = cell_of(Mode::failed, static_cast<HealthEvent>(e)).target;
    if (static_cast<HealthEvent>(e) != HealthEvent::reset && t != Target::stay) return false;
  }
  return true;
}
/// S3: with rank < 3 after the actions, no event that takes a sensor away leaves a mode in service.
constexpr bool rank_loss_fails() {
  TargetFacts facts;
  facts.size = SizeClass::rank_lost;
  facts.calibrated = true;
  for (int m = 0; m < kModeCount; ++m) {
    for (HealthEvent e : {HealthEvent::channel_lost, HealthEvent::culprit, HealthEvent::set_aside}) {
      const Cell& cell = cell_of(static_cast<Mode>(m), e);
      if (cell.kind == CellKind::ignored || cell.kind == CellKind::impossible) continue;
      if (resolve(static_cast<Mode>(m), cell.target, facts) != Mode::failed) return false;
    }
  }
  return true;
}
/// S7: a contradiction or a reference event excludes nobody. S16: an alarm leaves recalibrating.
constexpr bool nobody_is_blamed_without_a_culprit() {
  constexpr Action::Bits blame = Action::exclude | Action::set_aside | Action::mark_absent;
  for (int m = 0; m < kModeCount; ++m) {
    for (HealthEvent e : {HealthEvent::contradiction, HealthEvent::alarm, HealthEvent::reference,
                          HealthEvent::patience_over, HealthEvent::clean_block}) {
      if ((cell_of(static_cast<Mode>(m), e).actions & blame) != 0) return false;
    }
  }
  const Cell& alarm = cell_of(Mode::recalibrating, HealthEvent::alarm);
  return alarm.target == Target::suspect && (alarm.actions & Action::discard_fit) != 0;
}
/// S8 and S19: only an accepted fit adopts, and only out of a recalibrating mode.
constexpr bool adoption_is_guarded() {
  for (int m = 0; m < kModeCount; ++m) {
    for (int e = 0; e < kEventCount; ++e) {
      const bool adopts = (cell_of(static_cast<Mode>(m), static_cast<HealthEvent>(e)).actions & Action::adopt_fit) != 0;
      const bool may = static_cast<HealthEvent>(e) == HealthEvent::fit_accepted &&
                       state_of(static_cast<Mode>(m)) == HealthState::recalibrating;
      if (adopts != may) return false;
    }
  }
  return true;
}
/// S19: from `initial` no event leads to a mode that publishes valid or degraded output.
constexpr bool initial_is_never_trusted() {
  for (int e = 0; e < kEventCount; ++e) {
    const Target t = cell_of(Mode::initial, static_cast<HealthEvent>(e)).target;
    if (t == Target::by_size || t == Target::by_size_if_proven || t == Target::by_size_when_earned ||
        t == Target::base) {
      return false;
    }
  }
  return true;
}

constexpr bool ignored_events_block_nothing() {
  constexpr EventMask both = bit(HealthEvent::reset) | bit(HealthEvent::alarm);
  return first_taken(Mode::nominal, both) == HealthEvent::alarm &&
         first_taken(Mode::failed, both) == HealthEvent::reset &&
         first_taken(Mode::nominal, bit(HealthEvent::alarm) | bit(HealthEvent::culprit)) == HealthEvent::culprit &&
         first_taken(Mode::failed, bit(HealthEvent::alarm)) == HealthEvent::none;
}

static_assert(ignored_events_block_nothing());
static_assert(count_impossible() == 3 + 3 + 2 + 5, "an impossible cell was added, or a cell was left unwritten");
static_assert(kinds_are_consistent());
static_assert(failed_is_latched());
static_assert(rank_loss_fails());
static_assert(nobody_is_blamed_without_a_culprit());
static_assert(adoption_is_guarded());
static_assert(initial_is_never_trusted());

}  // namespace table_detail

}  // namespace PLUMB_ABI
}  // namespace plumb
