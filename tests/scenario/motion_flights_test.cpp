// Simulated flights in which a healthy sensor was once in doubt, each with the limits of an earlier draft of the
// monitor of motion: what they feel is within the stated bounds, so nothing may be rejected.
#include <gtest/gtest.h>

#include "flight_case.hpp"

namespace motion_flights_test {
namespace {

using plumb::scenario::FlightKind;
using plumb_bench::FlightArray;
using plumb_bench::FlightCase;

void expect_undisturbed(const FlightCase& one) {
  const plumb_bench::FlightOutcome out = plumb_bench::fly(one);
  EXPECT_FALSE(out.early_alarm) << one.seed;
  EXPECT_FALSE(out.wrongly_isolated || out.wrongly_excluded) << one.seed;
  EXPECT_EQ(out.sample.violations + out.block.violations, 0U) << one.seed;
  EXPECT_GT(out.block.checks, 100U) << one.seed;
}

/// A drill string whose shocks begin between two samples, channels skewed by 50 us: the mean slope is too small there.
TEST(MotionFlights, ShocksBetweenTwoSamplesRejectNoHealthySet) {
  for (const std::uint64_t seed : {1000003U, 1000017U, 1000041U, 1000051U}) {
    FlightCase one;
    one.kind = FlightKind::drilling;
    one.sensors = 6;
    one.seed = seed;
    expect_undisturbed(one);
  }
}

/// Three chips under broadband vibration, skew at its vertices: what comes near the sample rate looks slow in a block.
TEST(MotionFlights, VibrationNearTheSampleRateRejectsNoHealthySet) {
  for (const std::uint64_t seed : {5000199U, 5000487U, 5000821U}) {
    FlightCase one;
    one.array = FlightArray::triads;
    one.sensors = 9;
    one.duration_s = 12.0;
    one.seed = seed;
    expect_undisturbed(one);
  }
}

/// Three chips on a launcher: a block of one sample needs more than one second difference.
TEST(MotionFlights, OneSecondDifferenceIsTooLittleForTwoSamples) {
  for (const std::uint64_t seed : {7000211U, 7000237U}) {
    FlightCase one;
    one.kind = FlightKind::launch;
    one.array = FlightArray::triads;
    one.sensors = 9;
    one.seed = seed;
    expect_undisturbed(one);
  }
}

}  // namespace
}  // namespace motion_flights_test
