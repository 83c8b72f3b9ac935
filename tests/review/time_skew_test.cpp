#include "plumb/review/time_skew.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>

#include "flight.hpp"

namespace time_skew_test {
namespace {

using plumb::review::Axes;
using plumb::review::Course;
using plumb::review::FindingCode;
using plumb::review::LogReview;
using plumb::review::skew_of;

/// Motion of several frequencies up to 2 Hz, seen `lag_s` late, with noise.
Course course(double rate_hz, double lag_s, double noise_mps2, unsigned seed) {
  Course out;
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  for (int k = 0; k < static_cast<int>(10.0 * rate_hz); ++k) {
    const double t = k / rate_hz;
    const double s = t - lag_s;
    out.time_s.push_back(t);
    out.force_mps2.push_back({2.0 * std::sin(5.0 * s) + noise_mps2 * normal(engine),
                              std::sin(11.0 * s + 1.0) + noise_mps2 * normal(engine),
                              -9.8 + std::cos(3.0 * s) + noise_mps2 * normal(engine)});
  }
  return out;
}

}  // namespace

// Within the uncertainty in 95 %: the law allows 1.5 of it, which noise passes in 3 of 1000.
RC_GTEST_PROP(TimeSkewLaw, TheLagComesBackWithinItsUncertainty, ()) {
  const double lag_s = 0.001 * *rc::gen::inRange(-180, 181);
  const double first_hz = *rc::gen::element(50.0, 100.0, 250.0);
  const double second_hz = *rc::gen::element(50.0, 100.0, 250.0);
  const double noise = 0.01 * *rc::gen::inRange(1, 50);
  const unsigned seed = *rc::gen::inRange(1U, 1000U);
  const auto skew = skew_of(course(first_hz, 0.0, noise, seed), course(second_hz, lag_s, noise, seed + 1000U));
  RC_ASSERT(skew.has_value());
  RC_ASSERT(std::abs(skew->lag_s - lag_s) < 1.5 * skew->uncertainty_s + 2.0e-4);
  RC_ASSERT(skew->uncertainty_s < 0.03);
}

TEST(TimeSkew, WhatSharesNoMotionHasNone) {
  Course other = course(100.0, 0.0, 0.1, 3);
  for (std::size_t k = 0; k < other.force_mps2.size(); ++k)
    other.force_mps2[k] = {2.0 * std::sin(7.0 * other.time_s[k] * other.time_s[k]), 0.0, -9.8};
  EXPECT_FALSE(skew_of(course(100.0, 0.0, 0.1, 1), other).has_value());
  EXPECT_FALSE(skew_of(Course{}, other).has_value());
}

// A tone looks the same a period later.
TEST(TimeSkew, PeriodicMotionHasNone) {
  for (const double hz : {3.0, 8.0, 20.0}) {
    Course first = course(200.0, 0.0, 0.1, 1);
    Course second = first;
    for (std::size_t k = 0; k < first.time_s.size(); ++k) {
      const double phase = 2.0 * 3.14159265358979 * hz * first.time_s[k];
      first.force_mps2[k] = {std::sin(phase), 0.01 * std::sin(1.7 * phase), -9.8};
      second.force_mps2[k] = {std::sin(phase - 0.3), 0.0, -9.8};
    }
    EXPECT_FALSE(skew_of(first, second).has_value()) << hz;
  }
}

// A lag beyond what is searched is no lag at its edge.
TEST(TimeSkew, ALagBeyondTheSearchIsNotReportedAtItsEdge) {
  const auto skew = skew_of(course(100.0, 0.0, 0.1, 1), course(100.0, 0.3, 0.1, 2), 0.25);
  EXPECT_LT(skew ? std::abs(skew->lag_s) : 0.0, 0.24);
}

TEST(TimeSkew, TheWindowIsThatOfMostMotionAndNeedsTwoFastChips) {
  review_flight::SimulatedFlight flight = review_flight::with_chips(2);
  const auto digest = flight.digest();
  const auto window = plumb::review::skew_window(digest, plumb::review::review_log(digest));
  ASSERT_TRUE(window.has_value());
  EXPECT_GE(window->from_s, flight.rest_s - 1.0);
  EXPECT_NEAR(window->to_s - window->from_s, 10.0, 1.1);
  flight.chips[1].rate_hz = 5.0;
  const auto slow = flight.digest();
  EXPECT_FALSE(plumb::review::skew_window(slow, plumb::review::review_log(slow)).has_value());
}

}  // namespace time_skew_test
