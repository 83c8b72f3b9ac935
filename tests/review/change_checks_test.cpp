// A chip that reads something else when the vehicle stands again as before.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "flight.hpp"

namespace change_checks_test {
namespace {

using plumb::review::Finding;
using plumb::review::FindingCode;
using plumb::review::Grade;
using plumb::review::LogReview;
using review_flight::Axes;
using review_flight::count_of;
using review_flight::first_of;
using review_flight::SimulatedFlight;
using review_flight::with_chips;

/// At rest, in motion, and at rest again from 25 s on, turned by `turned_deg`.
SimulatedFlight there_and_back(int chips, double turned_deg = 0.0) {
  SimulatedFlight out = with_chips(chips);
  out.gyro = false;
  out.vibration_mps2 = 0.0;
  const double angle = turned_deg * 0.017453292519943295;
  for (auto& chip : out.chips) {
    chip.reads = [angle](double t, Axes f) {
      if (t < 25.0) return f;
      return Axes{9.81 * std::sin(angle) + 0.01 * std::sin(40.0 * t), 0.01 * std::cos(37.0 * t),
                  -9.81 * std::cos(angle)};
    };
  }
  return out;
}

/// Adds an error to a chip from a time on.
void add(SimulatedFlight& flight, std::size_t chip, Axes error, double from_s) {
  const auto before = flight.chips[chip].reads;
  flight.chips[chip].reads = [before, error, from_s](double t, Axes f) {
    Axes out = before(t, f);
    for (std::size_t k = 0; k < 3 && t >= from_s; ++k) out[k] += error[k];
    return out;
  };
}

TEST(ChangeChecks, AChipThatChangedInBetweenIsNamedWithWhatLiesBetween) {
  SimulatedFlight flight = there_and_back(3);
  add(flight, 1, {0.0, 0.9, 0.0}, 18.0);
  const LogReview review = flight.review();
  ASSERT_EQ(count_of(review, FindingCode::changed), 1U);
  const Finding* found = first_of(review, FindingCode::changed);
  EXPECT_EQ(found->chip, 1U);
  EXPECT_EQ(found->grade, Grade::red);
  EXPECT_NEAR(found->figure, 0.9, 0.05);
  EXPECT_NEAR(found->from_s, 10.0, 2.0);
  EXPECT_NEAR(found->to_s, 25.0, 2.0);
}

TEST(ChangeChecks, AnErrorThatWasThereFromTheBeginningIsNoChange) {
  SimulatedFlight flight = there_and_back(3);
  add(flight, 1, {0.0, 0.9, 0.0}, 0.0);
  const LogReview review = flight.review();
  EXPECT_EQ(count_of(review, FindingCode::changed), 0U);
  EXPECT_EQ(count_of(review, FindingCode::disagreement), 1U);
}

TEST(ChangeChecks, OneChipIsJudgedByItsLength) {
  SimulatedFlight along = there_and_back(1), across = there_and_back(1);
  add(along, 0, {0.0, 0.0, 0.5}, 18.0);
  add(across, 0, {0.5, 0.0, 0.0}, 18.0);
  EXPECT_EQ(count_of(along.review(), FindingCode::changed), 1U);
  EXPECT_EQ(count_of(across.review(), FindingCode::changed), 0U);
}

TEST(ChangeChecks, AnotherAttitudeIsNotCompared) {
  SimulatedFlight flight = there_and_back(1, 40.0);
  add(flight, 0, {0.0, 0.0, -0.6}, 18.0);
  EXPECT_EQ(count_of(flight.review(), FindingCode::changed), 0U);
}

TEST(ChangeChecks, AChipWithOtherAxesIsTurnedWithTheVehicle) {
  for (const double turned_deg : {3.0, 9.0}) {
    SimulatedFlight flight = there_and_back(3, turned_deg);
    const auto straight = flight.chips[2].reads;
    flight.chips[2].reads = [straight](double t, Axes f) {
      const Axes g = straight(t, f);
      return Axes{g[2], g[1], -g[0]};
    };
    EXPECT_EQ(count_of(flight.review(), FindingCode::changed), 0U) << turned_deg;
    flight.chips[2].reads = [straight](double t, Axes f) {
      const Axes g = straight(t, f);
      return Axes{-g[0], -g[1], g[2]};  // about the vertical: at the first stretch nothing shows
    };
    EXPECT_EQ(count_of(flight.review(), FindingCode::changed), 0U) << turned_deg;
  }
}

// Errors that calibrated sensors have, and attitudes a little apart, are no change.
RC_GTEST_PROP(ChangeChecksLaw, SoundChipsDoNotChange, ()) {
  SimulatedFlight flight = there_and_back(*rc::gen::inRange(1, 5), *rc::gen::inRange(0, 12));
  flight.seed = *rc::gen::arbitrary<unsigned>();
  for (std::size_t chip = 0; chip < flight.chips.size(); ++chip) {
    const auto error = [] { return 0.001 * *rc::gen::inRange(-90, 91); };
    add(flight, chip, {error(), error(), error()}, 0.0);
    add(flight, chip, {0.3 * error(), 0.3 * error(), 0.3 * error()}, 18.0);
  }
  RC_ASSERT(count_of(flight.review(), FindingCode::changed) == 0U);
}

}  // namespace
}  // namespace change_checks_test
