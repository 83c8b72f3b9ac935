// Three chips and more at rest (docs/theory.md, section 5.7), at the capacity that holds them: whichever way a chip
// fails it is named, and no other one.
#include <gtest/gtest.h>

#include "plumb/findings/geometry_study.hpp"
#include "plumb/render/geometry_report.hpp"
#include "support/chip_tool.hpp"

namespace chips_at_rest_test {
namespace {

using namespace plumb;
using namespace plumb_test;

constexpr int kBlocks = 8;

/// Blamed: excluded or provisionally excluded at the end of one of the stations.
struct Told {
  int cases = 0, named = 0, wrong = 0, confirmed = 0;
};

Told told_of(int chips, ChipFault fault, int draws, int stations) {
  Told out;
  for (int k = 0; k < draws; ++k) {
    ChipRig tool(chip_array(chips), {}, static_cast<std::uint64_t>(100 + k));
    EXPECT_EQ(tool.begun(), HealthState::nominal) << k;
    tool.fail(k % chips, fault, static_cast<std::uint64_t>(7000 + k));
    bool named = false;
    for (int s = 0; s < stations; ++s) {
      const Verdict& v = tool.station(kBlocks);
      named = named || (v.excluded | v.provisionally_excluded) == tool.failed;
    }
    ++out.cases;
    out.named += named ? 1 : 0;
    out.wrong += tool.failed.contains(tool.rig.ever_blamed) ? 0 : 1;
    out.confirmed += tool.rig.monitor.verdict().excluded == tool.failed ? 1 : 0;
  }
  return out;
}

// Verifies: REQ-206
TEST(ChipsAtRest, OfThreeTriadsWhicheverWayOneFailsItIsNamedWithinFourStationsAndNoOther) {
  const SensorArray array = chip_array(3);
  ASSERT_EQ(array.units().size(), 3);
  EXPECT_EQ(coplanarity(array, array.all()), 0);
  EXPECT_EQ(confirmed_grade(array, array.all()), 2);
  EXPECT_EQ(provisional_grade(array, array.all()), 1);
  for (const ChipFault fault : kChipFaults) {
    const Told told = told_of(3, fault, 40, 4);
    EXPECT_EQ(told.named, told.cases) << to_string(fault);
    EXPECT_EQ(told.wrong, 0) << to_string(fault);
    // What keeps the length is named by the other two, and stays provisional: two such faults would look the same.
    const bool by_length = fault == ChipFault::dead || fault == ChipFault::stuck || fault == ChipFault::biased ||
                           fault == ChipFault::one_axis;
    EXPECT_EQ(told.confirmed, by_length ? told.cases : 0) << to_string(fault);
  }
}

/// The grade by sensors counts an axis as a fault, and three at once are more than it bears.
// Negative: REQ-206
TEST(ChipsAtRest, WithoutChipsStatedThreeFaultyAxesAreBeyondTheGrade) {
  const SensorArray array = chip_array(3, {}, false);
  EXPECT_EQ(coplanarity(array, array.all()), 6);
  EXPECT_EQ(confirmed_grade(array, array.all()), 2);
  int named = 0;
  for (int k = 0; k < 20; ++k) {
    ChipRig tool(array, {}, static_cast<std::uint64_t>(100 + k));
    tool.fail(k % 3, ChipFault::turned, static_cast<std::uint64_t>(7000 + k));
    for (int s = 0; s < 4; ++s) tool.station(kBlocks);
    named += tool.rig.ever_blamed == tool.failed ? 1 : 0;
  }
  EXPECT_LT(named, 20);
}

/// As many as the confirmed grade, of any kinds: nobody healthy is excluded for good. As many as the provisional one:
/// nobody healthy is excluded at all.
// Verifies: REQ-206, REQ-071
TEST(ChipsAtRest, NoHealthyChipIsExcludedWhileNoMoreFailThanTheGrade) {
  int excluded = 0, cases = 0;
  for (const int chips : {3, 4, 5}) {
    const SensorArray array = chip_array(chips);
    const int confirmed = confirmed_grade(array, array.all()), provisional = provisional_grade(array, array.all());
    for (std::uint64_t k = 0; k < 60; ++k) {
      Noise draw(k + 31);
      ChipRig tool(array, {}, 100 + k);
      const int faulty = 1 + static_cast<int>(draw.uniform() * confirmed);
      const bool alike = draw.uniform() < 0.3;  // colluding: all turn, or are biased, by the same
      const ChipFault common = kChipFaults[static_cast<std::size_t>(draw.uniform() * kChipFaults.size())];
      for (int f = 0; f < faulty; ++f) {
        const ChipFault own = kChipFaults[static_cast<std::size_t>(draw.uniform() * kChipFaults.size())];
        tool.fail(f, alike ? common : own, alike ? k : 10 * k + static_cast<std::uint64_t>(f));
      }
      for (int s = 0; s < 6; ++s) {
        const Verdict& v = tool.station(4);
        ASSERT_TRUE(tool.failed.contains(v.excluded)) << chips << " chips, case " << k;
        if (faulty <= provisional) {
          ASSERT_TRUE(tool.failed.contains(v.provisionally_excluded)) << chips << " chips, case " << k;
        }
        if (s % 2 == 1) tool.shaken(0.02 * kG0_mps2);
      }
      excluded += tool.rig.monitor.verdict().excluded.empty() ? 0 : 1;
      ++cases;
    }
  }
  EXPECT_GE(excluded, cases / 4) << "so that the law says something";
}

/// Two of three feel the tool move and the third is dead: that is motion, and not two noisy chips.
// Verifies: REQ-206
TEST(ChipsAtRest, OfThreeADeadOneIsNoWitnessOfRest) {
  ChipRig tool(chip_array(3));
  tool.fail(1, ChipFault::dead, 3);
  for (int k = 0; k < 10; ++k) {
    const Verdict& v = tool.shaken(0.05 * kG0_mps2);
    EXPECT_NE(v.qualifiers & Qualifier::moving, 0) << k;
  }
  EXPECT_TRUE(tool.rig.ever_blamed.empty());
}

/// Two chips have lost an axis each, so that none of the three is checked in flight.
// Negative: REQ-206
TEST(ChipsAtRest, OfThreeADeadOneBesideTwoWithoutAnAxisDoesNotRunOutOfStations) {
  ChipRig tool(chip_array(3));
  const SensorSet lost = SensorSet::of(0).with(7);
  Noise where(5);
  const auto block = [&](double rms_mps2) {
    const Vec3 at = scaled(random_direction(where), kG0_mps2);
    for (int row = 0; row < tool.rig.setup.config.window; ++row) {
      const Vec3 a = plus(at, {rms_mps2 * where.normal(), rms_mps2 * where.normal(), rms_mps2 * where.normal()});
      Sample s = tool.rig.sample(scaled(a, 1.0 / norm(a)), norm(a));
      s.delivered = s.delivered - lost;
      tool.rig.step(s);
    }
  };
  for (int k = 0; k < 4; ++k) block(0.3 * kG0_mps2);
  tool.fail(1, ChipFault::dead, 3);
  for (int k = 0; k < 60; ++k) {
    block(0.3 * kG0_mps2);
    ASSERT_NE(tool.rig.monitor.verdict().state, HealthState::failed) << "block " << k;
    ASSERT_NE(tool.rig.monitor.verdict().validity, Validity::valid);
  }
}

/// k = 2m: two of four that turned alike agree as the healthy two do.
// Negative: REQ-206
TEST(ChipsAtRest, TwoOfFourTurnedAlikeAreDetectedAndNobodyIsExcludedForGood) {
  for (std::uint64_t k = 0; k < 20; ++k) {
    ChipRig tool(chip_array(4), {}, 100 + k);
    for (const int chip : {0, 1}) tool.fail(chip, ChipFault::turned, 7000 + k);
    for (int s = 0; s < 8; ++s) tool.station(kBlocks);
    EXPECT_TRUE(tool.detected()) << k;
    EXPECT_TRUE(tool.rig.monitor.verdict().excluded.empty()) << k;
  }
}

/// The protection level is over fault sets of units: while two of three chips disagree it covers the vector of either.
// Verifies: REQ-206, REQ-122
TEST(ChipsAtRest, WhileAChipIsInDoubtTheLevelCoversTheTruth) {
  int checked = 0;
  for (const int chips : {2, 3}) {
    for (std::uint64_t k = 0; k < 40; ++k) {
      for (const ChipFault fault : {ChipFault::turned, ChipFault::biased, ChipFault::one_axis}) {
        ChipRig tool(chip_array(chips), {}, 100 + k);
        tool.fail(static_cast<int>(k) % chips, fault, 7000 + k);
        Noise where(k);
        for (int s = 0; s < 4; ++s) {
          const Vec3 direction = random_direction(where);
          const Verdict& v = tool.station(2, direction);
          if (!v.protection_available) continue;
          EXPECT_LE(angle_between_rad(v.gravity_mps2, direction), v.protection_level_housing_rad)
              << chips << " chips, " << to_string(fault) << " " << k;
          ++checked;
        }
      }
    }
  }
  EXPECT_GE(checked, 500);
}

/// Parallel axes of chips are no flaw to be mended by turning one.
// Verifies: REQ-206
TEST(ChipsAtRest, GeometryCountsChipsAndDoesNotAdviseToTurnOne) {
  const auto warned = [](const SensorArray& array) {
    findings::GeometrySubject subject;
    subject.array = array;
    subject.gravity = {kG0_mps2, 1e-4 * kG0_mps2, GravityModel::value};
    const findings::GeometryStudy study = findings::study_geometry(subject);
    EXPECT_EQ(study.merit.units, array.units().size());
    const std::string text = render::geometry_text(subject, study);
    EXPECT_EQ(text.find("one axis at fault") != std::string::npos, array.units().grouped()) << text;
    return !study.warnings.empty();
  };
  EXPECT_FALSE(warned(chip_array(3)));
  EXPECT_FALSE(warned(chip_array(2)));
  EXPECT_TRUE(warned(chip_array(3, {}, false)));
}

}  // namespace
}  // namespace chips_at_rest_test
