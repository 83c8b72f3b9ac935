/// The paper's algorithm step by step through the state machine.
#include "plumb/paper/paper_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "paper/paper_rig.hpp"

// Serves: REQ-190

namespace paper_monitor_test {
namespace {

using namespace plumb;
using paper_test::at;
using paper_test::direction_at;
using paper_test::PaperRig;

TEST(PaperMonitor, StartsUnvalidatedAndIsValidatedAtTwoAttitudes) {
  PaperRig rig(4);
  EXPECT_EQ(rig.monitor->verdict().validity, Validity::invalid);
  EXPECT_EQ(rig.stay(direction_at(40, 30), 10).state, HealthState::suspect) << "one attitude proves nothing";
  EXPECT_EQ(rig.monitor->verdict().validity, Validity::unconfirmed);
  const Verdict& v = rig.stay(direction_at(80, 200));
  EXPECT_EQ(v.state, HealthState::nominal);
  EXPECT_EQ(v.validity, Validity::valid);
  EXPECT_FALSE(v.protection_available);
  EXPECT_TRUE(v.alert) << "the paper bounds no error";
}

TEST(PaperMonitor, Step2TheGateReadsTheLengthOfGravityByAllSensors) {
  PaperRig rig(4);
  const Verdict& v = rig.prove();
  EXPECT_EQ(v.decided_by, Cause::mae);
  EXPECT_EQ(v.limit, kPaperDeltaF_mps2);
  EXPECT_EQ(v.statistic, v.mae_all_mps2);
  EXPECT_LT(v.mae_all_mps2, 1e-3 * kG0_mps2) << "as row 1 of Table 2 has it";
  EXPECT_GT(v.mae_all_mps2, 1e-5 * kG0_mps2);
  EXPECT_NEAR(norm(v.gravity_mps2), kG0_mps2, 2e-3 * kG0_mps2);
  EXPECT_NEAR(norm(v.latest_mps2), kG0_mps2, 2e-3 * kG0_mps2);
  EXPECT_EQ(v.mae_worst_limit_mps2, 0.0) << "the triples are asked only after the gate";
  EXPECT_EQ(rig.monitor->finding().triples, 0);
}

// Negative: REQ-190
TEST(PaperMonitor, ParityIsShownAndDecidesNothing) {
  PaperRig rig(4);
  rig.prove();
  rig.distort = [](int i, double r) { return i == 3 ? r + 0.02 * kG0_mps2 : r; };
  for (int k = 0; k < 8; ++k) {
    const Verdict& v = rig.tour(1);
    EXPECT_EQ(v.state, HealthState::nominal) << "a fault below delta_F is below the paper's sight";
    EXPECT_GT(v.parity, 10.0 * v.parity_limit);
    EXPECT_GT(v.parity_limit, 0.0);
  }
}

TEST(PaperMonitor, Step3MoreSamplesArePooledUntilEnoughAttitudes) {
  PaperRig rig(4);
  rig.prove();
  rig.stick(2, 0.0);
  const Verdict& first = rig.stay(direction_at(45, 200));
  EXPECT_EQ(first.state, HealthState::suspect);
  EXPECT_EQ(first.cause, Cause::mae);
  EXPECT_EQ(first.transition.event, HealthEvent::alarm);
  EXPECT_LT(first.margin, 0.0);
  EXPECT_EQ(first.validity, Validity::unconfirmed);
  EXPECT_TRUE(first.wants_rotation);
  rig.stay(direction_at(45, 200), 10);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect) << "more samples at one attitude are no attitude";
  EXPECT_EQ(rig.monitor->finding().triples, 0);
  rig.stay(direction_at(55, 260));
  rig.stay(direction_at(65, 320));
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  rig.stay(direction_at(75, 20));
  EXPECT_EQ(rig.monitor->finding().triples, 4);
  EXPECT_EQ(rig.monitor->verdict().excluded, SensorSet::of(2));
}

TEST(PaperMonitor, OneAttitudeIsThePapersLeast) {
  PaperRig rig(4, 1);
  rig.prove();
  rig.stick(0, -kG0_mps2);
  const Verdict& v = rig.stay(direction_at(45, 200));
  EXPECT_EQ(v.state, HealthState::degraded_3_sensor) << "detected and isolated with the first block";
  EXPECT_EQ(v.transition.event, HealthEvent::exclusion);
  EXPECT_EQ(v.transition.from, HealthState::nominal);
  EXPECT_EQ(v.excluded, SensorSet::of(0));
  EXPECT_LT(std::fabs(v.norm_error_mps2), 2e-3 * kG0_mps2) << "the vector is already without it";
}

TEST(PaperMonitor, Steps4To8OneFaultOfFourLeavesThree) {
  for (int faulty = 0; faulty < 4; ++faulty) {
    for (const double volt : {0.0, 3.0, -3.0}) {
      PaperRig rig(4, 4, 10U + static_cast<unsigned>(faulty));
      rig.prove();
      rig.stick(faulty, volt / 3.0 * kG0_mps2);
      const Verdict& v = rig.tour(5);
      EXPECT_EQ(v.excluded, SensorSet::of(faulty)) << volt;
      EXPECT_EQ(v.state, HealthState::degraded_3_sensor);
      EXPECT_EQ(v.validity, Validity::degraded);
      EXPECT_TRUE(v.qualifiers & Qualifier::no_redundancy);
      EXPECT_EQ(rig.states(),
                (std::vector<HealthState>{HealthState::nominal, HealthState::suspect, HealthState::degraded_3_sensor}));
      EXPECT_EQ(rig.records.back().event, HealthEvent::exclusion);
      EXPECT_EQ(rig.records.back().sensors, SensorSet::of(faulty));
      EXPECT_GE(rig.records.back().statistic, rig.records.back().limit);
      EXPECT_EQ(rig.monitor->finding().passing, 1);
    }
  }
}

TEST(PaperMonitor, Step9TheRestMustHoldOrNoSensorIsExcluded) {
  for (const bool spoiled : {false, true}) {
    PaperRig rig(5);
    // Every triple has its own fit; only the fit of all, by which four that remain are read, is off.
    if (spoiled) rig.setup->paper.all.model.sensor[0].bias[0] += 0.6 * kG0_mps2;
    rig.restart();
    rig.stick(4, kG0_mps2);
    rig.tour(4);
    EXPECT_EQ(rig.monitor->finding().isolated, SensorSet::of(4)) << "the triples name it either way";
    EXPECT_EQ(rig.ever_excluded, spoiled ? SensorSet{} : SensorSet::of(4));
    EXPECT_EQ(rig.monitor->verdict().cause, spoiled ? Cause::mae : Cause::isolated_fault);
    EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect) << "not_yet_validated";
  }
}

TEST(PaperMonitor, Step10TheRestOfSixIsCalibratedAnew) {
  PaperRig rig(6);
  rig.prove();
  rig.stick(5, 0.3 * kG0_mps2);
  rig.tour(4);
  EXPECT_EQ(rig.monitor->verdict().excluded, SensorSet::of(5));
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::isolated);
  EXPECT_FALSE(rig.monitor->rest().sound());
  rig.tour(1);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::recalibrating);
  EXPECT_EQ(rig.monitor->verdict().validity, Validity::unconfirmed);
  EXPECT_TRUE(rig.monitor->verdict().wants_rotation);
  rig.tour(11);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::recalibrating);
  rig.tour(1);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  EXPECT_TRUE(rig.monitor->rest().sound());
  EXPECT_EQ(rig.monitor->rest().used, SensorSet::first(5));
  const Verdict& v = rig.tour(4);
  EXPECT_EQ(rig.states(),
            (std::vector<HealthState>{HealthState::nominal, HealthState::suspect, HealthState::isolated,
                                      HealthState::recalibrating, HealthState::suspect, HealthState::isolated}));
  EXPECT_EQ(rig.records[3].event, HealthEvent::recalibrate);
  EXPECT_EQ(rig.records[3].cause, Cause::calibration);
  EXPECT_EQ(rig.records[4].event, HealthEvent::fit_accepted);
  EXPECT_EQ(v.validity, Validity::valid);
  EXPECT_LT(v.mae_all_mps2, 1e-3 * kG0_mps2);
}

TEST(PaperMonitor, Step10AFitThatTheAttitudesDoNotDetermineIsRefusedOnce) {
  PaperRig rig(5);
  rig.prove();
  rig.stick(4, 0.3 * kG0_mps2);
  rig.tour(4);
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::isolated);
  for (int k = 0; k <= 24; ++k) rig.stay(direction_at(80, 15.0 * k));  // one circle of rolls
  EXPECT_EQ(rig.records.back().event, HealthEvent::fit_rejected);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::isolated);
  EXPECT_FALSE(rig.monitor->rest().sound());
  const std::size_t before = rig.records.size();
  rig.tour(8);
  EXPECT_EQ(rig.records.size(), before) << "not tried again; the rest is read by the fit of all";
}

TEST(PaperMonitor, AnAlarmEndsARecalibration) {
  PaperRig rig(6);
  rig.prove();
  rig.stick(5, 0.3 * kG0_mps2);
  rig.tour(8);
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::recalibrating);
  rig.stick(4, 3.0 * kG0_mps2);
  rig.tour(1);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  rig.tour(2);
  EXPECT_EQ(rig.monitor->verdict().excluded, SensorSet::of(5));
  rig.tour(1);
  EXPECT_EQ(rig.monitor->verdict().excluded, SensorSet::of(4).with(5)) << "the pool holds its own attitudes alone";
  EXPECT_FALSE(rig.monitor->rest().sound());
}

TEST(PaperMonitor, Step11ThreeSensorsAreReadByTheirOwnCoefficients) {
  PaperRig rig(4);
  rig.prove();
  rig.stick(1, 0.0);
  rig.tour(6);
  ASSERT_EQ(rig.monitor->verdict().excluded, SensorSet::of(1));
  const Sample s = rig.sample(direction_at(50, 50));
  rig.step(s);
  const auto nominal = rig.sheet.array();
  const int k = nominal->triple_index(0, 2, 3);
  const PaperFit& own = rig.setup->paper.triple[at(k)];
  EXPECT_EQ(rig.monitor->verdict().latest_mps2, paper_vector(*nominal, own, s.raw, 25.0));
  const Vec3 by_all = paper_vector(*nominal, rig.setup->paper.all, s.raw, 25.0, own.used);
  EXPECT_GT(norm(minus(rig.monitor->verdict().latest_mps2, by_all)), 1e-4 * kG0_mps2);
  EXPECT_EQ(rig.tour(2).state, HealthState::degraded_3_sensor);
}

TEST(PaperMonitor, TwoFaultsOfFourAreDetectedButNotIsolated) {
  PaperRig rig(4);
  rig.prove();
  rig.stick(0, 0.8 * kG0_mps2);
  rig.stick(2, -0.5 * kG0_mps2);
  rig.tour(4);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  EXPECT_EQ(rig.monitor->finding().triples, 4);
  EXPECT_EQ(rig.monitor->finding().passing, 0) << "Table 2, rows 18 to 23";
  EXPECT_GT(rig.monitor->verdict().mae_worst_mps2, kPaperDeltaF_mps2);
  EXPECT_EQ(rig.monitor->verdict().cause, Cause::mae);
  rig.tour(8);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::failed) << "isolation timeout: six attitudes without an answer";
  EXPECT_EQ(rig.records.back().event, HealthEvent::isolation_timeout);
  EXPECT_TRUE(rig.ever_excluded.empty());
}

TEST(PaperMonitor, TwoFaultsOfSixAreIsolatedTogether) {
  PaperRig rig(6);
  rig.prove();
  rig.stick(0, 0.0);
  rig.stick(3, -kG0_mps2);
  const Verdict& v = rig.tour(4);
  EXPECT_EQ(v.excluded, SensorSet::of(0).with(3));
  EXPECT_EQ(v.state, HealthState::isolated);
}

TEST(PaperMonitor, ThreeSensorsThatFailTheGateAreNotIsolated) {
  PaperRig rig(3);
  EXPECT_EQ(rig.prove().state, HealthState::degraded_3_sensor);
  rig.stick(0, 0.0);
  rig.tour(4);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  EXPECT_TRUE(rig.ever_excluded.empty());
  EXPECT_EQ(rig.monitor->finding().triples, 0) << "there is no other group to ask";
  EXPECT_FALSE(rig.monitor->verdict().wants_rotation);
  EXPECT_EQ(rig.tour(8).state, HealthState::failed);
}

TEST(PaperMonitor, WithACriticalSensorTheAlarmComesBeforeTheIsolation) {
  AxisList axes{};
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = {0.6, 0.8, 0.0};
  axes[3] = {0.8, -0.6, 0.0};
  axes[4] = {0.0, 0.0, 1.0};
  PaperRig rig(calibration_test::datasheet_of(axes, 5, paper_test::kSigma_mps2), 1, 1);
  EXPECT_EQ(rig.prove().state, HealthState::degraded_3_sensor) << "nobody replaces the one along z";
  rig.stick(0, kG0_mps2);
  EXPECT_EQ(rig.stay(direction_at(60, 50)).state, HealthState::suspect);
  EXPECT_EQ(rig.stay(direction_at(60, 50)).excluded, SensorSet::of(0));
}

TEST(PaperMonitorLimit, AtOneAttitudeAHealthySensorIsIsolatedForTwoThatAgree) {
  // Sensors 0 and 1 read a gravity turned about the axis of sensor 2: 0, 1 and 2 pass together, 3 is out.
  PaperRig rig(4, 1);
  rig.prove();
  const auto nominal = rig.sheet.array();
  const Vec3 g = scaled(direction_at(30, 50), kG0_mps2);
  const Vec3 turned = calibration_test::turned(g, scaled(nominal->axis(2), rad_from_deg(60)));
  rig.distort = [&](int i, double r) { return i < 2 ? r + dot(nominal->axis(i), minus(turned, g)) : r; };
  rig.stay(direction_at(30, 50));
  EXPECT_EQ(rig.monitor->verdict().excluded, SensorSet::of(3));
  EXPECT_EQ(rig.monitor->verdict().validity, Validity::degraded) << "and the output is called usable";
}

TEST(PaperMonitor, ASuspicionEndsOnlyWhenThePoolIsBelowTheLimitToo) {
  PaperRig rig(4);
  rig.prove();
  rig.distort = [](int i, double r) { return i == 3 ? r + 0.5 * kG0_mps2 : r; };
  const double first = rig.stay(direction_at(20, 0)).mae_all_mps2;
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  rig.distort = [](int, double r) { return r; };
  // One block of `first` and k without error have the mean first / (k + 1).
  const int diluted = static_cast<int>(first / kPaperDeltaF_mps2);
  ASSERT_GT(diluted, 3);
  for (int k = 1; k < diluted + 3; ++k) {
    EXPECT_EQ(rig.stay(direction_at(20, 0)).state, k < diluted + 2 ? HealthState::suspect : HealthState::nominal) << k;
  }
  EXPECT_TRUE(rig.ever_excluded.empty());
  EXPECT_EQ(rig.monitor->verdict().stations_on_record, 1);
  EXPECT_EQ(rig.tour(3).stations_on_record, 0) << "three clean attitudes, and the episode is forgotten";
}

TEST(PaperMonitor, APoolBeginsAnewWithEverySuspicion) {
  PaperRig rig(4);
  rig.prove();
  rig.distort = [](int i, double r) { return i == 3 ? r + 0.5 * kG0_mps2 : r; };
  rig.stay(direction_at(20, 0));
  rig.distort = [](int, double r) { return r; };
  rig.stay(direction_at(20, 0), 20);
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::nominal);
  rig.stick(0, -kG0_mps2);
  for (const double toolface_deg : {0.0, 60.0, 120.0}) rig.stay(direction_at(70, toolface_deg));
  EXPECT_TRUE(rig.ever_excluded.empty()) << "the attitude of the old suspicion does not count";
  EXPECT_EQ(rig.stay(direction_at(70, 180)).excluded, SensorSet::of(0));
}

TEST(PaperMonitor, ASensorThatShakesDoesNotFeignAttitudes) {
  PaperRig rig(4);
  rig.prove();
  calibration_test::Noise noise(9);
  rig.distort = [&noise](int i, double r) { return i == 2 ? noise.within(1.4 * kG0_mps2) : r; };
  rig.stay(direction_at(50, 120), 60);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  EXPECT_EQ(rig.monitor->verdict().scattering, SensorSet::of(2));
  EXPECT_EQ(rig.monitor->finding().triples, 0) << "sixty blocks at one attitude";
}

/// A cubic that passes through zero has no reading there: no vector is shown, and the block is no evidence.
// Negative: REQ-190
TEST(PaperMonitor, AScaleThatVanishesShowsNoVector) {
  Datasheet sheet = paper_test::sheet_of(4);
  for (int i = 0; i < 4; ++i) {
    SensorCoefficients& c = sheet.sensor[static_cast<std::size_t>(i)].coefficients;
    c.scale = {0.25, -0.25 / 64.0, 0.0, 0.0};
    c.bias = {};
    c.reference_degc = 25.0;
  }
  PaperRig rig(sheet, 4, 1);
  rig.setup->base.config.temperature_max_degc = 200.0;
  rig.restart();
  rig.prove();
  const Vec3 before = rig.monitor->verdict().latest_mps2;
  ASSERT_GT(norm(before), 9.0);
  for (int k = 0; k < rig.setup->base.config.window; ++k) {
    Sample s = rig.sample(direction_at(50, 50));
    s.temperature_degc = 25.0 + 64.0;
    rig.step(s);
  }
  const Verdict& v = rig.monitor->verdict();
  EXPECT_TRUE(std::isfinite(norm(v.latest_mps2)));
  EXPECT_EQ(v.latest_mps2, before) << "the last that there was";
}

/// The same attitude again is no further station.
TEST(PaperMonitor, Step10AnAttitudeThatRepeatsDoesNotBringTheFitNearer) {
  PaperRig rig(6);
  rig.prove();
  rig.stick(5, 0.3 * kG0_mps2);
  rig.tour(5);
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::recalibrating);
  for (int k = 0; k < 40; ++k) rig.stay(direction_at(50, 50));
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::recalibrating);
  EXPECT_FALSE(rig.monitor->rest().sound());
  rig.tour(12);
  EXPECT_TRUE(rig.monitor->rest().sound());
}

}  // namespace
}  // namespace paper_monitor_test
