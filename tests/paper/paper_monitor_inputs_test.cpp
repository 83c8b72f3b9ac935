/// Paper mode under bad input: motion, lost channels, time, temperature, resets, setups.
#include "plumb/paper/paper_monitor.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "paper/paper_rig.hpp"

// Serves: REQ-190

namespace paper_monitor_inputs_test {
namespace {

using namespace plumb;
using paper_test::direction_at;
using paper_test::PaperRig;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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
  EXPECT_EQ(rig.tour(1).validity, Validity::held) << "a block with a third of the samples is no evidence";
  rig.tour(3);
  EXPECT_EQ(rig.monitor->verdict().absent, SensorSet::of(3));
}

TEST(PaperMonitor, AnAlarmIsNotLostBehindALostChannel) {
  PaperRig rig(5);
  rig.prove();
  rig.stick(3, 3.0 * kG0_mps2);
  for (int k = 0; k < 32; ++k) {
    Sample s = rig.sample(direction_at(40, 200));
    if (k >= 29) s.raw[0] = kNan;  // confirmed with the last sample of the block
    rig.step(s);
  }
  EXPECT_EQ(rig.monitor->verdict().transition.event, HealthEvent::channel_lost);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::isolated);
  rig.step(rig.sample(direction_at(40, 200)));
  EXPECT_EQ(rig.monitor->verdict().transition.event, HealthEvent::alarm);
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::suspect);
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

TEST(PaperMonitor, ResetIsServedThoughTheClockIsStopped) {
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
  rig.setup->base.config.delta_f_mps2 = 0.02 * kG0_mps2;
  rig.restart();
  rig.prove();
  ASSERT_TRUE(rig.monitor->set_gravity({0.97 * kG0_mps2, 1e-4, GravityModel::value}).has_value());
  EXPECT_EQ(rig.tour(1).state, HealthState::suspect);
  EXPECT_FALSE(rig.monitor->set_gravity({kNan, 1e-4, GravityModel::value}).has_value());
  ASSERT_TRUE(rig.monitor->set_gravity({kG0_mps2, 1e-4, GravityModel::value}).has_value());
  EXPECT_EQ(rig.tour(4).state, HealthState::nominal);
  rig.stick(2, 0.0);
  rig.tour(3);
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::suspect);
  ASSERT_TRUE(rig.monitor->set_gravity({1.0001 * kG0_mps2, 1e-4, GravityModel::value}).has_value());
  rig.tour(3);
  EXPECT_TRUE(rig.ever_excluded.empty()) << "errors against two gravities are not pooled";
  EXPECT_EQ(rig.tour(1).excluded, SensorSet::of(2));
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
  refused(Errc::implausible_gravity, 0);
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

}  // namespace
}  // namespace paper_monitor_inputs_test
