/// The paper's algorithm step by step through the state machine.
#include "plumb/health/paper_monitor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <limits>

#include "health/paper_rig.hpp"

namespace {

using namespace plumb;
using paper_test::at;
using paper_test::direction_at;
using paper_test::PaperRig;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(PaperMonitor, PowersOnUnprovenAndEarnsTrustAtTwoAttitudes) {
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
  EXPECT_EQ(v.transition.event, HealthEvent::culprit);
  EXPECT_EQ(v.transition.from, HealthState::nominal);
  EXPECT_EQ(v.excluded, SensorSet::of(0));
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
      EXPECT_EQ(rig.records.back().event, HealthEvent::culprit);
      EXPECT_EQ(rig.records.back().sensors, SensorSet::of(faulty));
      EXPECT_GE(rig.records.back().statistic, rig.records.back().limit);
      EXPECT_EQ(rig.monitor->finding().passing, 1);
    }
  }
}

TEST(PaperMonitor, Step9TheRestMustHoldOrNobodyIsExcluded) {
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
    EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect) << "unproven";
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
  rig.tour(7);
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::recalibrating);
  rig.stick(4, 0.0);
  rig.tour(1);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  rig.tour(3);
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

TEST(PaperMonitor, TwoFaultsOfFourAreDetectedAndNobodyIsBlamed) {
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
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::failed) << "patience: six attitudes without an answer";
  EXPECT_EQ(rig.records.back().event, HealthEvent::patience_over);
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

TEST(PaperMonitor, ThreeSensorsThatFailTheGateHaveNobodyToBlame) {
  PaperRig rig(3);
  EXPECT_EQ(rig.prove().state, HealthState::degraded_3_sensor);
  rig.stick(0, 0.0);
  rig.tour(4);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  EXPECT_TRUE(rig.ever_excluded.empty());
  EXPECT_EQ(rig.tour(8).state, HealthState::failed);
}

TEST(PaperMonitorLimit, AtOneAttitudeAHealthySensorIsBlamedForTwoThatAgree) {
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
  PaperRig rig(4, 20);
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
}

TEST(PaperMonitor, MotionIsNoEvidenceAndNotPooled) {
  PaperRig rig(4);
  rig.prove();
  rig.stick(2, 0.0);
  rig.tour(1);
  calibration_test::Noise noise(5);
  for (int block = 0; block < 8; ++block) {
    for (int k = 0; k < 32; ++k) {
      const Vec3 d = plus(direction_at(30.0 * block, 20.0 * block), scaled(noise.direction(), 0.1));
      rig.step(rig.sample(scaled(d, 1.0 / norm(d))));
    }
    EXPECT_EQ(rig.monitor->verdict().validity, Validity::held);
    EXPECT_EQ(rig.monitor->verdict().cause, Cause::moving);
  }
  EXPECT_EQ(rig.monitor->finding().triples, 0);
  rig.tour(3);
  EXPECT_EQ(rig.monitor->verdict().excluded, SensorSet::of(2)) << "the pool outlives the motion";
}

TEST(PaperMonitor, ALostChannelIsAbsentAndComesBackExcluded) {
  PaperRig rig(4);
  rig.prove();
  rig.stick(0, kNan);
  EXPECT_EQ(rig.tour(1).state, HealthState::degraded_3_sensor);
  EXPECT_EQ(rig.monitor->verdict().absent, SensorSet::of(0));
  EXPECT_EQ(rig.monitor->verdict().not_finite, SensorSet::of(0));
  rig.distort = [](int, double r) { return r; };
  rig.tour(2);
  EXPECT_EQ(rig.monitor->verdict().absent, SensorSet{});
  EXPECT_EQ(rig.monitor->verdict().excluded, SensorSet::of(0)) << "the paper has no probation";
  rig.stick(1, kNan);
  EXPECT_EQ(rig.tour(1).state, HealthState::failed);
}

TEST(PaperMonitor, AChannelThatDropsMostOfItsSamplesIsLost) {
  PaperRig rig(5);
  rig.prove();
  int count = 0;
  rig.distort = [&count](int i, double r) { return i == 3 && ++count % 3 != 0 ? kNan : r; };
  rig.tour(4);
  EXPECT_EQ(rig.monitor->verdict().absent, SensorSet::of(3));
}

TEST(PaperMonitor, AHugeValueIsAFaultLikeAnyOther) {
  PaperRig rig(4);
  rig.prove();
  rig.stick(2, 0.0);
  for (int k = 0; k < 4; ++k) {
    for (int s = 0; s < 32; ++s) {
      Sample wild = rig.sample(direction_at(25.0 + 30.0 * k, 80.0 * k));
      wild.raw[2] = 1e300;
      rig.step(wild);
    }
  }
  EXPECT_EQ(rig.monitor->verdict().excluded, SensorSet::of(2));
}

TEST(PaperMonitor, FailedIsLatchedUntilTheKeyedReset) {
  PaperRig rig(4);
  rig.prove();
  rig.stick(0, kNan);
  rig.tour(1);
  rig.stick(1, kNan);
  rig.tour(1);
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::failed);
  rig.distort = [](int, double r) { return r; };
  EXPECT_EQ(rig.tour(4).state, HealthState::failed);
  EXPECT_EQ(rig.monitor->reset(1, SensorSet::first(4)).error().code, Errc::wrong_key);
  ASSERT_TRUE(rig.monitor->reset(rig.setup->base.config.reset_key, SensorSet::first(4)).has_value());
  rig.stay(direction_at(30, 30));
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  EXPECT_EQ(rig.monitor->verdict().in_service, SensorSet::first(4));
  EXPECT_EQ(rig.tour(4).state, HealthState::nominal);
}

TEST(PaperMonitor, ResetIsServedThoughTheClockStands) {
  PaperRig rig(4);
  rig.prove();
  rig.stick(0, kNan);
  rig.stick(1, kNan);
  rig.tour(1);
  rig.distort = [](int, double r) { return r; };
  rig.tour(1);
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::failed);
  ASSERT_TRUE(rig.monitor->reset(rig.setup->base.config.reset_key, SensorSet::first(4)).has_value());
  Sample stale = rig.sample(direction_at(30, 30));
  stale.time_s = -1.0;
  rig.step(stale);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  EXPECT_EQ(rig.monitor->verdict().cause, Cause::time_fault);
  EXPECT_FALSE(rig.monitor->verdict().accepted);
}

TEST(PaperMonitor, TimeFaultsAreRefusedAndGapsEmptyTheBlock) {
  PaperRig rig(4);
  rig.prove();
  Sample s = rig.sample(direction_at(30, 30));
  s.time_s = 0.0;
  EXPECT_FALSE(rig.step(s).accepted);
  EXPECT_EQ(rig.monitor->verdict().cause, Cause::time_fault);
  EXPECT_EQ(rig.monitor->verdict().validity, Validity::held);
  for (int k = 0; k < 31; ++k) rig.step(rig.sample(direction_at(30, 30)));
  s = rig.sample(direction_at(30, 30));
  s.time_s += 100.0;
  EXPECT_FALSE(rig.step(s).tick) << "the thirty-second sample, but the gap emptied the block";
  EXPECT_EQ(rig.monitor->verdict().cause, Cause::gap);
}

TEST(PaperMonitor, BeyondTheCalibratedSpanNothingIsJudged) {
  PaperRig rig(4);
  rig.setup->base.config.temperature_min_degc = 20.0;
  rig.setup->base.config.temperature_max_degc = 30.0;
  rig.restart();
  rig.prove();
  rig.stick(2, 0.0);
  for (int k = 0; k < 64; ++k) {
    Sample s = rig.sample(direction_at(45, 200));
    s.temperature_degc = 60.0;
    rig.step(s);
  }
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::nominal);
  EXPECT_EQ(rig.monitor->verdict().cause, Cause::temperature);
  EXPECT_EQ(rig.monitor->verdict().validity, Validity::unconfirmed);
}

TEST(PaperMonitor, AnotherGravityIsTheNewMeasure) {
  PaperRig rig(4);
  rig.prove();
  ASSERT_TRUE(rig.monitor->set_gravity({0.9 * kG0_mps2, 1e-4, GravityModel::value}).has_value());
  EXPECT_EQ(rig.tour(1).state, HealthState::suspect);
  EXPECT_FALSE(rig.monitor->set_gravity({kNan, 1e-4, GravityModel::value}).has_value());
  ASSERT_TRUE(rig.monitor->set_gravity({kG0_mps2, 1e-4, GravityModel::value}).has_value());
  EXPECT_EQ(rig.tour(4).state, HealthState::nominal);
}

TEST(PaperMonitor, AGivenDeltaFIsTheLimit) {
  PaperRig rig(4);
  rig.setup->base.config.delta_f_mps2 = 5e-3 * kG0_mps2;
  rig.restart();
  rig.prove();
  rig.distort = [](int i, double r) { return i == 3 ? r + 0.04 * kG0_mps2 : r; };
  const Verdict& v = rig.tour(8);
  EXPECT_EQ(v.limit, 5e-3 * kG0_mps2);
  EXPECT_EQ(v.excluded, SensorSet::of(3)) << "what 0.05 g0 hides";
}

TEST(PaperMonitor, RefusesASetupThatItCannotUse) {
  PaperRig rig(4);
  const auto refused = [&rig](Errc code, int index) {
    const auto done = rig.monitor->configure(*rig.setup);
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().code, code);
    EXPECT_EQ(done.error().index, index);
    EXPECT_EQ(rig.monitor->step(rig.sample(direction_at(20, 20))).validity, Validity::invalid);
  };
  const PaperSetup good = *rig.setup;
  rig.setup->base.config.mode = MonitorMode::plumb;
  refused(Errc::wrong_mode, 0);
  *rig.setup = good;
  rig.setup->base.config.window = 0;
  refused(Errc::out_of_range, 1);
  *rig.setup = good;
  rig.setup->base.gravity.g_mps2 = kNan;
  refused(Errc::out_of_range, 0);
  *rig.setup = good;
  rig.setup->datasheet.size = 3;
  refused(Errc::not_calibrated, -1);
  *rig.setup = good;
  rig.setup->paper.triples = 3;
  refused(Errc::not_calibrated, -1);
  *rig.setup = good;
  std::swap(rig.setup->paper.triple[0], rig.setup->paper.triple[1]);
  refused(Errc::not_calibrated, -1);
  *rig.setup = good;
  rig.setup->paper.all.rank = 8;
  refused(Errc::not_calibrated, 0);
}

TEST(HealthMonitor, LeavesPaperModeToThePaperMonitor) {
  const PaperRig rig(4);
  const auto monitor = std::make_unique<HealthMonitor>();
  const auto done = monitor->configure(rig.setup->base);
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().code, Errc::wrong_mode);
  EXPECT_NE(std::strstr(remedy(done.error().code), "PaperMonitor"), nullptr);
}

// ---- Laws -----------------------------------------------------------------------------------------

/// Wild values, times, temperatures and dropouts.
Sample wild_sample(calibration_test::Noise& noise, PaperRig& rig) {
  const double specials[] = {kNan, std::numeric_limits<double>::infinity(), 1e308, -1e308, 5e-324, 0.0, 9.8};
  const double angle = 360.0 * noise.uniform();
  Sample s = rig.sample(direction_at(40, noise.uniform() < 0.9 ? 60.0 : angle));
  if (noise.uniform() < 0.02) s.time_s = specials[static_cast<int>(noise.uniform() * 7)];
  if (noise.uniform() < 0.02) s.temperature_degc = specials[static_cast<int>(noise.uniform() * 7)];
  if (noise.uniform() < 0.02) s.count = 0;
  const double wildness = noise.uniform() < 0.7 ? 0.0 : 0.3;
  for (std::size_t i = 0; i < s.raw.size(); ++i) {
    if (noise.uniform() < wildness) s.raw[i] = specials[static_cast<int>(noise.uniform() * 7)];
    if (noise.uniform() < wildness) s.delivered = s.delivered.without(static_cast<int>(i));
  }
  return s;
}

RC_GTEST_PROP(PaperMonitorLaw, IsTotalPartitionsTheSensorsAndReplaysBitForBit, ()) {
  const int n = *rc::gen::inRange(3, 6);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const int cut = *rc::gen::inRange(1, 400);
  calibration_test::Noise noise(seed);
  PaperRig rig(n, 1);
  auto twin = std::make_unique<PaperMonitor>(*rig.monitor);
  for (int k = 0; k < 500; ++k) {
    if (k == cut) *twin = PaperMonitor(*rig.monitor);  // a snapshot is an assignment
    const Sample s = wild_sample(noise, rig);
    const Verdict& v = rig.monitor->step(s);
    const Verdict& w = twin->step(s);
    RC_ASSERT((v.in_service | v.excluded | v.absent) == v.configured);
    RC_ASSERT(v.in_service.size() + v.excluded.size() + v.absent.size() == n);
    for (const double x : v.gravity_mps2) RC_ASSERT(std::isfinite(x));
    for (const double x : v.covariance) RC_ASSERT(std::isfinite(x));
    for (const double x : v.latest_mps2) RC_ASSERT(std::isfinite(x));
    RC_ASSERT(std::isfinite(v.statistic) && std::isfinite(v.parity) && std::isfinite(v.mae_all_mps2));
    if (v.state == HealthState::suspect) RC_ASSERT(v.validity != Validity::valid && v.validity != Validity::degraded);
    if (v.state == HealthState::failed) RC_ASSERT(v.validity == Validity::invalid);
    RC_ASSERT(std::memcmp(&v.gravity_mps2, &w.gravity_mps2, sizeof(Vec3)) == 0);
    RC_ASSERT(std::memcmp(&v.statistic, &w.statistic, sizeof(double)) == 0);
    RC_ASSERT(v.state == w.state && v.in_service == w.in_service && v.validity == w.validity && v.cause == w.cause);
    RC_ASSERT(v.transition.sequence == w.transition.sequence);
  }
}

RC_GTEST_PROP(PaperMonitorLaw, WhatAnExcludedSensorSaysReachesNothing, ()) {
  const int faulty = *rc::gen::inRange(0, 5);
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1000);
  calibration_test::Noise noise(seed);
  PaperRig rig(5, 4, seed);
  rig.prove();
  rig.stick(faulty, 0.4 * kG0_mps2);
  rig.tour(8);
  RC_PRE(rig.monitor->verdict().excluded == SensorSet::of(faulty));
  auto twin = std::make_unique<PaperMonitor>(*rig.monitor);
  for (int k = 0; k < 320; ++k) {
    Sample s = rig.sample(direction_at(30.0 + 10.0 * (k / 32), 50.0 * (k / 32)));
    s.raw[at(faulty)] = 77.0;
    const Verdict v = rig.monitor->step(s);
    s.raw[at(faulty)] = -5e3 * noise.uniform();
    const Verdict& w = twin->step(s);
    RC_ASSERT(v.gravity_mps2 == w.gravity_mps2);
    RC_ASSERT(v.latest_mps2 == w.latest_mps2);
    RC_ASSERT(v.statistic == w.statistic);
    RC_ASSERT(v.parity == w.parity);
    RC_ASSERT(v.state == w.state);
  }
}

/// With one fault of four and pooled attitudes the paper's rule names nobody else.
RC_GTEST_PROP(PaperMonitorLaw, OneStuckSensorOfFourIsNeverBlamedOnAnother, ()) {
  const int faulty = *rc::gen::inRange(0, 4);
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 100000);
  calibration_test::Noise noise(seed);
  const double level = noise.within(kG0_mps2);
  PaperRig rig(4, 4, seed);
  rig.prove();
  rig.stick(faulty, level);
  for (int k = 0; k < 16; ++k) rig.stay(scaled(noise.direction(), 1.0));
  RC_ASSERT(SensorSet::of(faulty).contains(rig.ever_excluded));
}

}  // namespace
