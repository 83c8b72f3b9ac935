// Requirements on who is taken out, when, and who comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <limits>

#include "support/simulated_tool.hpp"

namespace requirements_isolation_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::Rig;

// Verifies: REQ-071
TEST(RequirementConfirmed, TheAnswerMustHoldAtFourStations) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 1.5 : r; };
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(rig.stay(direction_at(45 + 10 * k, 200 + 60 * k), 3).excluded.empty()) << "station " << k + 1;
    EXPECT_EQ(rig.monitor.verdict().consistent_hypotheses, 1) << "although the answer is unique";
  }
  EXPECT_EQ(rig.stay(direction_at(75, 20)).excluded, SensorSet::of(2));
  EXPECT_EQ(rig.monitor.verdict().grade, Grade::confirmed);
}

// Negative: REQ-071
TEST(RequirementConfirmed, ThreeSurvivorsNeedTwoStationsEvenWhereOneIsConfigured) {
  MonitorConfig config;
  config.isolation_stations = 1;
  int excluded = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rig rig(plumb_test::tetrahedron(), config, seed);
    rig.prove();
    rig.distort = [](int i, double r, int) { return i == 2 ? r + 1.5 : r; };
    EXPECT_TRUE(rig.stay(direction_at(45, 200), 20).excluded.empty()) << "one station may be a mirror";
    Noise noise(seed);
    for (int k = 0; k < 3; ++k) rig.stay(plumb_test::random_direction(noise));
    excluded += rig.monitor.verdict().excluded == SensorSet::of(2) ? 1 : 0;
  }
  EXPECT_GE(excluded, 18) << "and a second one is enough";
}

// Negative: REQ-072
TEST(RequirementProvisionalGrade, FourSensorsHaveNoneAndProvisionallyExcludeNone) {
  for (const double fault : {0.01, 0.1, 1.0, 20.0}) {
    Rig rig(plumb_test::tetrahedron());
    rig.prove();
    rig.distort = [fault](int i, double r, int) { return i == 1 ? r + fault : r; };
    Noise noise(5);
    for (int k = 0; k < 10; ++k) {
      const Verdict& v = rig.stay(plumb_test::random_direction(noise));
      EXPECT_EQ(v.provisional_grade, 0);
      EXPECT_TRUE(v.provisionally_excluded.empty());
      EXPECT_FALSE(v.qualifiers & Qualifier::provisional);
    }
    EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(1)) << "by the confirmed grade: " << fault;
  }
}

// Negative: REQ-073
TEST(RequirementAssumedFaults, AnAlarmWithNoneLeftHasNoConsistentHypothesisAndExcludesNoSensor) {
  MonitorConfig config;
  config.assumed_faults = 0;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 1 ? r + 1.0 : r; };
  const Verdict& v = rig.stay(direction_at(55, 77));
  EXPECT_EQ(v.state, HealthState::suspect);
  EXPECT_EQ(rig.records.back().event, HealthEvent::no_consistent_hypothesis);
  EXPECT_TRUE(rig.ever_blamed.empty());
  rig.stay(direction_at(75, 177));
  EXPECT_TRUE(rig.ever_blamed.empty()) << "from here on the confirmed grade holds, over four stations";
}

// Verifies: REQ-103
TEST(RequirementIsolation, OneFaultIsExcludedWithinEightStations) {
  int cases = 0, excluded = 0, wrong = 0;
  for (int n = 4; n <= std::min(8, kCapacity); ++n) {
    for (int kind = 0; kind < 5; ++kind) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), {}, seed);
        rig.prove();
        Noise noise(100 * seed + static_cast<std::uint64_t>(kind));
        const int faulty = static_cast<int>(noise.uniform() * n);
        rig.distort = [&](int i, double r, int) {
          const double said[] = {r + 0.1 * kG0_mps2, r - 1.0 * kG0_mps2, 0.0, kG0_mps2, -kG0_mps2};
          return i == faulty ? said[kind] : r;
        };
        for (int k = 0; k < 8; ++k) rig.stay(plumb_test::random_direction(noise));
        ++cases;
        excluded += rig.monitor.verdict().excluded == SensorSet::of(faulty) ? 1 : 0;
        wrong += SensorSet::of(faulty).contains(rig.ever_blamed) ? 0 : 1;
      }
    }
  }
  std::cout << "excluded within 8 stations: " << excluded << " of " << cases << ", healthy blamed: " << wrong << "\n";
  EXPECT_GE(100 * excluded, 99 * cases);
  EXPECT_EQ(wrong, 0);
}

// Negative: REQ-099
TEST(RequirementProbation, ASensorExcludedAfterAReturnStaysExcluded) {
  for (const int n : {4, 6}) {  // by the confirmed grade, and by the provisional grade
    Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n));
    rig.prove();
    bool broken = true;
    rig.distort = [&broken](int i, double r, int) { return i == 3 && broken ? r + 0.4 : r; };
    Noise noise(12);
    for (int k = 0; k < 8; ++k) rig.stay(plumb_test::random_direction(noise));
    ASSERT_EQ(rig.monitor.verdict().excluded, SensorSet::of(3)) << n;
    broken = false;
    for (int k = 0; k < 20; ++k) rig.stay(plumb_test::random_direction(noise));
    ASSERT_EQ(rig.monitor.verdict().state, HealthState::nominal) << "the first return, of " << n;
    broken = true;
    for (int k = 0; k < 10; ++k) rig.stay(plumb_test::random_direction(noise));
    broken = false;
    for (int k = 0; k < 60; ++k) {
      EXPECT_FALSE(rig.stay(plumb_test::random_direction(noise)).in_service.has(3)) << k << " of " << n;
    }
  }
}

// Verifies: REQ-099
TEST(RequirementProbation, AChannelThatComesBackServesOnlyAfterItsStations) {
  bool silent = false;
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  rig.distort = [&silent](int i, double r, int) {
    return i == 4 && silent ? std::numeric_limits<double>::quiet_NaN() : r;
  };
  silent = true;
  ASSERT_EQ(rig.stay(direction_at(45, 20)).absent, SensorSet::of(4));
  silent = false;
  Noise noise(6);
  rig.stay(plumb_test::random_direction(noise));
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(4));
  for (int k = 1; k < rig.setup.config.probation_stations - 1; ++k) {
    EXPECT_FALSE(rig.stay(plumb_test::random_direction(noise)).in_service.has(4)) << k;
  }
  for (int k = 0; k < 20; ++k) rig.stay(plumb_test::random_direction(noise));
  EXPECT_EQ(rig.monitor.verdict().in_service, SensorSet::first(6));
  EXPECT_EQ(rig.records.back().event, HealthEvent::probation_passed);
}

/// A tool of four after one block with a fault that is gone again: the alarm is on record.
Rig four_after_an_alarm() {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 0 ? r + 0.3 : r; };
  EXPECT_EQ(rig.stay(direction_at(100, 340)).stations_on_record, 1);
  rig.distort = [](int, double r, int) { return r; };
  return rig;
}

// Verifies: REQ-104
TEST(RequirementEpisode, EndsAfterPassedBlocksAtThreeAttitudes) {
  Rig rig = four_after_an_alarm();
  for (int k = 0; k < 6; ++k) rig.stay(direction_at(30 + 15 * k, 60 * k));
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal);
  EXPECT_EQ(rig.monitor.verdict().stations_on_record, 0);
  EXPECT_EQ(rig.monitor.verdict().consistent_hypotheses, 4);
}

// Negative: REQ-104
TEST(RequirementEpisode, DoesNotEndByPassedBlocksAtOneAttitude) {
  Rig rig = four_after_an_alarm();
  const int live = rig.monitor.verdict().consistent_hypotheses;
  ASSERT_LT(live, 4);
  rig.stay(direction_at(30, 60), 40);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal) << "the state is by size again";
  EXPECT_EQ(rig.monitor.verdict().stations_on_record, 1) << "and the record stays";
  EXPECT_LE(rig.monitor.verdict().consistent_hypotheses, live);
}

// Negative: REQ-077
TEST(RequirementNoConsistentHypothesis, TwoRandomFaultsAmongFourExcludeNoSensor) {
  int contradictions = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rig rig(plumb_test::tetrahedron(), {}, seed);
    rig.prove();
    Noise noise(seed), lies(seed + 50);
    double said[2] = {};
    rig.distort = [&](int i, double r, int) { return i < 2 ? said[i] : r; };
    for (int k = 0; k < 5; ++k) {
      for (double& s : said) s = 20.0 * (lies.uniform() - 0.5);
      rig.stay(plumb_test::random_direction(noise));
      EXPECT_TRUE(rig.ever_blamed.empty());
      EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect);
    }
    contradictions += rig.monitor.verdict().consistent_hypotheses == 0 ? 1 : 0;
  }
  EXPECT_GE(contradictions, 8) << "else the test shows nothing";
}

}  // namespace
}  // namespace requirements_isolation_test
