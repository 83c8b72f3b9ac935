// The words of the transition table, and facts about it that hold at compile time: it is total, failed is latched, and
// no sensor is excluded unless it is isolated.
#include "plumb/health/transition_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

const char* to_string(Mode mode) noexcept {
  switch (mode) {
    case Mode::nominal: return "nominal";
    case Mode::isolated: return "isolated";
    case Mode::suspect: return "suspect";
    case Mode::degraded: return "degraded";
    case Mode::recalibrating: return "recalibrating";
    case Mode::initial: return "recalibrating (initial)";
    case Mode::failed: return "failed";
  }
  return "?";
}

const char* to_string(Target target) noexcept {
  switch (target) {
    case Target::stay: return "stay";
    case Target::by_size: return "by size";
    case Target::by_size_if_validated: return "by size (not yet validated: suspect)";
    case Target::by_size_when_passed: return "by size when enough blocks passed";
    case Target::suspect: return "suspect";
    case Target::suspect_or_failed: return "suspect (rank < 3: failed)";
    case Target::stay_or_failed: return "stay (rank < 3: failed)";
    case Target::by_protection: return "stay while bounded or isolable, else failed";
    case Target::recalibrating: return "recalibrating";
    case Target::base: return "by size; from suspect: suspect";
    case Target::rearm: return "suspect (rank < 3: stay; no calibration: recalibrating (initial))";
    case Target::failed: return "failed";
  }
  return "?";
}

const char* action_name(Action::Bits one) noexcept {
  switch (one) {
    case Action::exclude: return "exclude";
    case Action::exclude_provisionally: return "exclude provisionally";
    case Action::mark_absent: return "mark absent";
    case Action::mark_back: return "mark as back";
    case Action::discard_fit: return "discard fit";
    case Action::restart_fit: return "restart collection";
    case Action::adopt_fit: return "adopt fit";
    case Action::start_fit: return "start fit";
    case Action::reinstate: return "reinstate";
    case Action::rearm: return "return named sensors";
    case Action::timed_out: return "timed out";
    case Action::not_yet_validated: return "not yet validated";
    case Action::count: return "count";
    default: return "?";
  }
}

EventMask taken_from_motion(const TransitionTable& table, Mode mode, EventMask raised) noexcept {
  EventMask out = 0;
  for (int e = 0; e < kEventCount; ++e) {
    if (table[static_cast<std::size_t>(mode)][static_cast<std::size_t>(e)].from_motion)
      out |= raised & bit(static_cast<HealthEvent>(e));
  }
  return out;
}

namespace {

using table_detail::kRows;

/// Every row names every event once, in rank order, and every mode has one row: no cell is written twice or omitted.
constexpr bool rows_are_whole() {
  for (std::size_t m = 0; m < kRows.size(); ++m) {
    if (kRows[m].mode != static_cast<Mode>(m)) return false;
    for (std::size_t e = 0; e < kRows[m].row.size(); ++e) {
      if (kRows[m].row[e].event != static_cast<HealthEvent>(e)) return false;
    }
  }
  return true;
}
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
    for (HealthEvent e : {HealthEvent::channel_lost, HealthEvent::exclusion, HealthEvent::provisional_exclusion}) {
      const Cell& cell = cell_of(static_cast<Mode>(m), e);
      if (cell.kind == CellKind::ignored || cell.kind == CellKind::impossible) continue;
      if (resolve(static_cast<Mode>(m), cell.target, facts) != Mode::failed) return false;
    }
  }
  return true;
}
/// S7: no_consistent_hypothesis and norm_mismatch exclude no sensor. S16: an alarm leaves recalibrating.
constexpr bool nobody_is_blamed_without_a_culprit() {
  constexpr Action::Bits blame = Action::exclude | Action::exclude_provisionally | Action::mark_absent;
  for (int m = 0; m < kModeCount; ++m) {
    for (HealthEvent e : {HealthEvent::no_consistent_hypothesis, HealthEvent::alarm, HealthEvent::norm_mismatch,
                          HealthEvent::isolation_timeout, HealthEvent::passed_block}) {
      if ((cell_of(static_cast<Mode>(m), e).actions & blame) != 0) return false;
    }
  }
  const Cell& alarm = cell_of(Mode::recalibrating, HealthEvent::alarm);
  return alarm.target == Target::suspect && (alarm.actions & Action::discard_fit) != 0;
}
/// S7: what a monitor in motion finds leads to suspect at most, and takes sensors out provisionally at most: no
/// exclusion, timeout, probation, fit or mismatch comes of it, and with rank left (`heeded`) neither degraded nor
/// failed.
constexpr bool motion_decides_nothing_for_good() {
  for (int m = 0; m < kModeCount; ++m) {
    for (int e = 0; e < kEventCount; ++e) {
      const auto from = static_cast<Mode>(m);
      const auto event = static_cast<HealthEvent>(e);
      const Cell& cell = cell_of(from, event);
      if (!cell.from_motion) continue;
      if (event != HealthEvent::alarm && event != HealthEvent::provisional_exclusion) return false;
      if (cell.kind != CellKind::taken) return false;
      if ((cell.actions & ~(Action::exclude_provisionally | Action::count)) != 0) return false;
      for (SizeClass size : {SizeClass::critical, SizeClass::all_configured, SizeClass::reduced}) {
        TargetFacts facts;
        facts.size = size;
        if (resolve(from, cell.target, facts) != Mode::suspect) return false;
      }
    }
  }
  return true;
}
/// What motion finds is taken up by every mode in service and by suspect; a sensor is excluded where some would be left
/// to check one another.
constexpr bool hears_motion(Mode mode) {
  return cell_of(mode, HealthEvent::alarm).from_motion &&
         cell_of(mode, HealthEvent::provisional_exclusion).from_motion == (mode != Mode::degraded);
}
constexpr bool motion_is_heard() {
  return hears_motion(Mode::nominal) && hears_motion(Mode::isolated) && hears_motion(Mode::suspect) &&
         hears_motion(Mode::degraded);
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
    if (t == Target::by_size || t == Target::by_size_if_validated || t == Target::by_size_when_passed ||
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
         first_taken(Mode::nominal, bit(HealthEvent::alarm) | bit(HealthEvent::exclusion)) == HealthEvent::exclusion &&
         first_taken(Mode::failed, bit(HealthEvent::alarm)) == HealthEvent::none;
}

static_assert(rows_are_whole());
static_assert(ignored_events_block_nothing());
static_assert(count_impossible() == 3 + 3 + 2 + 5, "an impossible cell was added, or a cell was left unwritten");
static_assert(kinds_are_consistent());
static_assert(failed_is_latched());
static_assert(rank_loss_fails());
static_assert(nobody_is_blamed_without_a_culprit());
static_assert(motion_decides_nothing_for_good());
static_assert(motion_is_heard());
static_assert(adoption_is_guarded());
static_assert(initial_is_never_trusted());

}  // namespace

}  // namespace PLUMB_ABI
}  // namespace plumb
