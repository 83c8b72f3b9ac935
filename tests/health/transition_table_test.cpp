// The table against an independent reading of the design: model/state_table.txt is written by hand.
#include "plumb/health/transition_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace transition_table_test {
namespace {

using namespace plumb;

// Negative: REQ-090
TEST(TransitionTable, WhereNothingHappenedNothingIsDone) {
  for (int m = 0; m < kModeCount; ++m) {
    const Cell& cell = cell_of(static_cast<Mode>(m), HealthEvent::none);
    EXPECT_EQ(cell.kind, CellKind::ignored) << m;
    EXPECT_EQ(cell.target, Target::stay) << m;
    EXPECT_EQ(cell.actions, Action::none) << m;
  }
}

// Negative: REQ-095
TEST(TransitionTable, FailedIsLeftByResetAlone) {
  TargetFacts best;
  best.size = SizeClass::all_configured;
  best.enough_passed = best.protection_within = best.calibrated = true;
  for (int e = 0; e < kEventCount; ++e) {
    const auto event = static_cast<HealthEvent>(e);
    const Mode to = resolve(Mode::failed, cell_of(Mode::failed, event).target, best);
    EXPECT_EQ(to == Mode::failed, event != HealthEvent::reset) << to_string(event);
  }
}

// Verifies: REQ-095
TEST(TransitionTable, ResetRearmsByWhatIsThere) {
  const Target target = cell_of(Mode::failed, HealthEvent::reset).target;
  TargetFacts facts;
  facts.calibrated = true;
  facts.size = SizeClass::rank_lost;
  EXPECT_EQ(resolve(Mode::failed, target, facts), Mode::failed);
  facts.size = SizeClass::critical;
  EXPECT_EQ(resolve(Mode::failed, target, facts), Mode::suspect);
  facts.calibrated = false;
  EXPECT_EQ(resolve(Mode::failed, target, facts), Mode::initial);
}

// Verifies: REQ-092
TEST(TransitionTable, BySizeFollowsTheDesign) {
  EXPECT_EQ(mode_by_size(SizeClass::rank_lost), Mode::failed);
  EXPECT_EQ(mode_by_size(SizeClass::critical), Mode::degraded);
  EXPECT_EQ(mode_by_size(SizeClass::all_configured), Mode::nominal);
  EXPECT_EQ(mode_by_size(SizeClass::reduced), Mode::isolated);
}

// Negative: REQ-098
TEST(TransitionTable, TheTimeoutFailsOnlyBeyondTheAlertLimit) {
  TargetFacts facts;
  facts.size = SizeClass::all_configured;
  const Target target = cell_of(Mode::suspect, HealthEvent::isolation_timeout).target;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::failed);
  facts.protection_within = true;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::suspect);
}

// Verifies: REQ-092
TEST(TransitionTable, ANotYetValidatedSuspectExcludesButStays) {
  TargetFacts facts;
  facts.size = SizeClass::reduced;
  facts.not_yet_validated = true;
  const Target target = cell_of(Mode::suspect, HealthEvent::exclusion).target;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::suspect);
  facts.not_yet_validated = false;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::isolated);
  facts.size = SizeClass::rank_lost;
  facts.not_yet_validated = true;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::failed);
}

/// A cell in words: "ignored", "held", "impossible" or the target, and what is done.
struct Words {
  std::string outcome;
  std::set<std::string> actions;
  std::string motion = "-";
  bool operator==(const Words& o) const { return outcome == o.outcome && actions == o.actions && motion == o.motion; }
};
std::ostream& operator<<(std::ostream& out, const Words& w) {
  out << w.outcome << " |";
  for (const std::string& action : w.actions) out << " " << action << ",";
  return out << " | " << w.motion;
}
using Table = std::map<std::string, Words>;  // by "mode / event"

std::string trim(const std::string& s) {
  const auto a = s.find_first_not_of(" \t"), b = s.find_last_not_of(" \t");
  return a == std::string::npos ? std::string() : s.substr(a, b - a + 1);
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(trim(part));
  return parts;
}

/// The hand-written specification: "mode | event | outcome | actions | motion" per line.
Table specification() {
  Table table;
  std::ifstream file(std::string(PLUMB_SOURCE_DIR) + "/model/state_table.txt");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> parts = split(line, '|');
    if (parts.size() != 5) {
      ADD_FAILURE() << "no cell: " << line;
      continue;
    }
    Words cell{parts[2], {}, parts[4]};
    if (parts[3] != "-") {
      for (const std::string& action : split(parts[3], ',')) cell.actions.insert(action);
    }
    EXPECT_TRUE(table.emplace(parts[0] + " / " + parts[1], cell).second) << "written twice: " << line;
  }
  return table;
}

Words words_of(const Cell& cell) {
  Words out;
  if (cell.from_motion) out.motion = "also from motion";
  switch (cell.kind) {
    case CellKind::ignored: out.outcome = "ignored"; break;
    case CellKind::held: out.outcome = "held"; break;
    case CellKind::impossible: out.outcome = "impossible"; break;
    case CellKind::taken: out.outcome = to_string(cell.target); break;
  }
  for (unsigned k = 0; k < 16; ++k) {
    const auto one = static_cast<Action::Bits>(1U << k);
    if ((cell.actions & one) != 0) out.actions.insert(action_name(one));
  }
  return out;
}

/// The cells that are written in one of the two and not, or not so, in the other.
std::vector<std::string> differences(const Table& specified, const TransitionTable& code) {
  std::vector<std::string> out;
  std::set<std::string> met;
  for (int m = 0; m < kModeCount; ++m) {
    for (int e = 0; e + 1 < kEventCount; ++e) {
      const std::string where =
          std::string(to_string(static_cast<Mode>(m))) + " / " + to_string(static_cast<HealthEvent>(e));
      met.insert(where);
      const Words coded = words_of(code[static_cast<std::size_t>(m)][static_cast<std::size_t>(e)]);
      const auto found = specified.find(where);
      if (found != specified.end() && found->second == coded) continue;
      std::ostringstream text;
      text << where << ": the code has " << coded;
      out.push_back(text.str());
    }
  }
  for (const auto& [where, cell] : specified) {
    if (met.count(where) == 0) out.push_back(where + ": no such cell");
  }
  return out;
}

// Verifies: REQ-090
TEST(TransitionTable, AgreesWithTheHandWrittenSpecificationCellByCell) {
  const Table specified = specification();
  EXPECT_EQ(specified.size(), 7U * 14U) << "model/state_table.txt must hold every cell but those of 'none'";
  EXPECT_EQ(differences(specified, kTransitionTable), std::vector<std::string>());
}

/// Each cell with another kind, another target, each action taken away or added, and taken from motion or not: one
/// difference every time.
// Negative: REQ-090
TEST(TransitionTable, ACellThatDiffersInOneThingIsNoticed) {
  const Table specified = specification();
  for (std::size_t m = 0; m < kModeCount; ++m) {
    for (std::size_t e = 0; e + 1 < kEventCount; ++e) {
      const auto noticed = [&](Cell other) {
        TransitionTable changed = kTransitionTable;
        changed[m][e] = other;
        return differences(specified, changed).size() == 1;
      };
      const Cell& cell = kTransitionTable[m][e];
      Cell other = cell;
      other.kind = cell.kind == CellKind::held ? CellKind::ignored : CellKind::held;
      EXPECT_TRUE(noticed(other)) << m << " " << e;
      other = cell;
      other.target = cell.target == Target::base ? Target::by_size : Target::base;
      EXPECT_EQ(noticed(other), cell.kind == CellKind::taken) << m << " " << e << ": no other kind has a target";
      for (int k = 0; k < Action::kinds; ++k) {
        other = cell;
        other.actions = static_cast<Action::Bits>(cell.actions ^ (1U << static_cast<unsigned>(k)));
        EXPECT_TRUE(noticed(other)) << m << " " << e << ", action " << k;
      }
      other = cell;
      other.from_motion = !cell.from_motion;
      EXPECT_TRUE(noticed(other)) << m << " " << e << ", from motion";
    }
  }
}

/// A cell that nobody wrote in the specification, and one of a mode that there is not.
// Negative: REQ-090
TEST(TransitionTable, ACellThatIsMissingInTheSpecificationIsNoticed) {
  const Table specified = specification();
  for (const auto& [where, cell] : specified) {
    Table fewer = specified;
    fewer.erase(where);
    EXPECT_EQ(differences(fewer, kTransitionTable).size(), 1U) << where;
  }
  Table more = specified;
  more["asleep / alarm"] = {"ignored", {}, "-"};
  EXPECT_EQ(differences(more, kTransitionTable).size(), 1U);
}

/// Whatever a monitor in motion raises, no mode takes up more of it than an alarm and a provisional exclusion.
// Verifies: REQ-200
TEST(TransitionTable, FromMotionComeAnAlarmAndAProvisionalExclusionAlone) {
  constexpr EventMask everything = (EventMask{1} << static_cast<unsigned>(kEventCount)) - 1;
  constexpr EventMask alarm = bit(HealthEvent::alarm), excludes = bit(HealthEvent::provisional_exclusion);
  for (int m = 0; m < kModeCount; ++m) {
    const auto mode = static_cast<Mode>(m);
    const bool hears = mode == Mode::nominal || mode == Mode::isolated || mode == Mode::suspect;
    const EventMask expected = hears ? alarm | excludes : mode == Mode::degraded ? alarm : EventMask{0};
    EXPECT_EQ(taken_from_motion(kTransitionTable, mode, everything), expected) << to_string(mode);
    EXPECT_EQ(taken_from_motion(kTransitionTable, mode, 0), EventMask{0}) << to_string(mode);
  }
}

// Verifies: REQ-090
TEST(TransitionTable, EveryActionHasAWordOfItsOwn) {
  std::set<std::string> words;
  for (int k = 0; k < Action::kinds; ++k) {
    const std::string word = action_name(static_cast<Action::Bits>(1U << static_cast<unsigned>(k)));
    EXPECT_NE(word, "?") << k;
    EXPECT_TRUE(words.insert(word).second) << word;
  }
  EXPECT_STREQ(action_name(static_cast<Action::Bits>(1U << static_cast<unsigned>(Action::kinds))), "?");
  EXPECT_STREQ(action_name(Action::none), "?");
  EXPECT_STREQ(action_name(Action::exclude | Action::count), "?") << "two at once";
}

}  // namespace
}  // namespace transition_table_test
