// The table against an independent reading of the design: model/state_table.txt is written by hand.
#include "plumb/health/transition_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace transition_table_test {
namespace {

using namespace plumb;

// Negative: REQ-090
TEST(TransitionTable, EveryEventOfEveryModeIsWritten) {
  int cells = 0;
  for (int m = 0; m < kModeCount; ++m) {
    for (int e = 0; e < kEventCount; ++e) {
      const Cell& cell = cell_of(static_cast<Mode>(m), static_cast<HealthEvent>(e));
      if (cell.kind == CellKind::taken) {
        EXPECT_FALSE(cell.target == Target::stay && cell.actions == Action::none);
      }
      ++cells;
    }
  }
  EXPECT_EQ(cells, 7 * 15);
}

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
  best.earned = best.protection_within = best.calibrated = true;
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
TEST(TransitionTable, PatienceFailsOnlyBeyondTheAlertLimit) {
  TargetFacts facts;
  facts.size = SizeClass::all_configured;
  const Target target = cell_of(Mode::suspect, HealthEvent::patience_over).target;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::failed);
  facts.protection_within = true;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::suspect);
}

// Verifies: REQ-092
TEST(TransitionTable, UnprovenSuspectExcludesButStays) {
  TargetFacts facts;
  facts.size = SizeClass::reduced;
  facts.unproven = true;
  const Target target = cell_of(Mode::suspect, HealthEvent::culprit).target;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::suspect);
  facts.unproven = false;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::isolated);
  facts.size = SizeClass::rank_lost;
  facts.unproven = true;
  EXPECT_EQ(resolve(Mode::suspect, target, facts), Mode::failed);
}

/// The hand-written specification: "mode | event | kind | target" per line.
std::map<std::string, std::string> specification() {
  std::map<std::string, std::string> cells;
  std::ifstream file(std::string(PLUMB_SOURCE_DIR) + "/model/state_table.txt");
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    std::string mode, event, rest;
    std::getline(in, mode, '|');
    std::getline(in, event, '|');
    std::getline(in, rest);
    const auto trim = [](std::string s) {
      const auto a = s.find_first_not_of(" \t"), b = s.find_last_not_of(" \t");
      return a == std::string::npos ? std::string() : s.substr(a, b - a + 1);
    };
    cells[trim(mode) + "/" + trim(event)] = trim(rest);
  }
  return cells;
}

// Verifies: REQ-090
TEST(TransitionTable, AgreesWithTheHandWrittenSpecificationCellByCell) {
  const auto spec = specification();
  ASSERT_EQ(spec.size(), 7U * 14U) << "model/state_table.txt must hold every cell but those of 'none'";
  for (int m = 0; m < kModeCount; ++m) {
    for (int e = 0; e + 1 < kEventCount; ++e) {
      const auto mode = static_cast<Mode>(m);
      const auto event = static_cast<HealthEvent>(e);
      const Cell& cell = cell_of(mode, event);
      std::string said;
      switch (cell.kind) {
        case CellKind::ignored: said = "ignored"; break;
        case CellKind::held: said = "held"; break;
        case CellKind::impossible: said = "impossible"; break;
        case CellKind::taken: said = to_string(cell.target); break;
      }
      const auto found = spec.find(std::string(to_string(mode)) + "/" + to_string(event));
      ASSERT_NE(found, spec.end()) << to_string(mode) << " / " << to_string(event);
      EXPECT_EQ(found->second, said) << to_string(mode) << " / " << to_string(event);
    }
  }
}

}  // namespace
}  // namespace transition_table_test
