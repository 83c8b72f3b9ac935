#include "plumb/core/circle_point.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "plumb/core/units.hpp"

namespace circle_point_test {
namespace {

using namespace plumb;

/// The long double functions of the C library have eleven bits more: they round to another double than the true value
/// once in a few thousand angles, by one unit in the last place.
double true_cosine(double a) { return static_cast<double>(std::cos(static_cast<long double>(a))); }
double true_sine(double a) { return static_cast<double>(std::sin(static_cast<long double>(a))); }

TEST(CirclePoint, QuartersOfATurn) {
  EXPECT_EQ(circle_point(0.0).cosine, 1.0);
  EXPECT_EQ(circle_point(0.0).sine, 0.0);
  EXPECT_EQ(circle_point(0.5 * kPi).sine, 1.0);
  EXPECT_EQ(circle_point(kPi).cosine, -1.0);
  EXPECT_EQ(circle_point(-0.5 * kPi).sine, -1.0);
  EXPECT_EQ(circle_point(1.5 * kPi).sine, -1.0);
  EXPECT_EQ(circle_point(2.0 * kPi).cosine, 1.0);
  EXPECT_EQ(circle_point(0.5 * kPi).cosine, 6.1232339957367660e-17);  // of pi/2 as it is rounded
  EXPECT_EQ(circle_point(kPi).sine, 1.2246467991473532e-16);
}

TEST(CirclePoint, IsNoneBeyondItsAngles) {
  for (const double angle :
       {8.1, -9.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_TRUE(std::isnan(circle_point(angle).cosine)) << angle;
    EXPECT_TRUE(std::isnan(circle_point(angle).sine)) << angle;
  }
  EXPECT_EQ(circle_point(8.0).cosine, true_cosine(8.0));
  EXPECT_EQ(circle_point(-8.0).sine, true_sine(-8.0));
}

/// The angles of every cone that there is room for.
TEST(CirclePoint, IsTheNearestOfEveryCone) {
  for (int n = 2; n <= kCapacity; ++n) {
    for (int k = 0; k < n; ++k) {
      const double angle = 2.0 * kPi * k / n;
      EXPECT_EQ(circle_point(angle).cosine, true_cosine(angle)) << n << " " << k;
      EXPECT_EQ(circle_point(angle).sine, true_sine(angle)) << n << " " << k;
    }
  }
}

RC_GTEST_PROP(CirclePointLaw, IsTheNearestDoubleAlmostAlways, ()) {
  constexpr int kTries = 1000, kMost = 8;
  std::mt19937_64 draws(*rc::gen::arbitrary<std::uint64_t>());
  std::uniform_real_distribution<double> angles(-8.0, 8.0);
  const int halvings = *rc::gen::inRange(0, 40);
  int off = 0;
  for (int k = 0; k < kTries; ++k) {
    const double angle = std::ldexp(angles(draws), -halvings);
    const CirclePoint at = circle_point(angle);
    off += at.cosine == true_cosine(angle) && at.sine == true_sine(angle) ? 0 : 1;
    RC_ASSERT(std::fabs(at.cosine - true_cosine(angle)) <= 1.2e-16);
    RC_ASSERT(std::fabs(at.sine - true_sine(angle)) <= 1.2e-16 * std::fabs(at.sine) * 2.0);
  }
  RC_ASSERT(off <= kMost);
}

}  // namespace
}  // namespace circle_point_test
