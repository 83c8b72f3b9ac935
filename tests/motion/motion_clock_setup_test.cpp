// What is stated of clocks of chips is checked, and makes the set-up of the monitor.
#include <gtest/gtest.h>

#include <limits>

#include "motion/clocked_motion.hpp"
#include "plumb/motion/motion_clocks.hpp"

// Serves: REQ-207

namespace motion_clock_setup_test {
namespace {

using namespace plumb;
using plumb_test::cone_array;
using plumb_test::one_clock;
using plumb_test::still_setup;

template <class Change>
Error refused(Change change) {
  MotionSetup setup = still_setup();
  setup.gyros = 1;
  ClockSetup clocks = one_clock();
  clocks.clock[0].gyro[0] = true;
  clocks.clocks = 2;
  clocks.clock[1].sensors = SensorSet::of(4);
  change(clocks);
  SensorArray array = cone_array(5, 0.01);
  const MotionSetup before = setup;
  const Expected<void> made = with_clocks(clocks, array, setup);
  if (made) return {};
  EXPECT_EQ(setup.errors[0].lag_s, before.errors[0].lag_s) << "nothing has changed";
  return made.error();
}

TEST(MotionClockSetup, WhatIsStatedIsChecked) {
  EXPECT_EQ(refused([](ClockSetup&) {}), (Error{}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clocks = 0; }), (Error{Errc::out_of_range, 199}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clocks = kMotionClocks + 1; }), (Error{Errc::out_of_range, 199}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clock[1].sensors = SensorSet{}; }), (Error{Errc::out_of_range, 4}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clock[1].sensors = SensorSet::of(3) | SensorSet::of(4); }),
            (Error{Errc::out_of_range, 3}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clock[0].gyro[0] = false; }), (Error{Errc::out_of_range, 150}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clock[1].gyro[0] = true; }), (Error{Errc::out_of_range, 150}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clock[1].sample_period_s = 0.0; }), (Error{Errc::out_of_range, 210}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clock[1].rate = -0.06; }), (Error{Errc::out_of_range, 212}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clock[0].offset_bound_s = -1.0; }), (Error{Errc::out_of_range, 205}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.clock[0].rate_bound = 2e-6; }), (Error{Errc::out_of_range, 207}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.wait_s = 0.004; }), (Error{Errc::out_of_range, 198}));
  EXPECT_EQ(refused([](ClockSetup& c) { c.wait_s = std::numeric_limits<double>::quiet_NaN(); }),
            (Error{Errc::not_finite, 198}));
}

TEST(MotionClockSetup, LagAndNoiseGrowByWhatIsStated) {
  MotionSetup setup = still_setup();
  setup.gyros = 1;
  setup.gyro.noise_radps = 0.01;
  setup.gyro.lag_s = 1e-5;
  setup.errors[4].lag_s = 3e-5;
  ClockSetup clocks = one_clock();
  clocks.clock[0].gyro[0] = true;
  clocks.clock[0].offset_bound_s = 2e-5;
  clocks.clock[0].rate_bound = 1e-7;  // times 1000 s
  clocks.clocks = 2;
  clocks.clock[1].sensors = SensorSet::of(4);
  clocks.clock[1].sample_period_s = 0.0005;
  SensorArray array = cone_array(5, 0.01);
  ASSERT_TRUE(with_clocks(clocks, array, setup).has_value());
  EXPECT_NEAR(setup.errors[0].lag_s, 1.2e-4, 1e-12);
  EXPECT_NEAR(setup.errors[4].lag_s, 3e-5, 1e-12);
  EXPECT_NEAR(setup.gyro.lag_s, 1.3e-4, 1e-12);
  EXPECT_NEAR(array.sigma_mps2(4), 1.34 * 0.01, 1e-12) << "no sample has a part in two instants";
  EXPECT_NEAR(array.sigma_mps2(0), 1.34 * std::sqrt(1.1 + 0.25 / 1.1) * 0.01, 1e-12);
  EXPECT_NEAR(setup.gyro.noise_radps, array.sigma_mps2(0), 1e-12);
}

}  // namespace
}  // namespace motion_clock_setup_test
