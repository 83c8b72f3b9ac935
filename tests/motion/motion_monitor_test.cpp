// The monitor in motion: who is isolated and excluded, when nobody is, and the bound of the published force.
#include "plumb/motion/motion_monitor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <limits>
#include <type_traits>

#include "motion/motion_flight.hpp"

// Serves: REQ-204, REQ-205, REQ-209

namespace motion_monitor_test {
namespace {

using namespace plumb;
using plumb_test::add_bias_from;
using plumb_test::cone_array;
using plumb_test::Flight;
using plumb_test::motion_setup;
using plumb_test::slow_setup;

static_assert(std::is_trivially_copyable_v<MotionMonitor>);

// Negative: REQ-205
TEST(MotionMonitor, WhatIsNotJudgedIsNeverSaidToBeWithoutContradiction) {
  for (const int shortest : {1, 32}) {
    MotionSetup setup = motion_setup(5, 3);
    setup.shortest_block = shortest;
    Flight begun(cone_array(5, 0.01), setup, 3);
    begun.fly(0, shortest == 1 ? 2 : 64);
    EXPECT_EQ(begun.monitor.verdict().cause, MotionCause::irregular_time) << "no two blocks yet, " << shortest;
    begun.fly(shortest == 1 ? 2 : 64, 200);
    EXPECT_EQ(begun.monitor.verdict().cause, MotionCause::none) << shortest;
    begun.monitor.set_in_service(SensorSet::first(3));
    begun.fly(200, 239);
    EXPECT_EQ(begun.monitor.verdict().cause, MotionCause::no_redundancy) << "three sensors are left, " << shortest;
    begun.monitor.set_in_service(SensorSet::first(5));
    begun.distort = [](MotionSample& s) { s.delivered = SensorSet::first(3); };
    begun.fly(239, 339);
    EXPECT_EQ(begun.monitor.verdict().cause, MotionCause::no_redundancy) << "three deliver, " << shortest;
    setup.rate_bound_radps = 0.0;
    Flight blind(cone_array(5, 0.01), setup, 3);
    blind.distort = [](MotionSample& s) { s.rate_given = {}; };
    for (std::uint64_t k = 0; k < 300; ++k) {
      blind.fly(k, k + 1);
      EXPECT_NE(blind.monitor.verdict().cause, MotionCause::none) << k << ", " << shortest;
    }
    EXPECT_EQ(blind.monitor.verdict().cause, MotionCause::rotation_unknown);
  }
}

/// The same fault in blocks of other lengths: longer ones find what is smaller.
TEST(MotionMonitor, JudgesBlocksOfTheStatedLengths) {
  const auto isolated = [](const BlockSamples& blocks, double bias_mps2) {
    MotionSetup setup = motion_setup(6, 3);
    setup.gyros = 2;
    setup.block_samples = blocks;
    Flight flight(cone_array(6, 1.0), setup, 3);
    flight.fly(0, 6000);
    EXPECT_TRUE(flight.ever_excluded.empty());
    EXPECT_FALSE(flight.monitor.verdict().alarm);
    EXPECT_GT(flight.bounded, 0);
    EXPECT_NEAR(flight.monitor.verdict().block.span_s, blocks[2] * setup.sample_period_s, 1e-9);
    flight.distort = [&](MotionSample& s) { s.reading_mps2[4] += bias_mps2; };
    flight.fly(6000, 14000);
    return flight.ever_excluded;
  };
  EXPECT_TRUE(isolated({1, 3, 12, 60}, 6.0) == SensorSet::of(4));
  EXPECT_TRUE(isolated({1, 2, 4, 8}, 2.0).empty());
  EXPECT_TRUE(isolated({1, 10, 100, 1000}, 2.0) == SensorSet::of(4));
}

/// As a clock of its own makes of vibration: two samples up and two down, for which no lag accounts.
TEST(MotionMonitor, BlocksBelowTheShortestAreNotJudged) {
  for (const int shortest : {1, 32}) {
    MotionSetup setup = motion_setup(6, 3);
    setup.shortest_block = shortest;
    setup.gyro_corroborated = true;
    Flight flight(cone_array(6, 0.01), setup, 3);
    bool alarmed = false;
    flight.distort = [&, k = 0](MotionSample& s) mutable {
      alarmed = alarmed || flight.monitor.verdict().alarm;
      s.reading_mps2[2] += ++k % 4 < 2 ? 5.0 : -5.0;
    };
    flight.fly(0, 700);
    EXPECT_EQ(alarmed, shortest == 1);
    EXPECT_EQ(flight.bounded > 0, shortest == 1) << "no force of two samples";
    if (shortest == 1) continue;
    EXPECT_EQ(flight.monitor.verdict().block.validity, ForceValidity::bounded);
    flight.distort = [](MotionSample& s) { s.reading_mps2[4] += 1.0; };
    flight.fly(700, 1400);
    EXPECT_TRUE(flight.ever_excluded == SensorSet::of(4));
  }
}

// Verifies: REQ-205
RC_GTEST_PROP(MotionMonitorLaw, HealthyFlightsRaiseNoAlarmAndKeepTheirBound, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  const std::uint64_t seed = *rc::gen::arbitrary<std::uint32_t>();
  Flight flight(cone_array(n, 0.01), motion_setup(n, seed), seed);
  flight.motion.draw_errors(*rc::gen::arbitrary<bool>());
  flight.fly(0, 700);
  RC_ASSERT(!flight.monitor.verdict().alarm);
  RC_ASSERT(flight.ever_isolated.empty() && flight.ever_excluded.empty());
  RC_ASSERT(flight.bounded == flight.samples - 2);
  RC_ASSERT(flight.worst_ratio < 1.0);
}

RC_GTEST_PROP(MotionMonitorLaw, OneFaultIsolatesNoOtherSensorAndTheBoundHoldsThroughout, ()) {
  const int n = *rc::gen::inRange(5, kCapacity + 1);
  const std::uint64_t seed = *rc::gen::arbitrary<std::uint32_t>();
  MotionSetup setup = slow_setup(n, seed);
  setup.gyros = *rc::gen::inRange(0, kGyros + 1);
  Flight flight(cone_array(n, 0.01), setup, seed);
  flight.motion.draw_errors(*rc::gen::arbitrary<bool>());
  const int sensor = *rc::gen::inRange(0, n);
  const double bias = *rc::gen::element(0.02, 0.1, 0.3, 1.0, 5.0, 30.0) * *rc::gen::element(-1.0, 1.0);
  add_bias_from(flight, 0.3, sensor, bias);
  flight.fly(0, 1500);
  RC_ASSERT(SensorSet::of(sensor).contains(flight.ever_isolated | flight.ever_excluded));
  RC_ASSERT(flight.worst_ratio < 1.0);
}

TEST(MotionMonitor, IsolatesAndExcludesAFaultOfATenthOfG) {
  for (int n = 5; n <= kCapacity; ++n) {
    for (int sensor = 0; sensor < n; ++sensor) {
      MotionSetup setup = motion_setup(n, 3);
      setup.gyros = 2;
      Flight flight(cone_array(n, 0.01), setup, static_cast<std::uint64_t>(n));
      add_bias_from(flight, 0.3, sensor, 0.1 * kG0_mps2);
      flight.fly(0, 1200);
      EXPECT_EQ(flight.ever_excluded, SensorSet::of(sensor)) << n;
      EXPECT_EQ(flight.monitor.verdict().excluded, SensorSet::of(sensor)) << n;
      EXPECT_LT(flight.isolated_at_s, 0.3 + 0.6) << n;
      EXPECT_FALSE(flight.monitor.verdict().sample.used.has(sensor));
      EXPECT_LT(flight.worst_ratio, 1.0);
    }
  }
}

TEST(MotionMonitor, FourSensorsDetectAndIsolateNone) {
  Flight flight(cone_array(4, 0.01), slow_setup(4, 3), 4);
  add_bias_from(flight, 0.3, 1, 2.0);
  flight.fly(0, 800);
  EXPECT_TRUE(flight.monitor.verdict().alarm);
  EXPECT_TRUE(flight.ever_isolated.empty());
  EXPECT_EQ(flight.monitor.verdict().cause, MotionCause::parity);
  EXPECT_LT(flight.worst_ratio, 1.0) << "bounded, not silent";
  EXPECT_GT(flight.bounded, 700);
}

/// Eight sensors on four chips of two: one axis fails, its chip goes.
// Verifies: REQ-209
TEST(MotionMonitor, AChipIsExcludedWhole) {
  MotionSetup setup = motion_setup(8, 3);
  setup.gyros = 2;
  Flight flight(plumb_test::in_chips(cone_array(8, 0.01), 2), setup, 3);
  add_bias_from(flight, 0.3, 4, 2.0);
  flight.fly(0, 900);
  EXPECT_EQ(flight.ever_isolated, SensorSet(0b00110000));
  EXPECT_EQ(flight.ever_excluded, SensorSet(0b00110000));
  EXPECT_LT(flight.worst_ratio, 1.0);
}

// Negative: REQ-205
TEST(MotionMonitor, WithoutRotationNothingIsJudged) {
  MotionSetup setup = motion_setup(5);
  setup.gyros = 0;
  setup.rate_bound_radps = 0.0;
  Flight flight(cone_array(5, 0.01), setup, 1);
  add_bias_from(flight, 0.0, 1, 50.0);
  flight.fly(0, 100);
  EXPECT_EQ(flight.monitor.verdict().cause, MotionCause::rotation_unknown);
  EXPECT_EQ(flight.monitor.verdict().sample.validity, ForceValidity::none);
  EXPECT_FALSE(flight.monitor.verdict().alarm);
}

TEST(MotionMonitor, ForgetsWhatDoesNotComeBack) {
  Flight flight(cone_array(4, 0.01), slow_setup(4, 3), 4);
  flight.distort = [](MotionSample& s) {
    if (s.time_s > 0.3 && s.time_s < 0.4) s.reading_mps2[0] += 5.0;
  };
  flight.fly(0, 5000);
  EXPECT_TRUE(flight.monitor.verdict().alarm);
  flight.fly(5000, 6500);
  EXPECT_FALSE(flight.monitor.verdict().alarm);
}

TEST(MotionMonitor, TakesExclusionsBackWhenTold) {
  Flight flight(cone_array(6, 0.01), slow_setup(6, 3), 4);
  add_bias_from(flight, 0.3, 0, 5.0);
  flight.fly(0, 900);
  ASSERT_EQ(flight.monitor.verdict().excluded, SensorSet::of(0));
  flight.distort = [](MotionSample&) {};
  flight.monitor.forget();
  flight.fly(900, 1000);
  EXPECT_TRUE(flight.monitor.verdict().excluded.empty());
  EXPECT_EQ(flight.monitor.verdict().sample.used, SensorSet::first(6));
  flight.monitor.set_in_service(SensorSet::first(5));
  flight.fly(1000, 1010);
  EXPECT_EQ(flight.monitor.verdict().sample.used, SensorSet::first(5));
}

/// A reading that no accelerometer makes is none: its square would widen the limits of its own sets without end.
// Negative: REQ-209
TEST(MotionMonitor, AReadingBeyondAllAccelerometersIsNone) {
  for (const double garbage : {2e4, 1e6, 1e100, -1e308}) {
    MotionSetup setup = motion_setup(6, 3);
    setup.gyros = 2;
    Flight flight(cone_array(6, 0.01), setup, 4);
    flight.distort = [garbage](MotionSample& s) {
      if (s.time_s >= 0.3) s.reading_mps2[4] = garbage;
    };
    flight.fly(0, 600);
    EXPECT_FALSE(flight.monitor.verdict().sample.used.has(4)) << garbage;
    EXPECT_EQ(flight.monitor.verdict().sample.validity, ForceValidity::bounded) << garbage;
    EXPECT_LT(flight.monitor.verdict().sample.bound_mps2, 20.0) << garbage;
    EXPECT_LT(flight.worst_ratio, 1.0) << garbage;
  }
}

/// Two units that fail within one sample: no single unit explains what is on record, so there is no bound, at once.
// Negative: REQ-205
TEST(MotionMonitor, TwoFaultsInOneSampleHaveNoBoundBeforeTheyAreIsolated) {
  MotionSetup setup = motion_setup(8, 3);
  setup.gyros = 2;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Flight flight(cone_array(8, 0.01), setup, seed);
    flight.distort = [](MotionSample& s) {
      if (s.time_s < 0.3) return;
      s.reading_mps2[1] += 80.0;
      s.reading_mps2[4] += 60.0;
    };
    flight.fly(0, 600);
    EXPECT_LT(flight.worst_ratio, 1.0) << seed;
  }
}

/// A host whose clock begins anew loses the window, not the evidence, and a fault is excluded all the same.
TEST(MotionMonitor, AClockThatBeginsAnewDelaysNoExclusion) {
  MotionSetup setup = motion_setup(6, 3);
  setup.gyros = 2;
  Flight flight(cone_array(6, 0.01), setup, 4);
  double shift_s = 1e6;
  flight.distort = [&shift_s](MotionSample& s) {
    s.time_s += shift_s;
    s.reading_mps2[0] += 5.0;
  };
  flight.fly(0, 30);
  EXPECT_TRUE(flight.monitor.verdict().alarm);
  shift_s = 0.0;
  flight.fly(30, 400);
  EXPECT_EQ(flight.monitor.verdict().excluded, SensorSet::of(0));
}

/// Samples that do not come at the stated period are never judged, and the cause says so.
TEST(MotionMonitor, AnotherPeriodThanStatedIsReported) {
  MotionSetup setup = motion_setup(6, 3);
  Flight flight(cone_array(6, 0.01), setup, 4);
  flight.distort = [](MotionSample& s) { s.time_s *= 4.0; };
  flight.fly(0, 100);
  EXPECT_EQ(flight.monitor.verdict().cause, MotionCause::irregular_time);
  EXPECT_EQ(flight.bounded, 0);
}

/// A period that is stated wrong by a quarter: time stamps count, so that the angular acceleration is right all the
/// same.
TEST(MotionMonitor, TimeStampsCountNotTheStatedPeriod) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    MotionSetup setup = motion_setup(6, seed);
    setup.gyros = 2;
    setup.sample_period_s = 0.00125;
    Flight flight(cone_array(6, 0.001), setup, seed);
    MotionSetup stated = setup;
    stated.sample_period_s = 0.001;
    ASSERT_TRUE(flight.monitor.configure(flight.array, stated).has_value());
    flight.fly(0, 400);
    EXPECT_FALSE(flight.monitor.verdict().alarm) << seed;
    EXPECT_LT(flight.worst_ratio, 1.0) << seed;
    EXPECT_EQ(flight.bounded, 398) << seed;
  }
}

TEST(MotionMonitor, ThreeSensorsHaveAForceAndNoCheck) {
  AxisList axes{};
  for (std::size_t i = 0; i < 3; ++i) axes[i][i] = 1.0;
  Flight flight(plumb_test::make_array(axes, 3, 0.01), motion_setup(3, 3), 4);
  flight.fly(0, 100);
  EXPECT_EQ(flight.monitor.verdict().sample.validity, ForceValidity::unchecked);
  EXPECT_EQ(flight.monitor.verdict().cause, MotionCause::no_redundancy);
}

/// Whoever is isolated leaves the force at once; what else may have failed is in its bound, whose largest part has a
/// name.
TEST(MotionMonitor, TheBoundNamesItsLargestPart) {
  MotionSetup setup = motion_setup(6, 3);
  setup.gyros = 2;
  Flight flight(cone_array(6, 0.01), setup, 4);
  add_bias_from(flight, 0.3, 0, 5.0);
  flight.fly(0, 310);
  EXPECT_EQ(flight.monitor.verdict().isolated, SensorSet::of(0));
  EXPECT_TRUE(flight.monitor.verdict().excluded.empty());
  EXPECT_FALSE(flight.monitor.verdict().sample.used.has(0));
  flight.fly(310, 900);
  EXPECT_LT(flight.worst_ratio, 1.0);
  EXPECT_NE(flight.monitor.verdict().block.dominant, ForceTerm::fault);
  Flight four(cone_array(4, 0.01), slow_setup(4, 3), 4);
  add_bias_from(four, 0.3, 1, 20.0);
  four.fly(0, 800);
  EXPECT_EQ(four.monitor.verdict().block.dominant, ForceTerm::fault);
  EXPECT_STREQ(to_string(four.monitor.verdict().block.dominant), "undetected fault");
  EXPECT_STREQ(to_string(four.monitor.verdict().block.validity), "bounded");
}

/// A channel that is missing for a while costs the channel, not the force.
TEST(MotionMonitor, GoesOnWithoutAMissingChannel) {
  Flight flight(cone_array(6, 0.01), slow_setup(6, 3), 4);
  flight.distort = [](MotionSample& s) {
    if (s.time_s > 0.3) s.delivered = s.delivered.without(4);
  };
  flight.fly(0, 900);
  EXPECT_EQ(flight.bounded, 898);
  EXPECT_FALSE(flight.monitor.verdict().sample.used.has(4));
  EXPECT_FALSE(flight.monitor.verdict().alarm);
}

RC_GTEST_PROP(MotionMonitorLaw, EveryBitPatternIsTakenAndReplaysBitForBit, ()) {
  const int n = *rc::gen::inRange(3, kCapacity + 1);
  MotionSetup setup = motion_setup(n);
  setup.gyros = *rc::gen::inRange(0, kGyros + 1);
  MotionMonitor first, second;
  RC_ASSERT(first.configure(cone_array(n, 0.01), setup).has_value());
  RC_ASSERT(second.configure(cone_array(n, 0.01), setup).has_value());
  plumb_test::Noise noise(*rc::gen::arbitrary<std::uint32_t>());
  const std::array<double, 8> bad{0.0,
                                  -0.0,
                                  1e308,
                                  -1e308,
                                  5e-324,
                                  std::numeric_limits<double>::quiet_NaN(),
                                  std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()};
  const auto some = [&] {
    return noise.uniform() < 0.1 ? bad[static_cast<std::size_t>(8.0 * noise.uniform())] : 20.0 * noise.normal();
  };
  for (int k = 0; k < 200; ++k) {
    MotionSample s;
    s.time_s = noise.uniform() < 0.02 ? some() : k * setup.sample_period_s;
    for (double& y : s.reading_mps2) y = some();
    for (Vec3& w : s.rate_radps) w = {some(), some(), some()};
    s.rate_given = {noise.uniform() < 0.9, noise.uniform() < 0.9};
    s.delivered = SensorSet(static_cast<std::uint32_t>(4294967295.0 * noise.uniform()));
    s.clipped =
        noise.uniform() < 0.1 ? SensorSet(static_cast<std::uint32_t>(4294967295.0 * noise.uniform())) : SensorSet{};
    const MotionVerdict& a = first.step(s);
    const MotionVerdict& b = second.step(s);
    RC_ASSERT(a.isolated == b.isolated && a.excluded == b.excluded && a.cause == b.cause);
    RC_ASSERT(std::memcmp(&a.sample.force_mps2, &b.sample.force_mps2, sizeof a.sample.force_mps2) == 0);
    RC_ASSERT(std::memcmp(&a.sample.bound_mps2, &b.sample.bound_mps2, sizeof a.sample.bound_mps2) == 0);
    if (a.sample.validity != ForceValidity::none)
      RC_ASSERT(std::isfinite(a.sample.bound_mps2) && a.sample.bound_mps2 > 0.0);
  }
}

TEST(MotionMonitor, RefusesWhatItCannotUse) {
  MotionMonitor monitor;
  const auto refused = [&](const SensorArray& array, const std::function<void(MotionSetup&)>& spoil) {
    MotionSetup setup = motion_setup(array.size());
    spoil(setup);
    const Expected<void> answer = monitor.configure(array, setup);
    return answer ? Error{} : answer.error();
  };
  const SensorArray five = cone_array(5, 0.01);
  EXPECT_EQ(refused(five, [](MotionSetup&) {}), Error{});
  EXPECT_EQ(refused(SensorArray{}, [](MotionSetup&) {}).code, Errc::too_few_sensors);
  EXPECT_EQ(refused(five, [](MotionSetup& s) { s.errors[3].lag_s = -1.0; }), (Error{Errc::out_of_range, 3}));
  EXPECT_EQ(refused(five, [](MotionSetup& s) { s.lever_arm_m[2][1] = std::nan(""); }), (Error{Errc::not_finite, 2}));
  EXPECT_EQ(refused(five, [](MotionSetup& s) { s.shortest_block = 0; }), (Error{Errc::out_of_range, 113}));
  EXPECT_EQ(refused(five, [](MotionSetup& s) { s.sample_period_s = 0.0; }), (Error{Errc::out_of_range, 100}));
  EXPECT_EQ(refused(five, [](MotionSetup& s) { s.gyros = 3; }), (Error{Errc::out_of_range, 101}));
  EXPECT_EQ(refused(five, [](MotionSetup& s) { s.gyro.lag_s = std::nan(""); }), (Error{Errc::not_finite, 106}));
  EXPECT_EQ(refused(five, [](MotionSetup& s) { s.max_faults = 9; }), (Error{Errc::out_of_range, 112}));
  EXPECT_EQ(refused(five, [](MotionSetup& s) { s.shortest_block = 33; }), (Error{Errc::out_of_range, 113}));
  const std::pair<BlockSamples, int> spoilt[] = {{{2, 4, 32, 256}, 114},  {{1, 1, 32, 256}, 115},
                                                 {{1, 4, 30, 256}, 116},  {{1, 4, 32, 32}, 117},
                                                 {{1, 4, 32, 4128}, 117}, {{1, 4, -8, 256}, 116}};
  for (const auto& [blocks, index] : spoilt) {
    EXPECT_EQ(refused(five, [&blocks = blocks](MotionSetup& s) { s.block_samples = blocks; }),
              (Error{Errc::out_of_range, index}));
  }
}

TEST(MotionMonitor, ThatWasNeverConfiguredSaysNothing) {
  MotionMonitor monitor;
  const MotionVerdict& v = monitor.step(MotionSample{});
  EXPECT_EQ(v.sample.validity, ForceValidity::none);
  EXPECT_TRUE(v.isolated.empty());
}

}  // namespace
}  // namespace motion_monitor_test
