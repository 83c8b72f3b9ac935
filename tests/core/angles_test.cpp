#include "plumb/core/angles.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "plumb/core/units.hpp"

namespace angles_test {
namespace {

using namespace plumb;

/// Neighbouring doubles between two of one sign.
std::int64_t units_apart(double a, double b) {
  std::int64_t bits_a = 0, bits_b = 0;
  std::memcpy(&bits_a, &a, sizeof a);
  std::memcpy(&bits_b, &b, sizeof b);
  return std::llabs(bits_a - bits_b);
}

/// The long double functions of the C library are right to far more digits than are compared.
double true_angle(double y, double x) {
  return static_cast<double>(std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
}
double true_sine(double a) { return static_cast<double>(std::sin(static_cast<long double>(a))); }
double true_arc(double s) { return static_cast<double>(std::asin(static_cast<long double>(s))); }

constexpr std::int64_t kUnits = 2;

/// Magnitudes from 1e-20 to 1e20, spread over the exponents.
rc::Gen<double> magnitude() {
  return rc::gen::map(
      rc::gen::pair(rc::gen::inRange<int>(-2000000, 2000001), rc::gen::inRange<int>(0, 1 << 30)),
      [](const std::pair<int, int>& p) { return std::pow(10.0, p.first / 1e5) * (1.0 + p.second / 1073741824.0); });
}

TEST(Angles, WholeAndHalfTurns) {
  EXPECT_EQ(angle_of(0.0, 5.0), 0.0);
  EXPECT_EQ(angle_of(0.0, 0.0), 0.0);
  EXPECT_EQ(angle_of(0.0, -1.0), kPi);
  EXPECT_EQ(angle_of(3.0, 0.0), 0.5 * kPi);
  EXPECT_EQ(angle_of(2.0, 2.0), 0.25 * kPi);
  EXPECT_EQ(angle_of(2.0, -2.0), 0.75 * kPi);
  EXPECT_EQ(sine_of(0.0), 0.0);
  EXPECT_EQ(sine_of(0.5 * kPi), 1.0);
  EXPECT_EQ(sine_of(-0.5 * kPi), -1.0);
  EXPECT_EQ(angle_with_sine(0.0), 0.0);
  EXPECT_EQ(angle_with_sine(1.0), 0.5 * kPi);
}

TEST(Angles, WhatIsNoNumberHasNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(angle_of(nan, 1.0)));
  EXPECT_TRUE(std::isnan(angle_of(1.0, nan)));
  EXPECT_TRUE(std::isnan(angle_of(0.0, nan)));
  EXPECT_TRUE(std::isnan(angle_of(nan, 0.0)));
  EXPECT_TRUE(std::isnan(sine_of(nan)));
  EXPECT_TRUE(std::isnan(angle_with_sine(nan)));
  EXPECT_TRUE(std::isnan(angle_with_sine(1.0000000000000002)));
  EXPECT_TRUE(std::isnan(angle_with_sine(-1e-300)));
}

RC_GTEST_PROP(AnglesLaw, AnAngleIsTheTrueOneToTwoUnits, ()) {
  const double y = *magnitude(), x = *magnitude() * (*rc::gen::arbitrary<bool>() ? 1.0 : -1.0);
  RC_ASSERT(units_apart(angle_of(y, x), true_angle(y, x)) <= kUnits);
}

/// Between pi/16 and pi/2, where the octants meet.
RC_GTEST_PROP(AnglesLaw, AnAngleOfLikeSidesIsTheTrueOneToTwoUnits, ()) {
  const double y = 1.0 + *rc::gen::inRange<int>(0, 1 << 30) / 1073741824.0 * 4.0;
  const double x = 1.0 + *rc::gen::inRange<int>(0, 1 << 30) / 1073741824.0 * 4.0;
  RC_ASSERT(units_apart(angle_of(y, x), true_angle(y, x)) <= kUnits);
}

RC_GTEST_PROP(AnglesLaw, ASineIsTheTrueOneToTwoUnits, ()) {
  const double angle = *rc::gen::inRange<int>(0, 1 << 30) / 1073741824.0 * 0.5 * kPi;
  RC_ASSERT(units_apart(sine_of(angle), true_sine(angle)) <= kUnits);
  RC_ASSERT(sine_of(-angle) == -sine_of(angle));
}

RC_GTEST_PROP(AnglesLaw, TheAngleWithASineIsTheTrueOneToTwoUnits, ()) {
  const double sine = *rc::gen::inRange<int>(0, 1 << 30) / 1073741824.0;
  RC_ASSERT(units_apart(angle_with_sine(sine), true_arc(sine)) <= kUnits);
}

}  // namespace
}  // namespace angles_test
