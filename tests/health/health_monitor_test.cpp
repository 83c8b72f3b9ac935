#include "plumb/health/health_monitor.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>

#include "support/simulated_tool.hpp"

namespace health_monitor_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;

SensorArray triad() {
  AxisList axes{};
  return plumb_test::make_array(axes, orthogonal_triad(axes), 2e-4 * kG0_mps2);
}

// Verifies: REQ-093
TEST(HealthMonitor, StartsUnvalidatedAndIsValidatedOnlyByAChangeOfAttitude) {
  Rig rig(plumb_test::tetrahedron());
  EXPECT_EQ(rig.stay(direction_at(40, 30), 20).state, HealthState::suspect)
      << "one attitude proves nothing (stuck at power-on)";
  EXPECT_EQ(rig.monitor.verdict().validity, Validity::valid) << "within the bound over every fault of one sensor";
  EXPECT_TRUE(rig.monitor.verdict().qualifiers & Qualifier::not_yet_validated);
  const Verdict& v = rig.prove();
  EXPECT_EQ(v.state, HealthState::nominal);
  EXPECT_EQ(v.validity, Validity::valid);
  EXPECT_TRUE(v.protection_available);
  EXPECT_FALSE(v.alert);
  EXPECT_LT(angle_between_rad(v.gravity_mps2, direction_at(100, 340)), 1e-3);
}

/// One sensor is off from power-on: nothing changes state, and yet the first alarm is on record, once.
// Verifies: REQ-101
TEST(HealthMonitor, TheFirstAlarmBeforeValidationIsOnRecord) {
  Rig rig(plumb_test::tetrahedron());
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 0.5 : r; };
  rig.stay(direction_at(40, 30), 12);
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::suspect);
  ASSERT_EQ(rig.records.size(), 1U);
  const TransitionRecord& first = rig.records.front();
  EXPECT_EQ(first.event, HealthEvent::alarm);
  EXPECT_EQ(first.cause, Cause::parity);
  EXPECT_EQ(first.sequence, 1U);
  EXPECT_TRUE(first.from == HealthState::suspect && first.to == HealthState::suspect);
  EXPECT_GT(first.statistic, first.limit);
}

/// An alarm that changes the state is one record, not two.
// Negative: REQ-101
TEST(HealthMonitor, AnAlarmThatChangesTheStateIsRecordedOnce) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  const std::size_t before = rig.records.size();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 0.5 : r; };
  rig.stay(direction_at(45, 200), 10);
  ASSERT_EQ(rig.records.size(), before + 1);
  EXPECT_EQ(rig.records.back().event, HealthEvent::alarm);
  EXPECT_EQ(rig.records.back().to, HealthState::suspect);
}

// Verifies: REQ-094
TEST(HealthMonitor, NothingIsSaidBeforeTheFirstBlock) {
  Rig rig(plumb_test::tetrahedron());
  const Verdict& v = rig.step(rig.sample(direction_at(30, 0), kG0_mps2));
  EXPECT_EQ(v.validity, Validity::invalid);
  EXPECT_TRUE(v.alert);
}

// Verifies: REQ-071, REQ-122
TEST(HealthMonitor, AStuckSensorOfFourIsExcludedAfterFourAttitudesAndLeavesDegraded) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? 0.0 : r; };
  const Verdict& first = rig.stay(direction_at(45, 200));
  EXPECT_EQ(first.state, HealthState::suspect);
  EXPECT_EQ(first.validity, Validity::unconfirmed);
  EXPECT_EQ(first.cause, Cause::parity);
  EXPECT_LT(first.margin, 0.0);
  rig.stay(direction_at(45, 200), 10);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect) << "more samples at one attitude do not isolate";
  rig.stay(direction_at(50, 260));
  rig.stay(direction_at(60, 320));
  const Verdict& last = rig.stay(direction_at(70, 20));
  EXPECT_EQ(last.state, HealthState::degraded_3_sensor);
  EXPECT_EQ(last.excluded, SensorSet::of(2));
  EXPECT_EQ(last.validity, Validity::degraded);
  EXPECT_GT(last.protection_level_calibrated_axes_rad, rad_from_deg(10.0))
      << "one of three at fault may show a mirrored vector";
  EXPECT_EQ(last.faults_covered, 1);
  EXPECT_TRUE(last.alert);
  EXPECT_LT(angle_between_rad(last.gravity_mps2, direction_at(70, 20)), 2e-3);
  EXPECT_EQ(rig.ever_blamed, SensorSet::of(2));
}

// Verifies: REQ-072
TEST(HealthMonitor, SevenSensorsProvisionallyExcludeTheFaultAtOnceAndStayUsable) {
  Rig rig(plumb_test::cone_array(7));
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 5 ? r + 0.3 : r; };
  const Verdict& first = rig.stay(direction_at(45, 200));
  EXPECT_EQ(first.state, HealthState::suspect);
  EXPECT_EQ(first.provisionally_excluded, SensorSet::of(5));
  EXPECT_LT(angle_between_rad(first.gravity_mps2, direction_at(45, 200)), 1e-3) << "the vector is already without it";
  const Verdict& v = rig.stay(direction_at(45, 200), 3);
  EXPECT_EQ(v.state, HealthState::isolated);
  EXPECT_EQ(v.validity, Validity::valid);
  EXPECT_TRUE(v.qualifiers & Qualifier::provisional);
  // Over four attitudes the confirmed grade confirms it and it is latched.
  rig.stay(direction_at(55, 260));
  rig.stay(direction_at(65, 310));
  const Verdict& latched = rig.stay(direction_at(75, 10), 1);
  EXPECT_EQ(latched.excluded, SensorSet::of(5));
  EXPECT_EQ(latched.grade, Grade::confirmed);
  EXPECT_EQ(rig.ever_blamed, SensorSet::of(5));
}

// Verifies: REQ-073
TEST(HealthMonitor, AnAssumedSingleFaultIsExcludedAtOneStation) {
  MonitorConfig config;
  config.assumed_faults = 1;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 1 ? r + 1.0 : r; };
  const Verdict& v = rig.stay(direction_at(55, 77));
  EXPECT_EQ(v.excluded, SensorSet::of(1));
  EXPECT_EQ(v.grade, Grade::assumed);
}

// Verifies: REQ-059
TEST(HealthMonitor, MotionHoldsTheOutputAndExcludesNoSensor) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  for (int k = 0; k < 50; ++k) {
    const Verdict& v = rig.shake(direction_at(100, 340), 0.05 * (k + 1));
    EXPECT_EQ(v.state, HealthState::nominal);
    EXPECT_EQ(v.validity, Validity::held);
    EXPECT_EQ(v.cause, Cause::moving);
  }
  EXPECT_TRUE(rig.ever_blamed.empty());
  EXPECT_EQ(rig.stay(direction_at(100, 340)).validity, Validity::valid);
}

// Verifies: REQ-060
TEST(HealthMonitor, WrongGravityIsANormMismatchAndNeverAnExclusionOrAFailure) {
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  plumb_test::Noise noise(4);
  for (int k = 0; k < 40; ++k) rig.stay(plumb_test::random_direction(noise), 1, kG0_mps2 * 1.02);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect);
  EXPECT_EQ(rig.monitor.verdict().cause, Cause::norm_mismatch);
  EXPECT_TRUE(rig.ever_blamed.empty());
}

// Verifies: REQ-092
TEST(HealthMonitor, ALostChannelIsAbsentAndTwoOfFourFail) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 0 ? std::numeric_limits<double>::quiet_NaN() : r; };
  EXPECT_EQ(rig.stay(direction_at(60, 10)).state, HealthState::degraded_3_sensor);
  EXPECT_EQ(rig.monitor.verdict().absent, SensorSet::of(0));
  rig.distort = [](int i, double r, int) { return i <= 1 ? std::numeric_limits<double>::infinity() : r; };
  const Verdict& v = rig.stay(direction_at(60, 10));
  EXPECT_EQ(v.state, HealthState::failed);
  EXPECT_EQ(v.validity, Validity::invalid);
  rig.distort = [](int, double r, int) { return r; };
  rig.prove();
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::failed) << "latched";
}

// Verifies: REQ-095
TEST(HealthMonitor, OnlyTheKeyLeavesFailedAndTheSensorsAreValidatedAgain) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i <= 1 ? std::numeric_limits<double>::infinity() : r; };
  rig.stay(direction_at(60, 10));
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::failed);
  rig.distort = [](int, double r, int) { return r; };
  rig.stay(direction_at(60, 10));
  EXPECT_EQ(rig.monitor.reset(1, SensorSet::first(4)).error().code, Errc::wrong_key);
  rig.stay(direction_at(60, 10));
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::failed);
  ASSERT_TRUE(rig.monitor.reset(rig.setup.config.reset_key, SensorSet::first(4)).has_value());
  const Verdict& v = rig.stay(direction_at(60, 10));
  EXPECT_EQ(v.state, HealthState::suspect);
  EXPECT_TRUE(v.qualifiers & Qualifier::not_yet_validated);
  EXPECT_EQ(v.in_service, SensorSet::first(4));
  EXPECT_EQ(rig.prove().state, HealthState::nominal);
}

// Verifies: REQ-098
// Negative: REQ-060
TEST(HealthMonitor, ThreeSensorsWithAPersistentNormViolationFailAfterTheTimeout) {
  AxisList axes{};
  Rig rig(plumb_test::make_array(axes, orthogonal_triad(axes), 2e-4 * kG0_mps2));
  rig.prove();
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::degraded_3_sensor) << "three sensors are degraded from the start";
  rig.distort = [](int i, double r, int) { return i == 0 ? r + 0.5 : r; };
  plumb_test::Noise noise(8);
  EXPECT_EQ(rig.stay(direction_at(90, 270)).state, HealthState::suspect);
  for (int k = 0; k < 12; ++k) rig.stay(plumb_test::random_direction(noise));
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::failed);
}

// Verifies: REQ-099
TEST(HealthMonitor, ARecoveredSensorReturnsOnlyByProbation) {
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 4 ? r + 0.4 : r; };
  plumb_test::Noise noise(12);
  for (int k = 0; k < 8; ++k) rig.stay(plumb_test::random_direction(noise));
  ASSERT_EQ(rig.monitor.verdict().excluded, SensorSet::of(4));
  rig.distort = [](int, double r, int) { return r; };
  for (int k = 0; k < 4; ++k) {
    rig.stay(plumb_test::random_direction(noise));
    EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(4));
  }
  for (int k = 0; k < 12; ++k) rig.stay(plumb_test::random_direction(noise));
  EXPECT_TRUE(rig.monitor.verdict().excluded.empty());
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal);
  EXPECT_EQ(rig.records.back().event, HealthEvent::probation_passed);
}

/// What the key brings back has its probation still before it.
// Verifies: REQ-099
TEST(HealthMonitor, TheKeyUsesUpNoProbation) {
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  rig.distort = [](int i, double r, int) { return i <= 3 ? std::numeric_limits<double>::infinity() : r; };
  rig.stay(direction_at(60, 10));
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::failed);
  rig.distort = [](int, double r, int) { return r; };
  rig.stay(direction_at(60, 10));
  ASSERT_TRUE(rig.monitor.reset(rig.setup.config.reset_key, SensorSet::first(6)).has_value());
  ASSERT_EQ(rig.prove().state, HealthState::nominal);
  rig.distort = [](int i, double r, int) { return i == 1 ? r + 0.4 : r; };
  plumb_test::Noise noise(12);
  for (int k = 0; k < 8; ++k) rig.stay(plumb_test::random_direction(noise));
  ASSERT_EQ(rig.monitor.verdict().excluded, SensorSet::of(1));
  rig.distort = [](int, double r, int) { return r; };
  for (int k = 0; k < 16; ++k) rig.stay(plumb_test::random_direction(noise));
  EXPECT_TRUE(rig.monitor.verdict().excluded.empty());
}

/// A loss names who is lost now, and nobody who was lost before.
// Verifies: REQ-141
TEST(HealthMonitor, ALossRecordsTheLostChannelOnly) {
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  SensorSet silent;
  for (const int lost : {4, 2}) {
    silent = silent.with(lost);
    for (int k = 0; k < 8; ++k) {
      Sample s = rig.sample(direction_at(30, 60), kG0_mps2);
      s.delivered = s.delivered - silent;
      rig.step(s);
    }
    EXPECT_EQ(rig.monitor.verdict().absent, silent);
    EXPECT_EQ(rig.records.back().sensors, SensorSet::of(lost));
  }
}

// Verifies: REQ-146
TEST(HealthMonitor, RefusedTimesChangeNothingButHoldTheOutput) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  Sample late = rig.sample(direction_at(100, 340), kG0_mps2);
  late.time_s = 0.001;
  for (int k = 0; k < 100; ++k) {
    const Verdict& v = rig.monitor.step(late);
    EXPECT_FALSE(v.accepted);
    EXPECT_EQ(v.cause, Cause::time_fault);
    EXPECT_EQ(v.state, HealthState::nominal);
    EXPECT_EQ(v.validity, Validity::held);
  }
  late.time_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rig.monitor.step(late).accepted);
  EXPECT_EQ(rig.stay(direction_at(100, 340)).validity, Validity::valid);
}

// Verifies: REQ-141
// Negative: REQ-120
TEST(HealthMonitor, WithoutABlockAtRestForTAgeNothingIsValid) {
  MonitorConfig config;
  config.max_age_s = 2.0;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  Sample silent = rig.sample(direction_at(10, 0), kG0_mps2);
  silent.delivered = SensorSet{};
  for (int k = 0; k < 300; ++k) {
    silent.time_s += 0.01;
    rig.monitor.step(silent);
  }
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal);
  EXPECT_EQ(rig.monitor.verdict().validity, Validity::held);
}

/// Given up for its share and not for a silence: as soon as it speaks again it is back, though on trial.
// Verifies: REQ-141
TEST(HealthMonitor, AChannelLostForItsGapsComesBack) {
  Rig rig(plumb_test::cone_array(5));
  rig.prove();
  for (int k = 0; k < 4 * rig.setup.config.window; ++k) {
    Sample s = rig.sample(direction_at(30, 60), kG0_mps2);
    if (k % 3 != 0) s.delivered = s.delivered.without(1);
    rig.step(s);
  }
  EXPECT_EQ(rig.monitor.verdict().absent, SensorSet::of(1));
  const Verdict& v = rig.stay(direction_at(30, 60));
  EXPECT_TRUE(v.absent.empty());
  EXPECT_EQ(v.excluded, SensorSet::of(1));
}

// Verifies: REQ-064
TEST(HealthMonitor, TemperatureBeyondTheSpanIsUnconfirmedAndRejectsNoHypothesis) {
  MonitorConfig config;
  config.temperature_min_degc = 0.0;
  config.temperature_max_degc = 100.0;
  Rig rig(plumb_test::cone_array(5), config);
  rig.prove();
  for (int k = 0; k < 10 * 32; ++k) {
    Sample s = rig.sample(direction_at(45, 40.0 * (k / 32)), kG0_mps2);
    s.temperature_degc = 140.0;
    s.raw[0] += 1.0;
    rig.step(s);
  }
  EXPECT_EQ(rig.monitor.verdict().validity, Validity::unconfirmed);
  EXPECT_TRUE(rig.ever_blamed.empty());
}

/// A sensor that reads specific force has the other sign, and the same monitor comes of it.
// Verifies: REQ-010
TEST(HealthMonitor, SpecificForceIsGravityTheOtherWayRound) {
  Rig gravity(plumb_test::tetrahedron()), force(plumb_test::tetrahedron());
  force.setup.model.reads = Reads::specific_force;
  force.restart();
  for (int k = 0; k < 300; ++k) {
    const Sample s = gravity.sample(direction_at(20.0 + 30.0 * (k / 64), 100.0 * (k / 64)), kG0_mps2);
    Sample other = s;
    for (double& r : other.raw) r = -r;
    const Verdict& v = gravity.step(s);
    const Verdict& w = force.step(other);
    ASSERT_EQ(v.gravity_mps2, w.gravity_mps2);
    ASSERT_EQ(v.state, w.state);
  }
}

/// Turning so slowly that nothing shows of it, and faster; known, and with a channel that is silent.
// Verifies: REQ-065
TEST(HealthMonitor, AKnownSmallRateStopsNoEvidence) {
  const auto locked_at = [](double rate_radps, bool arms) {
    Rig rig(plumb_test::cone_array(5));
    rig.setup.lever_arms_known = arms;
    rig.setup.lever_arm_m[2] = {0.01, 0.0, 0.02};
    rig.restart();
    rig.prove();
    EXPECT_TRUE(rig.monitor.set_rotation({true, true, {0.0, 0.0, rate_radps}}).has_value());
    bool turning = false;
    for (int k = 0; k < 2 * 32; ++k) {
      Sample s = rig.sample(direction_at(20, 30), kG0_mps2);
      if (k % 8 == 3) s.delivered = s.delivered.without(4);
      turning = turning || rig.step(s).cause == Cause::rotating;
    }
    return turning;
  };
  EXPECT_FALSE(locked_at(1e-6, false));
  EXPECT_TRUE(locked_at(1.0, false));
  EXPECT_FALSE(locked_at(1e-3, true));
}

/// Three sensors that read gravity to the last bit, a channel of which missed a sample: nothing is off, nobody checks a
/// triple, and there is no limit of which something would be left.
// Serves: REQ-054
TEST(HealthMonitor, WithoutNoiseTheMarginIsWhole) {
  Rig rig(triad());
  const Vec3 up = {0.0, 0.0, 1.0};
  rig.distort = [&rig, &up](int i, double, int) { return dot(rig.setup.array.axis(i), up) * kG0_mps2; };
  rig.stay(up);
  EXPECT_TRUE(rig.monitor.verdict().tick);
  EXPECT_EQ(rig.monitor.verdict().statistic, 0.0);
  EXPECT_GT(rig.monitor.verdict().limit, 0.0);
  EXPECT_EQ(rig.monitor.verdict().margin, 1.0);
}

}  // namespace
}  // namespace health_monitor_test
