// What is told of a chip in flight: healthy only where a bounded force vouches for it, and of nobody where nothing is
// judged.
#include "navigation/in_flight.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "motion_verdicts.hpp"

namespace in_flight_test {
namespace {

using example_test::any_set;
using example_test::any_verdict;
using example_test::flying;
using example_test::kChipAxes;
using plumb::MotionCause;
using plumb::SensorSet;
using plumb_flight::told;
using plumb_flight::Told;

TEST(InFlight, aVerdictThatWasNeverMadeTellsNothing) {
  EXPECT_EQ(told(plumb::MotionVerdict{}), Told::unknown);
  EXPECT_EQ(told(plumb::MotionVerdict{}, kChipAxes[0]), Told::unknown);
}

TEST(InFlight, aChipInABoundedForceIsHealthy) {
  for (const SensorSet axes : kChipAxes) EXPECT_EQ(told(flying(), axes), Told::healthy);
  EXPECT_EQ(told(flying(), SensorSet{}), Told::unknown);  // an empty place
}

TEST(InFlight, oneAxisIsolatedOrExcludedMakesTheChipFaulty) {
  for (int axis = 0; axis < 9; ++axis) {
    plumb::MotionVerdict isolated = flying(), excluded = flying();
    isolated.alarm = true;
    isolated.isolated = isolated.suspects = SensorSet::of(axis);
    excluded.excluded = SensorSet::of(axis);
    for (int chip = 0; chip < 3; ++chip) {
      const Told expected = chip == axis / 3 ? Told::faulty : Told::healthy;
      EXPECT_EQ(told(isolated, kChipAxes[static_cast<std::size_t>(chip)]), expected) << axis;
      EXPECT_EQ(told(excluded, kChipAxes[static_cast<std::size_t>(chip)]), expected) << axis;
    }
  }
}

TEST(InFlight, aSuspectOrWhoIsNotInTheForceIsUnknown) {
  plumb::MotionVerdict v = flying();
  v.suspects = SensorSet::of(4);
  EXPECT_EQ(told(v, kChipAxes[1]), Told::unknown);
  EXPECT_EQ(told(v, kChipAxes[0]), Told::healthy);
  v = flying();
  v.sample.used = v.sample.used.without(8);  // clipped, or not delivered
  EXPECT_EQ(told(v, kChipAxes[2]), Told::unknown);
  EXPECT_EQ(told(v, kChipAxes[1]), Told::healthy);
}

TEST(InFlight, anyCauseAndAnAlarmThatNamesNobodyLeaveAllUnknown) {
  for (int cause = 1; cause < 7; ++cause) {
    plumb::MotionVerdict v = flying();
    v.cause = static_cast<MotionCause>(cause);
    for (const SensorSet axes : kChipAxes) EXPECT_EQ(told(v, axes), Told::unknown) << cause;
  }
  plumb::MotionVerdict v = flying();
  v.alarm = true;
  for (const SensorSet axes : kChipAxes) EXPECT_EQ(told(v, axes), Told::unknown);
}

TEST(InFlight, withoutABoundNobodyIsHealthy) {
  plumb::MotionVerdict v = flying();
  v.sample.validity = plumb::ForceValidity::unchecked;
  EXPECT_EQ(told(v, kChipAxes[0]), Told::unchecked);
  v.sample.validity = plumb::ForceValidity::none;
  EXPECT_EQ(told(v, kChipAxes[0]), Told::unknown);
  v = flying();
  v.sample.bound_mps2 = std::numeric_limits<double>::infinity();
  EXPECT_EQ(told(v, kChipAxes[0]), Told::unchecked);
}

TEST(InFlight, aForceWithoutNumbersOrWithoutAnInstantIsNone) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    plumb::MotionVerdict force = flying(), time = flying(), span = flying();
    force.sample.force_mps2[2] = bad;
    time.sample.time_s = bad;
    span.sample.span_s = -bad;
    for (const auto& v : {force, time, span}) EXPECT_EQ(told(v, kChipAxes[0]), Told::unknown);
  }
  plumb::MotionVerdict v = flying();
  v.sample.span_s = 0.0;  // a gap
  EXPECT_EQ(told(v), Told::unknown);
}

TEST(InFlight, theInstantIsRoundedToMicroseconds) {
  EXPECT_EQ(plumb_flight::microseconds(8.0005), 8000500U);
  EXPECT_EQ(plumb_flight::microseconds(1e-6), 1U);
  for (const double bad : {0.0, -1.0, 1e14, 1e300, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(plumb_flight::microseconds(bad), 0U) << bad;
}

RC_GTEST_PROP(InFlightLaw, WhoIsIsolatedOrExcludedIsFaultyAndNobodyElse, ()) {
  const plumb::MotionVerdict v = any_verdict();
  const SensorSet axes = any_set();
  RC_ASSERT((told(v, axes) == Told::faulty) == !((v.isolated | v.excluded) & axes).empty());
}

RC_GTEST_PROP(InFlightLaw, HealthyNeedsABoundedForceWithTheChipInItAndNoCause, ()) {
  const plumb::MotionVerdict v = any_verdict();
  const SensorSet axes = kChipAxes[*rc::gen::inRange<std::size_t>(0, 3)];
  const bool healthy = told(v, axes) == Told::healthy;
  RC_CLASSIFY(healthy, "healthy");
  const SensorSet accused = v.suspects | v.isolated | v.excluded;
  RC_ASSERT(!healthy || v.cause == MotionCause::none);
  RC_ASSERT(!healthy || v.sample.validity == plumb::ForceValidity::bounded);
  RC_ASSERT(!healthy || (std::isfinite(v.sample.bound_mps2) && std::isfinite(plumb::norm(v.sample.force_mps2))));
  RC_ASSERT(!healthy || (v.sample.used.contains(axes) && (accused & axes).empty()));
  RC_ASSERT(!healthy || !v.alarm || !(v.isolated | v.excluded).empty());
}

}  // namespace
}  // namespace in_flight_test
