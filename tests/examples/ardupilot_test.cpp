// The adapter to ArduPilot: which instances its lanes read, whether it may arm, and the force as an external IMU.
#include "navigation/ardupilot.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "motion_verdicts.hpp"
#include "navigation/stub/ardupilot_ins.hpp"

namespace ardupilot_test {
namespace {

using example_test::any_verdict;
using example_test::flying;
using example_test::kChipAxes;
using plumb::SensorSet;

struct Vehicle {
  AP_InertialSensor ins{3};
  AP_Arming arming;
  std::uint8_t killed = 0;
  Vehicle() { ins.update(); }
  void step(const plumb::MotionVerdict& v) {
    killed = plumb_ardupilot::apply(ins, killed, v, kChipAxes);
    ins.update();
    plumb_ardupilot::authorise(arming, 0, v, kChipAxes);
  }
  /// The accelerometer of a lane of EKF3.
  std::uint8_t lane(std::uint8_t i) const { return ins.use_accel(i) ? i : ins.get_first_usable_accel(); }
};

plumb::MotionVerdict excluding(SensorSet axes) {
  plumb::MotionVerdict v = flying();
  v.excluded = axes;
  v.sample.used = v.sample.used - axes;
  return v;
}

TEST(ArduPilot, healthyInstancesStayInTheirLanesAndItMayArm) {
  Vehicle vehicle;
  vehicle.step(flying());
  for (std::uint8_t i = 0; i < 3; ++i) EXPECT_EQ(vehicle.lane(i), i);
  EXPECT_TRUE(vehicle.ins.get_accel_health_all());
  EXPECT_TRUE(vehicle.arming.passed);
}

TEST(ArduPilot, theLaneOfAFaultyInstanceReadsAnother) {
  Vehicle vehicle;
  vehicle.step(excluding(SensorSet::of(1)));  // one axis of the first
  EXPECT_EQ(vehicle.lane(0), 1);
  EXPECT_EQ(vehicle.lane(2), 2);
  EXPECT_FALSE(vehicle.ins.get_accel_health_all());
  EXPECT_FALSE(vehicle.arming.passed);
  EXPECT_EQ(vehicle.arming.message, std::string("accelerometer isolated"));
}

TEST(ArduPilot, doubtTakesNobodyOutGivesNobodyBackAndForbidsArming) {
  Vehicle vehicle;
  vehicle.step(excluding(kChipAxes[2]));
  plumb::MotionVerdict v = flying();
  v.alarm = true;
  v.cause = plumb::MotionCause::parity;
  v.suspects = SensorSet::first(9);
  vehicle.step(v);
  EXPECT_EQ(vehicle.lane(0), 0);
  EXPECT_EQ(vehicle.lane(2), 0);
  EXPECT_EQ(vehicle.killed, 0b100);
  EXPECT_FALSE(vehicle.arming.passed);
  EXPECT_EQ(vehicle.arming.message, std::string(plumb::to_string(plumb::MotionCause::parity)));
  v.cause = plumb::MotionCause::none;
  v.alarm = false;
  v.sample.validity = plumb::ForceValidity::none;
  vehicle.step(v);
  EXPECT_EQ(vehicle.arming.message, std::string("no bounded force"));
  vehicle.step(flying());  // rest has reinstated it
  EXPECT_EQ(vehicle.lane(2), 2);
  EXPECT_EQ(vehicle.killed, 0);
}

TEST(ArduPilot, whatAPilotSwitchedOffStaysOff) {
  Vehicle vehicle;
  vehicle.ins.kill_imu(1, true);
  vehicle.step(flying());
  EXPECT_FALSE(vehicle.ins.use_accel(1));
  EXPECT_EQ(vehicle.killed, 0);
}

TEST(ArduPilot, theLastUsableInstanceStaysAndItMayNotArm) {
  Vehicle vehicle;
  vehicle.step(excluding(SensorSet::first(9)));
  int usable = 0;
  for (std::uint8_t i = 0; i < 3; ++i) usable += vehicle.ins.use_accel(i) ? 1 : 0;
  EXPECT_EQ(usable, 1);
  EXPECT_FALSE(vehicle.arming.passed);
}

TEST(ArduPilot, theForceIsAnExternalImuWhereItIsBounded) {
  ins_data_message_t out{};
  out.gyro.x = 0.5F;
  ASSERT_TRUE(plumb_ardupilot::fill(out, flying()));
  EXPECT_EQ(out.accel.z, -9.75F);
  EXPECT_EQ(out.gyro.x, 0.5F);
  plumb::MotionVerdict v = flying();
  v.sample.validity = plumb::ForceValidity::unchecked;
  EXPECT_FALSE(plumb_ardupilot::fill(out, v));
}

RC_GTEST_PROP(ArduPilotLaw, NoLaneReadsAFaultyInstanceWhileAnotherIsUsable, ()) {
  Vehicle vehicle;
  for (int k = *rc::gen::inRange(1, 40); k > 0; --k) {
    const plumb::MotionVerdict v = any_verdict();
    vehicle.step(v);
    vehicle.step(v);  // one that the first step gave back makes room for another to be taken out
    int usable = 0, faulty = 0;
    for (std::uint8_t i = 0; i < 3; ++i) {
      usable += vehicle.ins.use_accel(i) ? 1 : 0;
      faulty += vehicle.ins.use_accel(i) && !((v.isolated | v.excluded) & kChipAxes[i]).empty() ? 1 : 0;
    }
    RC_ASSERT(usable >= 1);
    RC_ASSERT(faulty == 0 || usable == 1);
  }
}

RC_GTEST_PROP(ArduPilotLaw, ItMayArmOnlyWhereEveryInstanceIsInABoundedForce, ()) {
  Vehicle vehicle;
  const plumb::MotionVerdict v = any_verdict();
  vehicle.step(v);
  RC_CLASSIFY(vehicle.arming.passed, "armed");
  RC_ASSERT(!vehicle.arming.passed ||
            (v.sample.validity == plumb::ForceValidity::bounded && v.cause == plumb::MotionCause::none &&
             v.sample.used == SensorSet::first(9) && (v.isolated | v.excluded | v.suspects).empty()));
  RC_ASSERT(vehicle.arming.passed || std::string(vehicle.arming.message).size() <= 42);
}

RC_GTEST_PROP(ArduPilotLaw, WhatIsHandedOverIsANumberOfABoundedForce, ()) {
  ins_data_message_t out{};
  const plumb::MotionVerdict v = any_verdict();
  RC_CLASSIFY(plumb_flight::told(v) == plumb_flight::Told::healthy, "healthy");
  const bool handed_over = plumb_ardupilot::fill(out, v);
  RC_ASSERT(!handed_over || v.sample.validity == plumb::ForceValidity::bounded);
  RC_ASSERT(std::isfinite(out.accel.x) && std::isfinite(out.accel.y) && std::isfinite(out.accel.z));
}

}  // namespace
}  // namespace ardupilot_test
