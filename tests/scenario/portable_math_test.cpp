#include "plumb/scenario/portable_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plumb/scenario/random.hpp"

namespace plumb {
namespace scenario {
namespace portable_math_test {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();

static_assert(portable_exp(0.0) == 1.0, "usable at compile time");
static_assert(portable_log(1.0) == 0.0, "usable at compile time");

TEST(PortableMath, ExpAgreesWithTheLibrary) {
  const Stream stream(1, Purpose::test);
  for (std::uint64_t k = 0; k < 100000; ++k) {
    const double x = stream.uniform(k, -40.0, 40.0);
    EXPECT_NEAR(portable_exp(x) / std::exp(x), 1.0, 2.5 * kUlp) << x;
  }
  EXPECT_NEAR(portable_exp(-700.0) / std::exp(-700.0), 1.0, 2.5 * kUlp);
  EXPECT_NEAR(portable_exp(700.0) / std::exp(700.0), 1.0, 2.5 * kUlp);
}

TEST(PortableMath, LogAgreesWithTheLibrary) {
  const Stream stream(2, Purpose::test);
  for (std::uint64_t k = 0; k < 100000; ++k) {
    const double near_one = stream.uniform(k, 0.5, 2.0);
    EXPECT_NEAR(portable_log(near_one), std::log(near_one), 2.5 * kUlp * std::abs(std::log(near_one))) << near_one;
    const double small = std::ldexp(near_one, -static_cast<int>(k % 300));
    EXPECT_NEAR(portable_log(small), std::log(small), 2.5 * kUlp * std::abs(std::log(small))) << small;
  }
}

TEST(PortableMath, SineAndCosineAgreeWithTheLibrary) {
  const Stream stream(3, Purpose::test);
  for (std::uint64_t k = 0; k < 100000; ++k) {
    const double reach = k % 2 == 0 ? 7.0 : 1e5;
    const double x = stream.uniform(k, -reach, reach);
    const SinCos at = portable_sincos(x);
    EXPECT_NEAR(at.sin, std::sin(x), 1.5 * kUlp) << x;
    EXPECT_NEAR(at.cos, std::cos(x), 1.5 * kUlp) << x;
  }
  EXPECT_EQ(portable_sincos(0.0).sin, 0.0);
  EXPECT_EQ(portable_sincos(0.0).cos, 1.0);
}

TEST(PortableMath, AngleInvertsSineAndCosine) {
  for (int k = 0; k <= 1800; ++k) {
    const double angle = rad_from_deg(0.1 * k);
    EXPECT_NEAR(portable_angle(std::cos(angle), std::sin(angle)), angle, 4.0 * kUlp) << k;
  }
  EXPECT_EQ(portable_angle(1.0, 0.0), 0.0);
  EXPECT_NEAR(portable_angle(1.0, 1e-12), 1e-12, 1e-26);
}

}  // namespace
}  // namespace portable_math_test
}  // namespace scenario
}  // namespace plumb
