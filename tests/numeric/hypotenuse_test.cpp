#include "plumb/numeric/hypotenuse.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

namespace hypotenuse_test {
namespace {

using plumb::hypotenuse;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::int64_t units_apart(double a, double b) {
  std::int64_t bits_a = 0, bits_b = 0;
  std::memcpy(&bits_a, &a, sizeof a);
  std::memcpy(&bits_b, &b, sizeof b);
  return std::llabs(bits_a - bits_b);
}

/// The long double function of the C library is right to far more digits than are compared.
double true_length(double x, double y) {
  return static_cast<double>(std::hypot(static_cast<long double>(x), static_cast<long double>(y)));
}

/// 1 to 2 times a power of two from `least` to `most`, of either sign.
double any_size(int least, int most) {
  const double digits = 1.0 + *rc::gen::inRange<int>(0, 1 << 30) / 1073741824.0;
  return std::ldexp(*rc::gen::arbitrary<bool>() ? digits : -digits, *rc::gen::inRange(least, most + 1));
}

TEST(Hypotenuse, WholeTriangles) {
  EXPECT_EQ(hypotenuse(3.0, 4.0), 5.0);
  EXPECT_EQ(hypotenuse(-12.0, 5.0), 13.0);
  EXPECT_EQ(hypotenuse(0.0, -7.0), 7.0);
  EXPECT_EQ(hypotenuse(7.0, 0.0), 7.0);
  EXPECT_EQ(hypotenuse(0.0, 0.0), 0.0);
  EXPECT_EQ(hypotenuse(1.0, 1.0), std::sqrt(2.0));
}

TEST(Hypotenuse, NeitherOverflowsNorVanishes) {
  EXPECT_EQ(hypotenuse(3e300, 4e300), 5e300);
  EXPECT_EQ(hypotenuse(std::ldexp(3.0, -1074), std::ldexp(4.0, -1074)), std::ldexp(5.0, -1074));
  EXPECT_EQ(hypotenuse(1.0, std::numeric_limits<double>::max()), std::numeric_limits<double>::max());
  EXPECT_EQ(hypotenuse(std::numeric_limits<double>::denorm_min(), 1.0), 1.0);
}

TEST(Hypotenuse, OfWhatIsNoNumber) {
  EXPECT_EQ(hypotenuse(-kInfinity, 1.0), kInfinity);
  EXPECT_EQ(hypotenuse(kNan, kInfinity), kInfinity);
  EXPECT_EQ(hypotenuse(kInfinity, kNan), kInfinity);
  EXPECT_TRUE(std::isnan(hypotenuse(kNan, 1.0)));
  EXPECT_TRUE(std::isnan(hypotenuse(0.0, kNan)));
}

RC_GTEST_PROP(HypotenuseLaw, IsTheTrueLengthToOneUnit, ()) {
  const double x = any_size(-1020, 1020), y = std::ldexp(x, *rc::gen::inRange(-60, 2)) * (any_size(0, 0));
  RC_ASSERT(units_apart(hypotenuse(x, y), true_length(x, y)) <= 1);
  RC_ASSERT(hypotenuse(x, y) == hypotenuse(-y, x));
}

/// The digit that is corrected: a root of rounded squares is off in one of seven cases.
RC_GTEST_PROP(HypotenuseLaw, IsTheNearestDoubleAlmostAlways, ()) {
  constexpr int kTries = 4000, kMost = 80;
  std::mt19937_64 draws(*rc::gen::arbitrary<std::uint64_t>());
  std::uniform_real_distribution<double> sizes(1.0, 16.0);
  int off = 0;
  for (int k = 0; k < kTries; ++k) {
    const double x = sizes(draws), y = sizes(draws);
    off += hypotenuse(x, y) == true_length(x, y) ? 0 : 1;
  }
  RC_ASSERT(off <= kMost);
}

}  // namespace
}  // namespace hypotenuse_test
