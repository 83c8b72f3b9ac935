// What a change of the sets takes with it: the step that makes it speaks of those that are left, and of nobody else.
#include <gtest/gtest.h>

#include <cmath>

#include "health/recalibration_support.hpp"

namespace changes_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::Rig;
using plumb_test::Tool;

/// Steps until somebody is excluded; false where nobody is.
bool until_excluded(Rig& rig, SensorSet whom, std::uint64_t seed) {
  Noise noise(seed);
  for (int k = 0; k < 12; ++k) {
    const Vec3 direction = plumb_test::random_direction(noise);
    for (int s = 0; s < rig.setup.config.window; ++s) {
      if (rig.step(rig.sample(direction, kG0_mps2)).excluded == whom) return true;
    }
  }
  return false;
}

// Verifies: REQ-092
TEST(Changes, TheVectorOfTheStepThatExcludesIsThatOfTheSurvivors) {
  if (kCapacity < 6) GTEST_SKIP() << "six sensors";
  MonitorConfig config;
  config.assumed_faults = 1;
  Rig rig(plumb_test::cone_array(6), config);
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 4.0 : r; };
  ASSERT_TRUE(until_excluded(rig, SensorSet::of(2), 3));
  const Verdict& v = rig.monitor.verdict();
  EXPECT_TRUE(v.protection_available);
  EXPECT_LT(v.protection_level_calibrated_axes_rad, rad_from_deg(1.0)) << "the faulty one bounds nothing any more";
  EXPECT_LT(v.mae_all_mps2, 0.01) << "nor is it in the window";
  EXPECT_EQ(v.state, HealthState::isolated);
}

// Verifies: REQ-101
TEST(Changes, TheRecordHoldsTheLimitAndAGradeOnlyForAnExclusion) {
  if (kCapacity < 5) GTEST_SKIP() << "five sensors";
  Rig rig(plumb_test::cone_array(5));
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 1.0 : r; };
  ASSERT_TRUE(until_excluded(rig, SensorSet::of(2), 5));
  const double limit = rig.monitor.verdict().limit;
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 1.0 : i == 4 ? std::nan("") : r; };
  rig.stay(direction_at(20, 40), 8);
  int excluded = 0, others = 0;
  for (const TransitionRecord& record : rig.records) {
    const bool excludes = record.event == HealthEvent::exclusion || record.event == HealthEvent::provisional_exclusion;
    EXPECT_EQ(record.grade != Grade::none, excludes) << to_string(record.event);
    if (record.event == HealthEvent::alarm || excludes) {
      EXPECT_GT(record.limit, 0.0) << to_string(record.event);
      EXPECT_LT(record.limit, 10.0 * limit) << to_string(record.event);
    }
    (excludes ? excluded : others) += 1;
  }
  EXPECT_GT(excluded, 0);
  EXPECT_GT(others, 1) << "trust is earned, a channel lost";
  EXPECT_EQ(rig.records.back().event, HealthEvent::channel_lost);
}

/// "At most two are faulty": the first that is excluded uses up one of them, and the second is believed as quickly.
// Verifies: REQ-073
TEST(Changes, OneExcludedOfTwoAssumedFaultsLeavesOne) {
  if (kCapacity < 7) GTEST_SKIP() << "seven sensors";
  MonitorConfig config;
  config.assumed_faults = 2;
  Rig rig(plumb_test::cone_array(7), config);
  rig.prove();
  SensorSet lying;
  rig.distort = [&lying](int i, double r, int) { return lying.has(i) ? r + 2.0 + 0.7 * i : r; };
  Noise noise(2);
  for (const int next : {5, 1}) {
    lying = lying.with(next);
    const Vec3 direction = plumb_test::random_direction(noise);
    EXPECT_EQ(rig.stay(direction).excluded, lying);
    EXPECT_EQ(rig.records.back().grade, Grade::assumed);
    for (int k = 0; k < 6; ++k) rig.stay(plumb_test::random_direction(noise));
  }
}

/// The key returns those that deliver: a silent channel is not among them, whoever is named.
// Negative: REQ-095
TEST(Changes, TheKeyReturnsNoSilentSensor) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  SensorSet silent = SensorSet::of(0).with(3);
  rig.distort = [&silent](int i, double r, int) { return silent.has(i) ? std::nan("") : r; };
  rig.stay(direction_at(40, 70), 12);
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::failed);
  ASSERT_EQ(rig.monitor.verdict().absent, silent);
  const auto turn = [&rig](SensorSet named) {
    EXPECT_TRUE(rig.monitor.reset(rig.setup.config.reset_key, named).has_value());
    rig.step(rig.sample(direction_at(40, 70), kG0_mps2));
    return rig.monitor.verdict();
  };
  for (const SensorSet named : {SensorSet::first(4), SensorSet::of(1)}) {
    const Verdict v = turn(named);
    EXPECT_EQ(v.state, HealthState::failed);
    EXPECT_EQ(v.absent, silent);
  }
  silent = SensorSet::of(3);
  rig.stay(direction_at(40, 70), 12);
  const Verdict v = turn(SensorSet::of(0));
  EXPECT_EQ(v.state, HealthState::suspect);
  EXPECT_EQ(v.in_service, SensorSet::first(3));
  EXPECT_EQ(v.absent, silent);
}

/// An offered calibration is one of the sensors that served when it was offered: it is dropped with the first of them.
// Negative: REQ-135
TEST(Changes, AnOfferedCalibrationIsDroppedWithALostChannel) {
  if (kCapacity < 6) GTEST_SKIP() << "six sensors";
  Tool tool(6, {}, 3);
  tool.rig.prove();
  ASSERT_EQ(tool.state(), HealthState::nominal);
  tool.fault = [](int i, double r, int) { return i == 5 ? std::nan("") : r; };
  for (int k = 0; k < 400; ++k) {
    HealthMonitor before = tool.rig.monitor;
    const Sample sample = tool.rig.sample(direction_at(70, 70), kG0_mps2);
    if (tool.rig.step(sample).absent.empty()) continue;
    ASSERT_TRUE(before.offer_calibration(tool.rig.setup.model, tool.rig.setup.array).has_value());
    EXPECT_EQ(before.step(sample).absent, SensorSet::of(5));
    for (int s = 0; s < 128; ++s) {
      const Verdict& v = before.step(tool.rig.sample(direction_at(70, 70), kG0_mps2));
      ASSERT_EQ(v.state, HealthState::isolated) << s;
      ASSERT_FALSE(v.recalibration.offered) << s;
    }
    return;
  }
  FAIL() << "the channel was not missed";
}

/// Both were learnt from all six: the kind of the norm mismatch, and which way a sensor goes.
// Verifies: REQ-062
TEST(Changes, TheStudiesOfTheNormAndOfADriftEndWithALostChannel) {
  if (kCapacity < 6) GTEST_SKIP() << "six sensors";
  for (const bool drifts : {false, true}) {
    Rig rig(plumb_test::cone_array(6));
    rig.prove();
    bool lost = false;
    rig.distort = [&](int i, double r, int k) {
      return lost && i == 5 ? std::nan("") : drifts && i == 2 ? r + 4e-7 * k : r;
    };
    Noise noise(8);
    const double g_mps2 = drifts ? kG0_mps2 : 1.02 * kG0_mps2;  // farther off than gravity is widened for
    for (int k = 0; k < (drifts ? 120 : 12); ++k) rig.stay(plumb_test::random_direction(noise), 1, g_mps2);
    const auto attitudes = [&rig] { return rig.monitor.verdict().norm_mismatch.attitudes; };
    const auto drift = [&rig] { return rig.monitor.verdict().drift_mps2_per_h[2]; };
    if (drifts) {
      ASSERT_GT(drift(), 0.0F);
    } else {
      ASSERT_GE(attitudes(), 6);
    }
    lost = true;
    int blocks = 0;
    while (blocks < 12 && rig.monitor.verdict().absent.empty()) {
      rig.stay(plumb_test::random_direction(noise), 1, g_mps2);
      ++blocks;
    }
    ASSERT_EQ(rig.monitor.verdict().absent, SensorSet::of(5));
    rig.stay(plumb_test::random_direction(noise), 1, g_mps2);
    EXPECT_LE(attitudes(), 2);
    EXPECT_EQ(drift(), 0.0F);
  }
}

}  // namespace
}  // namespace changes_test
