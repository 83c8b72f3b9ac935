// Chips as fault units at rest (docs/theory.md, section 5.7): two triads, and chips beside single sensors. What takes
// three triads is in tests/session/chips_at_rest_test.cpp, at the capacity that holds them.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "support/chip_tool.hpp"

namespace chip_units_test {
namespace {

using namespace plumb;
using namespace plumb_test;

constexpr int kDraws = 40;
constexpr int kBlocks = 8;

const Vec3 kAskew = {0.57735026918962576, 0.57735026918962576, 0.57735026918962576};
const Vec3 kOther = {-0.57735026918962576, 0.57735026918962576, 0.57735026918962576};

struct Told {
  int detected = 0, named = 0, wrong = 0;
};

/// Draws of one fault of one of two chips, over four stations each.
Told of_two(ChipFault fault, const MonitorConfig& config = {}) {
  Told out;
  for (int k = 0; k < kDraws; ++k) {
    ChipRig tool(chip_array(2), config, static_cast<std::uint64_t>(100 + k));
    EXPECT_EQ(tool.begun(), HealthState::nominal) << k;
    tool.fail(k % 2, fault, static_cast<std::uint64_t>(7000 + k));
    for (int s = 0; s < 4; ++s) tool.station(kBlocks);
    const Verdict& v = tool.rig.monitor.verdict();
    out.detected += tool.detected() ? 1 : 0;
    out.named += v.excluded == tool.failed ? 1 : 0;
    out.wrong += tool.failed.contains(tool.rig.ever_blamed) ? 0 : 1;
    EXPECT_EQ(v.grade == Grade::assumed, config.assumed_faults > 0 && !v.excluded.empty()) << k;
  }
  return out;
}

// Verifies: REQ-206
TEST(ChipUnits, OfTwoTriadsTheNormNamesADeadStuckOrBiasedOneWithinFourStations) {
  for (const ChipFault fault : {ChipFault::dead, ChipFault::stuck, ChipFault::biased, ChipFault::one_axis}) {
    const Told told = of_two(fault);
    EXPECT_EQ(told.named, kDraws) << to_string(fault) << ": a chip is excluded with all of its axes";
    EXPECT_EQ(told.wrong, 0) << to_string(fault);
  }
}

/// One below the guarantee, k = 2m + 1: each of two that differ, and have the right length, may be the faulty one.
// Negative: REQ-206
TEST(ChipUnits, OfTwoTriadsATurnedLateNoisyOrHungOneIsDetectedAndNobodyNamed) {
  for (const ChipFault fault : {ChipFault::turned, ChipFault::late, ChipFault::noisy, ChipFault::hung}) {
    Told told;
    for (int k = 0; k < kDraws; ++k) {
      ChipRig tool(chip_array(2), {}, static_cast<std::uint64_t>(100 + k));
      tool.fail(k % 2, fault, static_cast<std::uint64_t>(7000 + k));
      for (int s = 0; s < 8; ++s) tool.station(kBlocks);
      told.detected += tool.detected() || !tool.rig.monitor.verdict().noisy.empty() ? 1 : 0;
      told.named += tool.rig.ever_blamed.empty() ? 0 : 1;
    }
    EXPECT_EQ(told.detected, kDraws) << to_string(fault);
    EXPECT_EQ(told.named, 0) << to_string(fault);
  }
}

/// A chip that hangs while the tool shakes: the healthy one alone scatters, at every station.
// Negative: REQ-206
TEST(ChipUnits, OfTwoTriadsTheOneThatFeelsTheToolMoveIsNotTakenForNoisy) {
  for (int k = 0; k < kDraws; ++k) {
    ChipRig tool(chip_array(2), {}, static_cast<std::uint64_t>(100 + k));
    tool.fail(k % 2, ChipFault::hung, static_cast<std::uint64_t>(7000 + k));
    for (int s = 0; s < 8; ++s) {
      for (int block = 0; block < 3; ++block) tool.shaken(0.02 * kG0_mps2);
    }
    EXPECT_TRUE(tool.failed.contains(tool.rig.ever_blamed)) << k;
  }
}

/// A dead chip is at rest in any flight, and the other one alone determines a vector: what it turns by is no station,
/// and the doubt does not run out. On the ground it is told as if nothing had been.
// Negative: REQ-206
TEST(ChipUnits, OfTwoTriadsADeadOneInFlightDoesNotRunOutOfStations) {
  for (const ChipFault fault : {ChipFault::dead, ChipFault::stuck}) {
    for (int k = 0; k < 10; ++k) {
      ChipRig tool(chip_array(2), {}, static_cast<std::uint64_t>(100 + k));
      tool.fail(k % 2, fault, static_cast<std::uint64_t>(7000 + k));
      for (int block = 0; block < 60; ++block) {
        const Verdict& v = tool.shaken(0.3 * kG0_mps2);
        ASSERT_NE(v.state, HealthState::failed) << to_string(fault) << " " << k << ", block " << block;
        ASSERT_TRUE(v.excluded.empty());
        ASSERT_NE(v.validity, Validity::valid);
      }
      for (int s = 0; s < 5; ++s) tool.station(kBlocks);
      EXPECT_EQ(tool.rig.monitor.verdict().excluded, tool.failed) << to_string(fault) << " " << k;
    }
  }
}

// Verifies: REQ-206, REQ-070
TEST(ChipUnits, GradesCountUnits) {
  const auto grades = [](const SensorArray& array) {
    Rig rig(array);
    const Verdict& v = rig.prove();
    return std::array<int, 2>{v.confirmed_grade, v.provisional_grade};
  };
  EXPECT_EQ(grades(chip_array(2)), (std::array<int, 2>{1, 0}));
  EXPECT_EQ(grades(chip_array(2, {kAskew})), (std::array<int, 2>{1, 0})) << "without two units the third is no vector";
  EXPECT_EQ(grades(chip_array(2, {kAskew, kOther})), (std::array<int, 2>{1, 0}));
  EXPECT_EQ(grades(chip_array(1, {kAskew, kOther})), (std::array<int, 2>{0, 0}));
  EXPECT_EQ(grades(chip_array(1)), (std::array<int, 2>{0, 0}));
}

/// Numbers of chips that no two sensors share say nothing.
// Verifies: REQ-206
TEST(ChipUnits, ChipsOfOneSensorEachDecideAsSensorsDo) {
  std::array<SensorRow, kCapacity> rows{};
  const SensorArray plain = cone_array(6);
  for (int i = 0; i < 6; ++i) {
    rows[static_cast<std::size_t>(i)] = plain.row(i);
    rows[static_cast<std::size_t>(i)].chip = static_cast<std::uint8_t>(7 + i);
  }
  const Expected<SensorArray> made = SensorArray::make(rows.data(), 6);
  ASSERT_TRUE(made.has_value());
  Rig one(plain), other(*made);
  for (Rig* rig : {&one, &other}) {
    rig->prove();
    rig->distort = [](int i, double reading, int) { return i == 2 ? reading + 0.3 : i == 4 ? 0.0 : reading; };
  }
  for (int k = 0; k < 6; ++k) {
    const Verdict& a = one.stay(direction_at(20 + 20 * k, 50 * k), 3);
    const Verdict& b = other.stay(direction_at(20 + 20 * k, 50 * k), 3);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.excluded, b.excluded);
    EXPECT_EQ(a.provisionally_excluded, b.provisionally_excluded);
    EXPECT_EQ(a.suspects, b.suspects);
    EXPECT_EQ(a.minimum_faults, b.minimum_faults);
    EXPECT_EQ(a.gravity_mps2, b.gravity_mps2);
    EXPECT_EQ(a.protection_level_housing_rad, b.protection_level_housing_rad);
    EXPECT_EQ(a.statistic, b.statistic);
    EXPECT_EQ(a.config_hash, b.config_hash);
  }
  EXPECT_EQ(one.ever_blamed, SensorSet::of(2).with(4));
}

// Verifies: REQ-206
TEST(ChipUnits, WithAnAssumedNumberOneChipOfTwoIsNamedByItsLengthAtOneStation) {
  MonitorConfig config;
  config.assumed_faults = 1;
  for (const ChipFault fault : {ChipFault::dead, ChipFault::stuck}) {
    const Told told = of_two(fault, config);
    EXPECT_EQ(told.named, kDraws) << to_string(fault);
    EXPECT_EQ(told.wrong, 0) << to_string(fault);
  }
}

/// Every chip and every single sensor is one fault, whichever of its axes fail.
// Verifies: REQ-206, REQ-071
TEST(ChipUnits, NoHealthyUnitIsExcludedWhileNoMoreFailThanTheGrade) {
  const std::vector<SensorArray> arrays = {chip_array(2), chip_array(2, {kAskew}), chip_array(2, {kAskew, kOther}),
                                           chip_array(1, {kAskew, kOther, {0.6, -0.8, 0.0}, {0.0, 0.6, -0.8}})};
  int excluded = 0;
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    const SensorArray& array = arrays[a];
    const int chips = array.units().size() < 5 ? 2 : 1;
    ASSERT_GE(confirmed_grade(array, array.all()), 1);
    for (const ChipFault fault : kChipFaults) {
      for (int k = 0; k < 12; ++k) {
        ChipRig tool(array, {}, static_cast<std::uint64_t>(100 + k));
        tool.fail(k % chips, fault, static_cast<std::uint64_t>(900 + k));
        for (int s = 0; s < 6; ++s) {
          tool.station(4);
          if (s % 2 == 1) tool.shaken(0.02 * kG0_mps2);
        }
        EXPECT_TRUE(tool.failed.contains(tool.rig.ever_blamed))
            << "array " << a << ", " << to_string(fault) << " " << k;
        excluded += tool.rig.monitor.verdict().excluded.empty() ? 0 : 1;
      }
    }
  }
  EXPECT_GE(excluded, 150) << "so that the law says something";
}

// Verifies: REQ-206, REQ-099
TEST(ChipUnits, AChipIsReinstatedAsAWhole) {
  ChipRig tool(chip_array(2));
  tool.fail(1, ChipFault::one_axis, 5);
  for (int s = 0; s < 5; ++s) tool.station(4);
  ASSERT_EQ(tool.rig.monitor.verdict().excluded, chip_at(1));
  tool.rig.distort = [](int, double reading, int) { return reading; };
  for (int s = 0; s < 30 && !tool.rig.monitor.verdict().excluded.empty(); ++s) tool.station(2);
  const Verdict& v = tool.rig.monitor.verdict();
  EXPECT_EQ(v.in_service, tool.rig.setup.array.all());
  ASSERT_FALSE(tool.rig.records.empty());
  const TransitionRecord& last = tool.rig.records.back();
  EXPECT_EQ(last.event, HealthEvent::probation_passed);
  EXPECT_EQ(last.sensors, chip_at(1)) << "in one event";
}

/// A host returns what it names, and nothing else: the rest of the chip is on probation as before.
// Verifies: REQ-206
TEST(ChipUnits, AResetReturnsTheAxesNamedAndNotTheRestOfTheirChip) {
  MonitorConfig config;
  config.reset_key = 7;
  ChipRig tool(chip_array(2), config);
  tool.fail(1, ChipFault::one_axis, 5);
  for (int s = 0; s < 5; ++s) tool.station(4);
  ASSERT_EQ(tool.rig.monitor.verdict().excluded, chip_at(1));
  const auto silent_row = [&tool](SensorSet lost) {
    Sample s = tool.rig.sample(direction_at(40, 10), kG0_mps2);
    s.delivered = s.delivered - lost;
    tool.rig.step(s);
  };
  for (int k = 0; k < 4 * tool.rig.setup.config.window; ++k) silent_row(SensorSet::of(0));
  ASSERT_EQ(tool.rig.monitor.verdict().state, HealthState::failed) << "two axes are no vector";
  ASSERT_TRUE(tool.rig.monitor.reset(7, SensorSet::of(3)).has_value());
  silent_row(SensorSet::of(0));
  const Verdict& v = tool.rig.monitor.verdict();
  EXPECT_EQ(v.state, HealthState::suspect);
  EXPECT_EQ(v.in_service, SensorSet::of(1).with(2).with(3));
  EXPECT_EQ(v.excluded, SensorSet::of(4).with(5));
}

/// A channel that falls silent is known to be lost: the other axes of its chip stay, and the grade is that of what they
/// span.
// Verifies: REQ-206
TEST(ChipUnits, AChipWithALostChannelServesWithTheOthers) {
  ChipRig tool(chip_array(2, {{0.0, 0.6, 0.8}}));
  ASSERT_EQ(tool.rig.monitor.verdict().confirmed_grade, 1);
  for (int k = 0; k < 4 * tool.rig.setup.config.window; ++k) {
    Sample s = tool.rig.sample(direction_at(40, 10), kG0_mps2);
    s.delivered = s.delivered.without(0);
    tool.rig.step(s);
  }
  const Verdict& v = tool.rig.monitor.verdict();
  EXPECT_EQ(v.absent, SensorSet::of(0));
  EXPECT_EQ(v.in_service, tool.rig.setup.array.all().without(0));
  EXPECT_EQ(v.confirmed_grade, 0) << "what is left of the chip lies in one plane with the single sensor";
}

// Verifies: REQ-206, REQ-200
TEST(ChipUnits, AFindingInMotionOfOneAxisExcludesTheChipProvisionally) {
  ChipRig tool(chip_array(2));
  for (int k = 0; k < 4; ++k) tool.shaken(0.3 * kG0_mps2);
  tool.rig.monitor.set_motion({true, SensorSet::of(4)});
  for (int k = 0; k < 2; ++k) tool.shaken(0.3 * kG0_mps2);
  EXPECT_EQ(tool.rig.monitor.verdict().provisionally_excluded, chip_at(1));
}

/// Chips are part of what a monitor was configured with: what was learned of others does not fit.
// Verifies: REQ-206
TEST(ChipUnits, ASnapshotOfTheSameAxesWithoutChipsIsForeign) {
  ChipRig with(chip_array(2)), without(chip_array(2, {}, false));
  EXPECT_NE(with.rig.monitor.verdict().config_hash, without.rig.monitor.verdict().config_hash);
  std::vector<std::uint8_t> bytes(with.rig.monitor.snapshot_size());
  ASSERT_TRUE(with.rig.monitor.snapshot(bytes.data(), bytes.size()).has_value());
  HealthMonitor fresh;
  const Expected<void> taken = fresh.restore(without.rig.setup, bytes.data(), bytes.size());
  ASSERT_FALSE(taken.has_value());
  EXPECT_EQ(taken.error().code, Errc::snapshot_foreign);
}

}  // namespace
}  // namespace chip_units_test
