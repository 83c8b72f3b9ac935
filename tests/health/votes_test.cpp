// Where a vote says the tool points, block by block: a fault must not pass for a movement of the tool.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "health/recalibration_support.hpp"

namespace votes_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::Rig;

/// The estimate with a faulty sensor in it is another direction, of the survivors it is not: between two votes of a
/// station (blocks 1, 2, 4, 8, 16) nothing seems to have turned.
// Negative: REQ-105
TEST(Votes, BetweenThemTheVectorIsThatOfTheSurvivors) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 5.0 : r; };
  for (int station = 1; station <= 3; ++station) {
    for (int block = 1; block <= 20; ++block) {
      const Verdict& v = rig.stay(direction_at(33 + 12 * station, 140 + 60 * station));
      ASSERT_EQ(v.stations_on_record, station) << "block " << block;
      ASSERT_EQ(v.state, HealthState::suspect) << "block " << block;
    }
  }
}

/// Who scatters by itself for certain speaks against the others' faults where so many may be asserted that parity would
/// tell: the answer does not wait for a calm block. Beyond that grade its scatter may be a push that liars hide.
// Verifies: REQ-073
TEST(Votes, OneThatScattersForCertainCorroboratesWithinTheProvisionalGrade) {
  if (kCapacity < 6) GTEST_SKIP() << "six sensors";
  MonitorConfig config;
  for (const int n : {5, 6}) {
    for (const int asserted : {1, 2, 3}) {
      for (const int lies : {0, 1}) {
        config.assumed_faults = asserted;
        Rig rig(plumb_test::cone_array(n), config);
        rig.prove();
        Noise noise(4);
        rig.distort = [&](int i, double r, int) { return i == lies ? r + 3.0 + 0.3 * noise.normal() : r; };
        const Verdict& v = rig.stay(direction_at(55, 77));
        const bool within = asserted <= provisional_grade(rig.setup.array, rig.setup.array.all());
        EXPECT_EQ(v.excluded, within ? SensorSet::of(lies) : SensorSet{}) << asserted << " of " << n;
      }
    }
  }
}

/// Two excluded where one was asserted: the claim is used up, and the next alarm contradicts it.
// Negative: REQ-073
TEST(Votes, MoreExclusionsThanAssumedFaultsLeaveNone) {
  if (kCapacity < 6) GTEST_SKIP() << "six sensors";
  MonitorConfig config;
  config.assumed_faults = 1;
  Rig rig(plumb_test::cone_array(6), config);
  rig.prove();
  bool third = false;
  rig.distort = [&third](int i, double r, int) {
    const double fault[] = {0.0, 2.0, 0.0, 0.0, -1.4, third ? 0.5 : 0.0};
    return r + fault[i];
  };
  Noise noise(8);
  for (int k = 0; k < 10 && rig.monitor.verdict().excluded.empty(); ++k) rig.stay(plumb_test::random_direction(noise));
  ASSERT_EQ(rig.monitor.verdict().excluded, SensorSet::of(1).with(4));
  third = true;
  for (int k = 0; k < 3 && rig.records.back().event != HealthEvent::no_consistent_hypothesis; ++k)
    rig.stay(plumb_test::random_direction(noise));
  EXPECT_EQ(rig.records.back().event, HealthEvent::no_consistent_hypothesis);
}

/// Where parity has a grade, who scatters is provisionally excluded and comes back: no number of stations excludes it
/// by its scatter.
// Negative: REQ-143
TEST(Votes, WhereParityHasAGradeScatterAloneExcludesNoSensor) {
  MonitorConfig config;
  config.isolation_stations = 1;
  for (int n = 5; n <= std::min(7, kCapacity); ++n) {
    Rig rig(plumb_test::cone_array(n), config);
    rig.prove();
    Noise noise(9), directions(4);
    rig.distort = [&noise](int i, double r, int) { return i == 1 ? r + 0.02 * kG0_mps2 * noise.normal() : r; };
    for (int k = 0; k < 20; ++k) rig.stay(plumb_test::random_direction(directions));
    EXPECT_EQ(rig.ever_blamed, SensorSet::of(1));
    EXPECT_EQ(rig.monitor.verdict().provisionally_excluded, SensorSet::of(1)) << n;
    EXPECT_TRUE(rig.monitor.verdict().excluded.empty()) << n;
  }
}

/// Two come back: the second earns its return from the start once the first has it.
// Negative: REQ-099
TEST(Votes, TheSecondOfTwoOnProbationStartsItsProbationAgain) {
  if (kCapacity < 7) GTEST_SKIP() << "seven sensors";
  Rig rig(plumb_test::cone_array(7));
  rig.prove();
  bool broken = true;
  rig.distort = [&broken](int i, double r, int) { return broken && (i == 1 || i == 4) ? r + 0.5 + 0.3 * i : r; };
  Noise noise(6);
  rig.stay(plumb_test::random_direction(noise));
  broken = false;
  const SensorSet both = SensorSet::of(1).with(4), all = SensorSet::first(7);
  ASSERT_EQ(all - rig.monitor.verdict().in_service, both);
  int first = 0, second = 0;
  for (int k = 1; k <= 60 && second == 0; ++k) {
    const SensorSet out = all - rig.stay(plumb_test::random_direction(noise)).in_service;
    if (first == 0 && out != both) first = k;
    if (out.empty()) second = k;
  }
  EXPECT_GT(first, 0);
  EXPECT_GE(second - first, rig.setup.config.probation_stations);
}

/// What agreed before a channel was lost answered another question.
// Negative: REQ-071
TEST(Votes, ALostChannelStartsTheAnswerAnew) {
  if (kCapacity < 5) GTEST_SKIP() << "five sensors";
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rig rig(plumb_test::cone_array(5), {}, seed);
    rig.prove();
    bool lost = false;
    rig.distort = [&lost](int i, double r, int) { return i == 4 && lost ? std::nan("") : i == 2 ? r + 2.0 : r; };
    Noise noise(seed);
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(rig.stay(plumb_test::random_direction(noise)).excluded.empty());
    lost = true;
    for (int k = 0; k < 3; ++k) EXPECT_FALSE(rig.stay(plumb_test::random_direction(noise)).excluded.has(2)) << k;
    EXPECT_TRUE(rig.monitor.verdict().absent.has(4));
  }
}

/// A fault while a fit is made: the record names the faulty one, not those whose fit is dropped.
// Verifies: REQ-101
TEST(Votes, TheRecordOfADroppedFitNamesTheSuspectedSensor) {
  if (kCapacity < 6) GTEST_SKIP() << "six sensors";
  plumb_test::Tool tool(6);
  tool.begin();
  tool.fault = [](int i, double r, int) { return i == 3 ? r + 1.0 : r; };
  tool.rig.stay(direction_at(40, 120));
  const TransitionRecord& record = tool.rig.records.back();
  EXPECT_EQ(record.event, HealthEvent::provisional_exclusion);
  EXPECT_EQ(record.sensors, SensorSet::of(3));
  EXPECT_EQ(tool.rig.monitor.verdict().cause, record.cause);
}

/// The key forgets the episode: what was told of the tool before it was repaired.
// Verifies: REQ-095
TEST(Votes, TheKeyForgetsTheEpisode) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 0 ? r + 0.7 : i == 1 ? r - 1.9 : r; };
  Noise noise(3);
  for (int k = 0; k < 40 && rig.monitor.verdict().state != HealthState::failed; ++k)
    rig.stay(plumb_test::random_direction(noise));
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::failed);
  ASSERT_GT(rig.monitor.verdict().stations_on_record, 0);
  rig.distort = [](int, double r, int) { return r; };
  ASSERT_TRUE(rig.monitor.reset(rig.setup.config.reset_key, SensorSet::first(4)).has_value());
  const Verdict& v = rig.step(rig.sample(direction_at(50, 50), kG0_mps2));
  EXPECT_EQ(v.state, HealthState::suspect);
  EXPECT_EQ(v.stations_on_record, 0);
  EXPECT_TRUE(v.suspects.empty());
  EXPECT_EQ(rig.stay(direction_at(50, 50)).consistent_hypotheses, 4);
}

/// Losing a channel while suspect changes who is in service and not the state: what the host has asked for stands.
// Verifies: REQ-101
TEST(Votes, ARequestOutlivesALossThatLeavesTheStateAlone) {
  if (kCapacity < 6) GTEST_SKIP() << "six sensors";
  plumb_test::Tool tool(6, {}, 3);
  tool.rig.prove();
  tool.bias.fill(2.5e-2);
  for (int k = 0; k < 10 && tool.state() == HealthState::nominal; ++k) tool.visit(1);
  ASSERT_EQ(tool.state(), HealthState::suspect);
  ASSERT_EQ(tool.rig.records.back().cause, Cause::norm_mismatch);
  tool.fault = [](int i, double r, int) { return i == 5 ? std::nan("") : r; };
  for (int k = 0; k < 200; ++k) {
    HealthMonitor before = tool.rig.monitor;
    const Sample sample = tool.rig.sample(direction_at(70, 70), kG0_mps2);
    if (tool.rig.step(sample).absent.empty()) continue;
    ASSERT_TRUE(before.request_recalibration().has_value());
    const Verdict& lost = before.step(sample);
    EXPECT_EQ(lost.absent, SensorSet::of(5));
    EXPECT_EQ(lost.cause, lost.transition.cause);
    EXPECT_EQ(lost.state, HealthState::suspect);
    int samples = 0;
    while (samples < 64 && before.verdict().state == HealthState::suspect) {
      before.step(tool.rig.sample(direction_at(70, 70), kG0_mps2));
      ++samples;
    }
    EXPECT_EQ(before.verdict().state, HealthState::recalibrating) << samples;
    return;
  }
  FAIL() << "the channel was not missed";
}

/// A fault that comes and goes: a station is judged again up to its 16th block, and then no more.
// Verifies: REQ-076
TEST(Votes, AreTakenUpToTheSixteenthBlockOfAStation) {
  MonitorConfig config;
  config.isolation_stations = 2;
  config.passed_blocks = config.forget_blocks = 20;
  for (const int begins : {12, 17}) {
    Rig rig(plumb_test::tetrahedron(), config);
    for (int k = 0; k < 6; ++k) rig.prove();
    bool faulty = true;
    rig.distort = [&faulty](int i, double r, int) { return faulty && i == 3 ? r + 0.1 : r; };
    rig.stay(direction_at(120, 90));
    for (int block = 1; block <= 34; ++block) {
      faulty = block >= begins;
      const SensorSet expected = begins <= 16 && block >= 16 ? SensorSet::of(3) : SensorSet{};
      ASSERT_EQ(rig.stay(direction_at(45, 200)).excluded, expected) << "block " << block << ", faulty as of " << begins;
    }
  }
}

/// Four survivors check one another: one station is enough where the host says so. Three do not: one may be a mirror.
// Verifies: REQ-071
TEST(Votes, OneStationIsEnoughWhereTheSurvivorsCheckOneAnother) {
  MonitorConfig config;
  config.isolation_stations = 1;
  for (int n = 4; n <= std::min(6, kCapacity); ++n) {
    Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), config);
    rig.prove();
    rig.distort = [](int i, double r, int) { return i == 2 ? r + 2.0 : r; };
    EXPECT_EQ(rig.stay(direction_at(33, 140)).excluded, n == 4 ? SensorSet{} : SensorSet::of(2)) << n;
    EXPECT_EQ(rig.stay(direction_at(75, 260)).excluded, SensorSet::of(2)) << n;
  }
}

/// What was seen once stays the answer; a station at which nothing is seen does not confirm it. One sensor out of
/// service for good, which goes on lying, makes nothing visible.
// Negative: REQ-071
TEST(Votes, AStationWhereNothingIsSeenConfirmsNothing) {
  MonitorConfig config;
  config.passed_blocks = config.forget_blocks = 20;
  for (const bool another : {false, true}) {
    const int n = another ? 6 : 4;
    if (n > kCapacity) continue;
    Rig rig(another ? plumb_test::cone_array(6) : plumb_test::tetrahedron(), config);
    for (int k = 0; k < 6; ++k) rig.prove();
    bool lying = false, faulty = false;
    rig.distort = [&](int i, double r, int) { return lying && i == 5 ? r + 3.0 : faulty && i == 1 ? r + 1.0 : r; };
    Noise noise(11);
    lying = another;
    for (int k = 0; another && k < 10; ++k) rig.stay(plumb_test::random_direction(noise));
    const SensorSet out = another ? SensorSet::of(5) : SensorSet{};
    ASSERT_EQ(rig.monitor.verdict().excluded, out);
    faulty = true;
    for (int k = 0; k < 2; ++k) rig.stay(plumb_test::random_direction(noise));
    faulty = false;
    ASSERT_EQ(rig.monitor.verdict().excluded, out);
    for (int k = 0; k < 8; ++k) ASSERT_EQ(rig.stay(plumb_test::random_direction(noise)).excluded, out) << k;
    faulty = true;
    for (int k = 0; k < 8; ++k) rig.stay(plumb_test::random_direction(noise));
    EXPECT_TRUE(rig.monitor.verdict().excluded.has(1));
  }
}

/// Parity alone sees what leaves the length of the estimate as it is: such a station confirms the answer like any
/// other.
// Verifies: REQ-071
TEST(Votes, AFaultThatParityAloneSeesIsConfirmedByEveryStation) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  const LeastSquares ls = least_squares(rig.setup.array, rig.setup.array.all());
  const Vec3 moved = ls.column[1];
  Vec3 across = cross(moved, direction_at(50, 70));
  across = scaled(across, 1.0 / norm(across));
  const Vec3 other = scaled(cross(moved, across), 1.0 / norm(moved));
  rig.distort = [](int i, double r, int) { return i == 1 ? r + 0.05 : r; };
  for (int station = 0; station < rig.setup.config.isolation_stations; ++station) {
    EXPECT_TRUE(rig.monitor.verdict().excluded.empty()) << station;
    const double turn = 0.4 + 0.9 * station;
    rig.stay(plus(scaled(across, std::cos(turn)), scaled(other, std::sin(turn))));
  }
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(1));
}

/// Who scatters is the answer only where the others agree with gravity: else it is not the only one.
// Negative: REQ-143
TEST(Votes, AScatteringSensorIsNotIsolatedWhereTheOthersAreOff) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  Noise noise(9), directions(4);
  rig.distort = [&noise](int i, double r, int) {
    return i == 1 ? r + 0.02 * kG0_mps2 * noise.normal() : i == 2 ? r + 1.5 : r;
  };
  for (int k = 0; k < 10; ++k) {
    rig.stay(plumb_test::random_direction(directions));
    EXPECT_TRUE(rig.ever_blamed.empty()) << k;
  }
  EXPECT_EQ(rig.monitor.verdict().noisy, SensorSet::of(1)) << "it scatters for certain";
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::failed) << "seen, and nobody named";
}

/// An episode that clean stations end is forgotten with everything that was decided in it.
// Negative: REQ-098
TEST(Votes, AForgottenEpisodeLeavesNothingBehind) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 0 ? r + 0.3 : r; };
  rig.stay(direction_at(33, 140));
  ASSERT_EQ(rig.monitor.verdict().stations_on_record, 1);
  rig.distort = [](int, double r, int) { return r; };
  Noise noise(21);
  for (int k = 0; k < 12 && rig.monitor.verdict().stations_on_record > 0; ++k)
    rig.stay(plumb_test::random_direction(noise));
  const Verdict& v = rig.monitor.verdict();
  EXPECT_EQ(v.stations_on_record, 0);
  EXPECT_EQ(v.qualifiers & Qualifier::timed_out, 0);
  EXPECT_EQ(v.state, HealthState::nominal);
}

/// One long station over which the tool creeps: what was answered in an episode is no answer in the next, though no
/// vote comes in between.
// Negative: REQ-071
TEST(Votes, AForgottenCaseWithoutAConsistentHypothesisIsNotReportedAgain) {
  MonitorConfig config;
  config.station_angle_rad = 1.5;
  config.passed_blocks = 2;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  const auto at = [](int k) { return direction_at(60 + 0.5 * k, 200); };
  bool two = true, one = false;
  rig.distort = [&](int i, double r, int) {
    return two && i == 0 ? r + 0.7 : two && i == 1 ? r - 1.9 : one && i == 3 ? r + 0.4 : r;
  };
  int k = 0;
  while (k < 16) rig.stay(at(k++));
  ASSERT_EQ(rig.records.back().event, HealthEvent::no_consistent_hypothesis);
  two = false;
  while (k < 60) rig.stay(at(k++));
  ASSERT_EQ(rig.monitor.verdict().stations_on_record, 0);
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::nominal);
  one = true;
  rig.stay(at(k));
  EXPECT_EQ(rig.records.back().event, HealthEvent::alarm);
}

/// More blocks at one station than are counted: it stays the station that it was.
// Negative: REQ-106
TEST(Votes, AThousandBlocksAtOneStationExcludeNoSensor) {
  MonitorConfig config;
  config.window = 8;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  const HealthState before = rig.monitor.verdict().state;
  rig.stay(direction_at(40, 40), 1003);
  EXPECT_EQ(rig.monitor.verdict().state, before);
  EXPECT_TRUE(rig.ever_blamed.empty());
}

/// Two faults are asserted, which of four sensors nobody could tell apart: the votes of the stations exclude one alone.
// Verifies: REQ-070
TEST(Votes, AFaultThatTheAssumptionCannotIsolateTheyMay) {
  MonitorConfig config;
  config.assumed_faults = 2;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  for (int k = 0; k < 12; ++k) rig.stay(direction_at(25 + 37 * (k % 4), 67 * k), 2);
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(2));
  EXPECT_EQ(rig.ever_blamed, SensorSet::of(2));
}

}  // namespace
}  // namespace votes_test
