// The delta velocity for PX4: the bounded force times the time between its samples, once, with the stamps of EKF2.
#include "navigation/px4_imu.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "motion_verdicts.hpp"
#include "navigation/stub/px4_messages.hpp"

namespace px4_imu_test {
namespace {

using example_test::any_verdict;
using example_test::flying;

TEST(Px4Imu, isTheForceTimesTheTimeBetweenItsSamples) {
  vehicle_imu_s out{};
  out.delta_angle[1] = 0.25F;
  out.delta_velocity_clipping = 7;
  ASSERT_TRUE(plumb_px4::fill(out, flying().sample));
  EXPECT_EQ(out.timestamp_sample, 12250000U);  // the newer of the two samples; the force is of 12.2495 s
  EXPECT_EQ(out.timestamp, 12250000U);
  EXPECT_EQ(out.delta_velocity_dt, 1000);
  EXPECT_FLOAT_EQ(out.delta_velocity[0], 0.5e-3F);
  EXPECT_FLOAT_EQ(out.delta_velocity[2], -9.75e-3F);
  EXPECT_EQ(out.delta_velocity_clipping, 0);
  EXPECT_EQ(out.delta_angle[1], 0.25F);  // the gyro's is not plumb's
  EXPECT_FALSE(plumb_px4::fill(out, flying().sample)) << "the same interval twice";
}

TEST(Px4Imu, blocksFitToo) {
  vehicle_imu_s out{};
  plumb::SpecificForce block = flying().sample;
  block.span_s = 0.032;
  ASSERT_TRUE(plumb_px4::fill(out, block));
  EXPECT_EQ(out.delta_velocity_dt, 32000);
  EXPECT_FLOAT_EQ(out.delta_velocity[2], -9.75F * 0.032F);
  block.time_s += 1.0;
  block.span_s = 0.0656;  // 65600 us: more than the field holds
  EXPECT_FALSE(plumb_px4::fill(out, block));
}

TEST(Px4Imu, onlyABoundedForceIsPublished) {
  for (const auto validity : {plumb::ForceValidity::none, plumb::ForceValidity::unchecked}) {
    vehicle_imu_s out{};
    plumb::SpecificForce force = flying().sample;
    force.validity = validity;
    EXPECT_FALSE(plumb_px4::fill(out, force));
    EXPECT_EQ(out.timestamp_sample, 0U);
  }
  vehicle_imu_s out{};
  plumb::SpecificForce force = flying().sample;
  force.bound_mps2 = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(plumb_px4::fill(out, force));
}

RC_GTEST_PROP(Px4ImuLaw, WhatIsPublishedIsBoundedFiniteAndNewer, ()) {
  vehicle_imu_s out{};
  bool any = false;
  for (int k = *rc::gen::inRange(1, 40); k > 0; --k) {
    const plumb::MotionVerdict v = any_verdict();
    const vehicle_imu_s before = out;
    const bool published = plumb_px4::fill(out, v.sample);
    any = any || published;
    if (!published) {
      RC_ASSERT(out.timestamp_sample == before.timestamp_sample && out.delta_velocity[0] == before.delta_velocity[0]);
      continue;
    }
    RC_ASSERT(v.sample.validity == plumb::ForceValidity::bounded && out.timestamp_sample > before.timestamp_sample);
    RC_ASSERT(out.delta_velocity_dt > 0);
    for (const float x : out.delta_velocity) RC_ASSERT(std::isfinite(x));
  }
  RC_CLASSIFY(any, "any");
}

}  // namespace
}  // namespace px4_imu_test
