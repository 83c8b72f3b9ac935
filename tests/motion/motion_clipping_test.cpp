// Readings at full scale in motion count as inequalities: what is beyond them accuses nobody, what is short of them
// does.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "motion/rigid_motion.hpp"
#include "plumb/motion/motion_monitor.hpp"
#include "plumb/motion/motion_parity.hpp"

// Serves: REQ-212

namespace motion_clipping_test {
namespace {

using namespace plumb;
using plumb_test::cone_array;
using plumb_test::motion_setup;
using plumb_test::RigidMotion;

/// Sensors with a full scale, and what the monitor says of them.
struct Flight {
  Flight(SensorArray array_, const MotionSetup& setup_, std::uint64_t seed)
      : array(std::move(array_)), setup(setup_), motion(array, setup, seed) {
    EXPECT_TRUE(monitor.configure(array, setup).has_value());
  }
  /// A reading that is clipped is told to be, but for those of `untold`.
  const MotionVerdict& step(std::uint64_t number, double full_scale_mps2, SensorSet untold = {}) {
    MotionSample s = motion.sample(number);
    for (int i = 0; i < array.size(); ++i) {
      double& y = s.reading_mps2[static_cast<std::size_t>(i)];
      if (saturated.has(i)) y = std::copysign(full_scale_mps2, sense);
      if (std::fabs(y) < full_scale_mps2) continue;
      y = std::copysign(full_scale_mps2, y);
      if (!untold.has(i)) s.clipped = s.clipped.with(i);
    }
    clipped += s.clipped.size();
    const MotionVerdict& said = monitor.step(s);
    alarms += said.alarm ? 1 : 0;
    blamed = blamed | said.isolated | said.excluded;
    return said;
  }
  SensorArray array;
  MotionSetup setup;
  RigidMotion motion;
  MotionMonitor monitor;
  SensorSet saturated, blamed;
  double sense = 1.0;
  int clipped = 0, alarms = 0;
};

SensorArray drawn_array(bool chips) { return chips ? plumb_test::parallel_triads(2) : cone_array(6, 0.01); }

// Verifies: REQ-212
RC_GTEST_PROP(MotionClippingLaw, AForceBeyondFullScaleAccusesNobody, ()) {
  const bool chips = *rc::gen::arbitrary<bool>();
  MotionSetup setup = motion_setup(6, *rc::gen::arbitrary<std::uint32_t>());
  setup.gyros = 2;
  Flight flight(drawn_array(chips), setup, *rc::gen::arbitrary<std::uint32_t>());
  flight.motion.draw_errors(*rc::gen::arbitrary<bool>());
  const double full_scale_mps2 = 3.0 + 0.01 * *rc::gen::inRange(0, 2000);
  for (std::uint64_t k = 0; k < 600; ++k) flight.step(k, full_scale_mps2);
  RC_CLASSIFY(flight.clipped > 600, "clipped", 0);
  RC_ASSERT(flight.alarms == 0);
  RC_ASSERT(flight.blamed.empty());
}

/// Full scales may differ: the one with the smaller range says no more than that it is beyond it.
// Verifies: REQ-212
RC_GTEST_PROP(MotionClippingLaw, ASensorOfASmallerRangeIsNotBlamed, ()) {
  Flight flight(cone_array(5, 0.01), motion_setup(5), *rc::gen::arbitrary<std::uint32_t>());
  flight.motion.draw_errors(true);
  const double small_mps2 = 1.0 + 0.01 * *rc::gen::inRange(0, 1000);
  const int small = *rc::gen::inRange(0, 5);
  for (std::uint64_t k = 0; k < 600; ++k) {
    MotionSample s = flight.motion.sample(k);
    double& y = s.reading_mps2[static_cast<std::size_t>(small)];
    if (std::fabs(y) >= small_mps2) {
      y = std::copysign(small_mps2, y);
      s.clipped = SensorSet::of(small);
    }
    const MotionVerdict& said = flight.monitor.step(s);
    RC_ASSERT(!said.alarm && said.isolated.empty() && said.excluded.empty());
  }
}

// Negative: REQ-212
TEST(MotionClipping, TheSameReadingsAccuseWhereFullScaleIsNotTold) {
  Flight told(cone_array(5, 0.01), motion_setup(5), 3), silent(cone_array(5, 0.01), motion_setup(5), 3);
  for (std::uint64_t k = 0; k < 600; ++k) {
    told.step(k, 8.0);
    silent.step(k, 8.0, silent.array.all());
  }
  EXPECT_GT(told.clipped, 100);
  EXPECT_EQ(told.alarms, 0);
  EXPECT_GT(silent.alarms, 0);
}

/// 16 g are read, and no sensor beside it feels more than a few.
// Verifies: REQ-212
TEST(MotionClipping, ASaturatedSensorIsIsolatedWithinSamples) {
  MotionSetup setup = motion_setup(6);
  setup.gyros = 2;
  for (const double sense : {1.0, -1.0}) {
    for (int sensor = 0; sensor < 6; ++sensor) {
      Flight flight(cone_array(6, 0.01), setup, 5);
      flight.sense = sense;
      for (std::uint64_t k = 0; k < 300; ++k) flight.step(k, 16.0 * kG0_mps2);
      EXPECT_EQ(flight.alarms, 0);
      flight.saturated = SensorSet::of(sensor);
      std::uint64_t k = 300;
      while (k < 400 && flight.step(k, 16.0 * kG0_mps2).isolated.empty()) ++k;
      EXPECT_LE(k, 316U) << sensor;
      for (; k < 600; ++k) flight.step(k, 16.0 * kG0_mps2);
      EXPECT_EQ(flight.blamed, SensorSet::of(sensor));
      EXPECT_EQ(flight.monitor.verdict().excluded, SensorSet::of(sensor)) << "it is out after the dwell";
    }
  }
}

// Verifies: REQ-212
TEST(MotionClipping, AChipThatIsSaturatedOnOneAxisIsIsolated) {
  MotionSetup setup = motion_setup(6);
  setup.gyros = 2;
  Flight two(plumb_test::parallel_triads(2), setup, 7);
  for (std::uint64_t k = 0; k < 600; ++k) {
    if (k == 300) two.saturated = SensorSet::of(4);
    two.step(k, 16.0 * kG0_mps2);
    EXPECT_TRUE(k >= 300 || two.alarms == 0);
  }
  EXPECT_TRUE(two.monitor.verdict().alarm);
  EXPECT_TRUE(two.blamed.empty()) << "of two chips none can be isolated";
}

/// Short of full scale at one sample, and the blocks around it say nothing of that sensor.
TEST(MotionClipping, ABlockThatIsClippedInPartSaysNothing) {
  MotionWindow window(3, 0, 0.001);
  MotionSample s;
  s.delivered = SensorSet::first(3);
  for (int k = 0; k < 40; ++k) {
    s.time_s = 0.001 * k;
    s.reading_mps2 = {20.0, k == 21 ? 19.0 : 20.0, -20.0};
    s.clipped = SensorSet::first(3);
    if (k == 21) s.clipped = s.clipped.without(1);
    window.add(s);
    if (k < 10) continue;
    const MotionMeans pair = window.means(0), block = window.means(1);
    EXPECT_TRUE(pair.usable.empty());
    EXPECT_EQ(pair.at_least, k == 22 || k == 23 ? SensorSet::of(0) : SensorSet::first(2)) << k;
    EXPECT_EQ(pair.at_most, SensorSet::of(2));
    EXPECT_TRUE(k != 25 || block.at_least == SensorSet::of(0)) << "samples 16 to 23";
  }
}

/// What is above full scale may be anything that the stated force allows: it may change, and its square may be larger.
// Negative: REQ-212
TEST(MotionClipping, AReadingAtFullScaleIsChargedWithTheStatedForce) {
  MotionSetup setup;
  setup.force_bound_mps2 = 60.0;
  setup.errors[1].lag_s = 1e-4;
  setup.errors[1].rectification = 1e-5;
  MotionMeans means;
  means.samples = 4;
  means.span_s = 0.004;
  means.reading_mps2[1] = 20.0;
  means.square_m2ps4[1] = 400.0;
  RotationTerm still;
  still.known = true;
  const SensorArray array = cone_array(4, 0.01);
  means.usable = array.all();
  EXPECT_EQ(corrected(array, setup, means, still, 5.0).error_mps2[1], 1e-5 * 400.0);
  means.usable = array.all().without(1);
  means.at_least = SensorSet::of(1);
  const MotionReadings clipped = corrected(array, setup, means, still, 5.0);
  EXPECT_GE(clipped.error_mps2[1], 1e-4 * 2.0 * 60.0 / 0.004 + 1e-5 * 3600.0);
  EXPECT_EQ(clipped.at_least, SensorSet::of(1));
  setup.errors[1].lag_s = 0.0;
  EXPECT_GE(corrected(array, setup, means, still, 5.0).error_mps2[1], 1e-5 * 3600.0);
}

/// Four sensors, a constant force, one reading just at full scale, every axis turned so that the parity is largest.
// Negative: REQ-212
TEST(MotionClipping, TurnedAxesAreInTheLimitOfAReadingAtFullScale) {
  constexpr double kTurn_rad = 0.01;
  const SensorArray array = cone_array(4, 1e-4);
  const Vec3 force{0.0, 3.0, 9.0};
  MotionSetup setup;
  setup.gyros = 2;
  setup.force_bound_mps2 = 10.0;
  for (std::size_t i = 0; i < 4; ++i) setup.errors[i].axis_rad = kTurn_rad;
  const MotionSets sets(array);
  ASSERT_EQ(sets.size(), 1);
  for (const double turn_rad : {0.9 * kTurn_rad, 6.0 * kTurn_rad}) {
    for (const double side : {-1.0, 1.0}) {
      MotionReadings readings;
      readings.noise_factor = 5.0;
      for (std::size_t k = 0; k < 4; ++k) {
        const int i = sets[0].sensor[k];
        const Vec3 across = minus(force, scaled(array.axis(i), dot(array.axis(i), force)));
        const double added = turn_rad * norm(across);
        readings.corrected_mps2[static_cast<std::size_t>(i)] =
            dot(array.axis(i), force) + std::copysign(added, side * sets[0].null[k]);
      }
      readings.usable = array.all().without(0);
      int rejected = 0;
      for (SensorSet MotionReadings::*sense : {&MotionReadings::at_least, &MotionReadings::at_most}) {
        MotionReadings asked = readings;
        asked.*sense = SensorSet::of(0);
        rejected += rejects(array, setup, sets[0], asked) ? 1 : 0;
      }
      EXPECT_EQ(rejected, turn_rad < kTurn_rad ? 0 : 1) << "beyond the bound it accuses, in one sense only";
    }
  }
}

}  // namespace
}  // namespace motion_clipping_test
