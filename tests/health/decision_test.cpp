// The decision layer by itself: where every action puts a sensor and whom it names, and what a step remembers. Said
// sensor by sensor and event by event, without the table's actions.
#include "plumb/health/detail/decision.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace decision_test {
namespace {

using namespace plumb;

constexpr int kSensors = 3;

bool is_one_of(HealthEvent event, std::initializer_list<HealthEvent> events) {
  for (const HealthEvent e : events) {
    if (e == event) return true;
  }
  return false;
}

enum Place { kServes, kAside, kOut, kSilent };

Place place_of(const SensorLedger& s, int i) {
  return s.in_service.has(i) ? kServes : s.provisionally_excluded.has(i) ? kAside : s.excluded.has(i) ? kOut : kSilent;
}

SensorLedger ledger_of(int places, SensorSet readmitted) {
  SensorLedger s;
  for (int i = 0; i < kSensors; ++i, places /= 4) {
    SensorSet* sets[] = {&s.in_service, &s.provisionally_excluded, &s.excluded, &s.absent};
    *sets[places % 4] = sets[places % 4]->with(i);
  }
  s.readmitted = readmitted;
  return s;
}

/// Where sensor i is after `action` when it was at `from`, by the words of the design; `asked` is whether it was named,
/// and `chosen` which one probation gives back.
Place moved_to(Action::Bits action, Place from, bool asked, bool chosen) {
  switch (action) {
    case Action::exclude: return asked ? kOut : from == kAside ? kServes : from;
    case Action::exclude_provisionally: return asked && from == kServes ? kAside : from;
    case Action::mark_absent: return asked ? kSilent : from;
    case Action::mark_back: return asked && from == kSilent ? kOut : from;
    case Action::reinstate: return chosen ? kServes : from;
    case Action::rearm: return asked ? kServes : from;
    default: return from;
  }
}

/// Who is asked about, for each action; all other sets hold everybody, so that a mistaken one is noticed.
NamedSensors naming(Action::Bits action, SensorSet asked) {
  const SensorSet all = SensorSet::first(kSensors);
  NamedSensors named{all, all, all, all, all, all, {}};
  (action == Action::exclude                 ? named.isolated
   : action == Action::exclude_provisionally ? named.suspected
   : action == Action::mark_absent           ? named.lost
   : action == Action::mark_back             ? named.back
   : action == Action::reinstate             ? named.proven
                                             : named.reset) = asked;
  return named;
}

/// The one that probation gives back: the first of those named that is out, or aside, and has not come back before.
int given_back(const SensorLedger& s, SensorSet asked) {
  for (int i = 0; i < kSensors; ++i) {
    const Place at = place_of(s, i);
    if (asked.has(i) && (at == kOut || at == kAside) && !s.readmitted.has(i)) return i;
  }
  return -1;
}

void expect_moves(Action::Bits action, const SensorLedger& before, SensorSet asked) {
  SensorLedger after = before;
  const SensorSet told = move_sensors(action, naming(action, asked), after);
  const int back = given_back(before, asked);
  SensorSet expected;
  for (int i = 0; i < kSensors; ++i) {
    const Place from = place_of(before, i);
    const Place to = moved_to(action, from, asked.has(i), i == back);
    ASSERT_EQ(place_of(after, i), to) << "action " << action << ", sensor " << i << " from " << from;
    const bool whoever = action == Action::exclude || action == Action::rearm;  // also one that is there already
    if (whoever ? asked.has(i) : to != from) expected = expected.with(i);
  }
  ASSERT_EQ(told, expected) << "action " << action << " of " << asked.bits;
  const bool returns = action == Action::reinstate && back >= 0;
  ASSERT_EQ(after.readmitted, returns ? before.readmitted.with(back) : before.readmitted) << "action " << action;
}

// Verifies: REQ-101, REQ-099
TEST(Decision, EveryActionPutsEverySensorWhereItBelongsAndNamesThoseMoved) {
  for (const Action::Bits action : {Action::exclude, Action::exclude_provisionally, Action::mark_absent,
                                    Action::mark_back, Action::reinstate, Action::rearm}) {
    for (int places = 0; places < 4 * 4 * 4; ++places) {
      for (unsigned readmitted = 0; readmitted < 8; ++readmitted) {
        for (unsigned asked = 0; asked < 8; ++asked)
          ASSERT_NO_FATAL_FAILURE(expect_moves(action, ledger_of(places, SensorSet(readmitted)), SensorSet(asked)));
      }
    }
  }
}

/// One step with nobody named: whatever changes does so by the event alone.
DecisionState stepped(Mode mode, HealthEvent event, bool timed_out, int clean_run) {
  DecisionState state;
  state.mode = mode;
  state.base = Mode::degraded;
  state.sensors.in_service = SensorSet::first(kSensors);
  state.timed_out = timed_out;
  state.clean_run = clean_run;
  DecisionInput input;
  input.raised = bit(event);
  decide(kTransitionTable, state, input, [](SensorSet) { return SizeClass::critical; });
  return state;
}

template <class Law>
void for_every_event_taken(Law&& law) {
  for (int m = 0; m < kModeCount; ++m) {
    for (int e = 0; e < kEventCount; ++e) {
      const auto mode = static_cast<Mode>(m);
      const auto event = static_cast<HealthEvent>(e);
      if (cell_of(mode, event).kind == CellKind::taken) law(mode, event);
    }
  }
}

/// An isolation timeout that ran out stands until somebody is excluded, the coefficients are other ones, or the key is
/// turned.
// Verifies: REQ-098
TEST(Decision, TimedOutHoldsUntilSomethingIsDecided) {
  for_every_event_taken([](Mode mode, HealthEvent event) {
    const bool ends = is_one_of(event, {HealthEvent::exclusion, HealthEvent::fit_accepted, HealthEvent::reset});
    const bool begins = event == HealthEvent::isolation_timeout && mode == Mode::suspect;
    for (const bool timed_out : {false, true}) {
      EXPECT_EQ(stepped(mode, event, timed_out, 2).timed_out, begins || (timed_out && !ends))
          << to_string(mode) << ", " << to_string(event);
    }
  });
}

/// Passed blocks are counted anew where other coefficients or the key make the past void, and by who serves (below).
// Verifies: REQ-097
TEST(Decision, PassedBlocksCountAnewAfterAFitAndAfterTheKey) {
  for_every_event_taken([](Mode mode, HealthEvent event) {
    const bool anew = is_one_of(event, {HealthEvent::fit_accepted, HealthEvent::reset});
    EXPECT_EQ(stepped(mode, event, false, 2).clean_run, anew ? 0 : 2) << to_string(mode) << ", " << to_string(event);
  });
}

// Verifies: REQ-097
TEST(Decision, PassedBlocksCountAnewForOtherSensors) {
  DecisionState state;
  state.mode = Mode::nominal;
  state.not_yet_validated = false;
  state.sensors.in_service = SensorSet::first(kSensors);
  state.clean_run = 2;
  DecisionInput input;
  input.raised = bit(HealthEvent::provisional_exclusion);
  input.named.suspected = SensorSet::of(1);
  const Decision d = decide(kTransitionTable, state, input, [](SensorSet) { return SizeClass::critical; });
  EXPECT_EQ(state.clean_run, 0);
  EXPECT_EQ(d.sensors, SensorSet::of(1));
  EXPECT_TRUE(d.changed);
}

/// A fit that is dropped leads back to where it was asked for.
// Verifies: REQ-092
TEST(Decision, RecalibratingRemembersWhereItWasEntered) {
  for_every_event_taken([](Mode mode, HealthEvent event) {
    const bool enters = event == HealthEvent::recalibrate;
    EXPECT_EQ(stepped(mode, event, false, 2).base, enters ? mode : Mode::degraded)
        << to_string(mode) << ", " << to_string(event);
  });
}

}  // namespace
}  // namespace decision_test
