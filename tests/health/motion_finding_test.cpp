// What a monitor in motion finds, in the state machine: to suspect at most, provisionally at most, and then rest
// decides.
#include <gtest/gtest.h>

#include "plumb/health/motion_finding.hpp"
#include "support/simulated_tool.hpp"

namespace motion_finding_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;

const Vec3 kSomewhere = direction_at(100, 340);
constexpr double kHard_mps2 = 1.0;

MotionFinding alarm_of(SensorSet excluded = {}) { return {true, excluded}; }

Rig proven(const SensorArray& array, const MonitorConfig& config = {}) {
  Rig rig(array, config);
  rig.prove();
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal);
  rig.records.clear();
  return rig;
}

/// Blocks in motion, all of them with the same finding.
const Verdict& shake(Rig& rig, const MotionFinding& finding, int blocks = 3) {
  rig.monitor.set_motion(finding);
  for (int k = 0; k < blocks; ++k) rig.shake(kSomewhere, kHard_mps2);
  return rig.monitor.verdict();
}

/// Blocks at rest at ever new attitudes, until something is recorded; the record.
TransitionRecord rest(Rig& rig, int attitudes = 20) {
  const std::size_t before = rig.records.size();
  for (int k = 0; k < attitudes && rig.records.size() == before; ++k)
    rig.stay(direction_at(20.0 + 37.0 * (k % 4), 75.0 * k + 5.0));
  return rig.records.size() == before ? TransitionRecord{} : rig.records.back();
}

// Verifies: REQ-200
TEST(MotionFinding, AnAlarmLeadsToSuspectOnceAndPassedBlocksLeadOut) {
  Rig rig = proven(plumb_test::cone_array(6));
  const Verdict& v = shake(rig, alarm_of(), 20);
  ASSERT_EQ(rig.records.size(), 1U) << "however long it stands";
  const TransitionRecord& r = rig.records[0];
  EXPECT_EQ(r.from, HealthState::nominal);
  EXPECT_EQ(r.to, HealthState::suspect);
  EXPECT_EQ(r.event, HealthEvent::alarm);
  EXPECT_EQ(r.cause, Cause::parity_in_motion);
  EXPECT_EQ(r.grade, Grade::none);
  EXPECT_TRUE(r.sensors.empty());
  EXPECT_EQ(v.validity, Validity::held);
  EXPECT_EQ(v.stations_on_record, 0);
  const TransitionRecord out = rest(rig);  // the alarm still stands, and counts for nothing
  EXPECT_EQ(out.event, HealthEvent::passed_block);
  EXPECT_EQ(out.to, HealthState::nominal);
}

/// Two parallel triads, of which the second is dead while the tool moves: its axes are as quiet as at rest.
// Verifies: REQ-200
TEST(MotionFinding, AChipThatMotionExcludedIsNoWitnessOfRest) {
  AxisList axes{};
  for (std::size_t i = 0; i < 6; ++i) axes[i][i % 3] = 1.0;
  const SensorSet chip(0b111000), other(0b111);
  for (const bool told : {false, true}) {
    Rig rig = proven(plumb_test::make_array(axes, 6, 2e-4 * kG0_mps2));
    rig.distort = [](int i, double y, int) { return i < 3 ? y : 0.0; };
    const Verdict& v = shake(rig, told ? alarm_of(chip) : MotionFinding{}, 4);
    EXPECT_EQ((v.usable & Usable::stationary) != 0, !told) << "nobody said that it moves";
    EXPECT_EQ(v.provisionally_excluded, told ? chip : SensorSet{});
    EXPECT_EQ(v.in_service, told ? other : other | chip);
    EXPECT_NE(v.validity, Validity::valid);
    if (!told) continue;
    EXPECT_EQ(rig.records.back().cause, Cause::parity_in_motion);
    EXPECT_TRUE((v.noisy & other).empty());
    rig.stay(kSomewhere, 4);
    EXPECT_NE(rig.monitor.verdict().usable & Usable::stationary, 0U) << "at rest the others show it";
  }
}

// Verifies: REQ-200
TEST(MotionFinding, BlocksThatPassedBeforeItCountNoMore) {
  Rig rig = proven(plumb_test::cone_array(6));
  shake(rig, alarm_of());
  for (int round = 0; round < 8; ++round) {
    rig.stay(kSomewhere, 2);  // never three in a row without motion that contradicts itself
    EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect);
    rig.shake(kSomewhere, kHard_mps2);
  }
  EXPECT_EQ(rig.records.size(), 1U);
  EXPECT_EQ(rig.monitor.verdict().stations_on_record, 0);
}

// Verifies: REQ-200
TEST(MotionFinding, ASensorIsExcludedProvisionallyAndTheRecordSaysWhereItCameFrom) {
  Rig rig = proven(plumb_test::cone_array(6));
  const Verdict& v = shake(rig, alarm_of(SensorSet::of(2)));
  ASSERT_EQ(rig.records.size(), 1U);
  const TransitionRecord& r = rig.records[0];
  EXPECT_EQ(r.to, HealthState::suspect);
  EXPECT_EQ(r.event, HealthEvent::provisional_exclusion);
  EXPECT_EQ(r.cause, Cause::parity_in_motion);
  EXPECT_EQ(r.grade, Grade::provisional);
  EXPECT_EQ(r.sensors, SensorSet::of(2));
  EXPECT_EQ(v.provisionally_excluded, SensorSet::of(2));
  EXPECT_TRUE(v.excluded.empty());
  EXPECT_EQ(v.sensor_cause[2], Cause::parity_in_motion);
  EXPECT_NE(v.qualifiers & Qualifier::provisional, 0);
}

// Verifies: REQ-200
TEST(MotionFinding, RestConfirmsItAtTheConfirmedGrade) {
  Rig rig = proven(plumb_test::cone_array(6));
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 2.0 : r; };
  shake(rig, alarm_of(SensorSet::of(2)));
  std::vector<HealthEvent> events;
  for (int k = 0; k < 4 && rig.monitor.verdict().excluded.empty(); ++k) events.push_back(rest(rig).event);
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(2));
  EXPECT_EQ(events.back(), HealthEvent::exclusion);
  EXPECT_EQ(rig.records.back().grade, Grade::confirmed);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::isolated);
}

// Verifies: REQ-200
TEST(MotionFinding, RestRefutesItByProbationAndMemoryAloneExcludesNobodyAgain) {
  Rig rig = proven(plumb_test::cone_array(6));
  const MotionFinding found = alarm_of(SensorSet::of(2));
  shake(rig, found);
  EXPECT_EQ(rest(rig).to, HealthState::isolated);
  const TransitionRecord back = rest(rig);
  EXPECT_EQ(back.event, HealthEvent::probation_passed);
  EXPECT_EQ(back.sensors, SensorSet::of(2));
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal);
  shake(rig, found);  // the host has not told the monitor in motion
  EXPECT_EQ(rig.monitor.verdict().in_service, SensorSet::first(6));
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect) << "its alarm stands all the same";
  shake(rig, {});
  shake(rig, found);  // found anew
  EXPECT_EQ(rig.monitor.verdict().provisionally_excluded, SensorSet::of(2));
  for (int k = 0; k < 3; ++k) rest(rig);
  EXPECT_EQ(rig.monitor.verdict().provisionally_excluded, SensorSet::of(2)) << "probation reinstates no sensor twice";
  EXPECT_TRUE(rig.monitor.verdict().excluded.empty());
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::isolated);
}

// Verifies: REQ-200
TEST(MotionFinding, AtRestItCountsForNothing) {
  Rig rig = proven(plumb_test::cone_array(6)), twin = proven(plumb_test::cone_array(6));
  for (Rig* one : {&rig, &twin}) one->distort = [](int i, double r, int k) { return i == 4 && k > 1000 ? r + 1.0 : r; };
  for (int k = 0; k < 60; ++k) {
    rig.monitor.set_motion(alarm_of(SensorSet(static_cast<std::uint32_t>(k))));
    const Vec3 there = direction_at(20.0 + 37.0 * (k % 4), 75.0 * k);
    const Verdict &v = rig.stay(there), &w = twin.stay(there);
    EXPECT_EQ(v.state, w.state);
    EXPECT_EQ(v.in_service, w.in_service);
    EXPECT_EQ(v.gravity_mps2, w.gravity_mps2);
    EXPECT_EQ(v.protection_level_housing_rad, w.protection_level_housing_rad);
  }
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(4));
  EXPECT_EQ(rig.records.size(), twin.records.size());
}

// Negative: REQ-200
TEST(MotionFinding, NeverSoThatFewerThanThreeAxesAreLeft) {
  Rig rig = proven(plumb_test::tetrahedron());
  const Verdict& v = shake(rig, alarm_of(SensorSet(0b0011)));
  ASSERT_EQ(rig.records.size(), 1U);
  EXPECT_EQ(rig.records[0].event, HealthEvent::alarm);
  EXPECT_EQ(v.state, HealthState::suspect);
  EXPECT_EQ(v.in_service, SensorSet::first(4));
  shake(rig, alarm_of(SensorSet::of(1)));  // one of four can be borne
  EXPECT_EQ(rig.monitor.verdict().provisionally_excluded, SensorSet::of(1));
  shake(rig, alarm_of(SensorSet(0b1110)));
  EXPECT_EQ(rig.monitor.verdict().in_service, SensorSet(0b1101));
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect);
  EXPECT_EQ(rest(rig).to, HealthState::degraded_3_sensor) << "by blocks that passed at rest";
}

// Negative: REQ-200
TEST(MotionFinding, ADegradedMonitorIsAlarmedAndNeverFails) {
  Rig rig = proven(plumb_test::tetrahedron());
  rig.distort = [](int i, double r, int) { return i == 0 ? std::numeric_limits<double>::quiet_NaN() : r; };
  ASSERT_EQ(rig.stay(kSomewhere).state, HealthState::degraded_3_sensor);
  for (int k = 0; k < 30; ++k) {
    EXPECT_EQ(shake(rig, alarm_of(SensorSet(static_cast<std::uint32_t>(k % 16)))).state, HealthState::suspect);
    EXPECT_EQ(rig.monitor.verdict().in_service, SensorSet(0b1110));
  }
  EXPECT_EQ(rest(rig).to, HealthState::degraded_3_sensor);
}

// Verifies: REQ-200
TEST(MotionFinding, AnInhibitHoldsItsExclusionBackAndNotItsAlarm) {
  Rig rig = proven(plumb_test::cone_array(6));
  rig.monitor.inhibit(true);
  const Verdict& v = shake(rig, alarm_of(SensorSet::of(2)));
  EXPECT_EQ(v.state, HealthState::suspect);
  EXPECT_EQ(v.in_service, SensorSet::first(6));
  rig.monitor.inhibit(false);
  rig.shake(kSomewhere, kHard_mps2);
  EXPECT_EQ(rig.monitor.verdict().provisionally_excluded, SensorSet::of(2));
}

// Verifies: REQ-200
TEST(MotionFinding, BeyondTheTemperaturesNothingIsTakenUp) {
  MonitorConfig config;
  config.temperature_max_degc = 60.0;
  Rig rig = proven(plumb_test::cone_array(6), config);
  rig.monitor.set_motion(alarm_of(SensorSet::of(2)));
  for (int k = 0; k < 200; ++k) {
    Sample s = rig.sample(kSomewhere, kG0_mps2 * (k % 2 == 0 ? 0.9 : 1.1));
    s.temperature_degc = 200.0;
    rig.step(s);
  }
  EXPECT_TRUE(rig.records.empty());
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal);
  rig.shake(kSomewhere, kHard_mps2);
  rig.shake(kSomewhere, kHard_mps2);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect);
}

/// A tool whose sensors have drifted contradicts itself in motion, and has to be calibrated again all the same.
// Verifies: REQ-200
TEST(MotionFinding, ACalibrationThatIsBeingMadeIsLeftAlone) {
  Rig rig = proven(plumb_test::cone_array(6));
  ASSERT_TRUE(rig.monitor.request_recalibration().has_value());
  rig.stay(kSomewhere);
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::recalibrating);
  const std::size_t before = rig.records.size();
  EXPECT_EQ(shake(rig, alarm_of(SensorSet::of(2))).state, HealthState::recalibrating);
  EXPECT_EQ(rig.records.size(), before);
}

/// What rest found stays the cause: a norm mismatch that motion joins is one still.
// Verifies: REQ-200
TEST(MotionFinding, WhatRestSuspectsIsNotCoveredUp) {
  Rig rig = proven(plumb_test::cone_array(6));
  rig.stay(kSomewhere, 1, 1.02 * kG0_mps2);
  ASSERT_EQ(rig.monitor.verdict().cause, Cause::norm_mismatch);
  shake(rig, alarm_of(SensorSet::of(2)));
  rig.stay(kSomewhere);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect);
  EXPECT_EQ(rig.monitor.verdict().usable & Usable::reference, 0);
  EXPECT_EQ(rig.monitor.verdict().validity, Validity::unconfirmed);
}

// Verifies: REQ-200, REQ-163
TEST(MotionFinding, ASnapshotCarriesIt) {
  Rig rig = proven(plumb_test::cone_array(6));
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 2.0 : r; };
  shake(rig, alarm_of(SensorSet::of(2)));
  std::vector<std::uint8_t> bytes(HealthMonitor::snapshot_size_max());
  const Expected<std::size_t> size = rig.monitor.snapshot(bytes.data(), bytes.size());
  ASSERT_TRUE(size.has_value());
  Rig again = rig;
  ASSERT_TRUE(again.monitor.restore(rig.setup, bytes.data(), *size).has_value());
  for (int k = 0; k < 6; ++k) {
    const TransitionRecord a = rest(rig), b = rest(again);
    EXPECT_EQ(a.event, b.event);
    EXPECT_EQ(a.time_s, b.time_s);
  }
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(2));
  EXPECT_EQ(again.monitor.verdict().excluded, SensorSet::of(2));
}

// Negative: REQ-200
TEST(MotionFinding, OfAMonitorThatWasNeverConfiguredItIsNone) {
  HealthMonitor monitor;
  monitor.set_motion(alarm_of(SensorSet(~0U)));
  EXPECT_EQ(monitor.step(Sample{}).validity, Validity::invalid);
  Rig rig = proven(plumb_test::cone_array(5));
  shake(rig, {false, SensorSet(~0U << 5U)});  // sensors that there are not
  EXPECT_TRUE(rig.records.empty());
}

}  // namespace
}  // namespace motion_finding_test
