// Powers and Chebyshev polynomials say the same at every point, and come back from one another.
#include "plumb/numeric/chebyshev.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace chebyshev_test {
namespace {

using plumb::ChebyshevSpan;
using plumb::Cubic;

double in_powers(const Cubic& p, double x) { return p[0] + x * (p[1] + x * (p[2] + x * p[3])); }

double in_chebyshev(const Cubic& c, double tau) {
  const Cubic t = plumb::chebyshev_values(tau);
  return c[0] * t[0] + c[1] * t[1] + c[2] * t[2] + c[3] * t[3];
}

double drawn(int thousandths) { return 1e-3 * *rc::gen::inRange(-thousandths, thousandths + 1); }

TEST(Chebyshev, ValuesAreCosinesOfMultiples) {
  for (const double angle : {0.0, 0.3, 1.2, 2.5, 3.1415926535897931}) {
    const Cubic t = plumb::chebyshev_values(std::cos(angle));
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(t[static_cast<std::size_t>(k)], std::cos(k * angle), 1e-15);
  }
}

TEST(Chebyshev, KnownCubic) {
  // (x - 25)^3 over 20 .. 150, worked out by hand: x - 25 = 65 tau + 60.
  const ChebyshevSpan span = {20.0, 150.0};
  const Cubic c = plumb::chebyshev_from_powers({0.0, 0.0, 0.0, 1.0}, span, 25.0);
  EXPECT_DOUBLE_EQ(c[3], 65.0 * 65.0 * 65.0 / 4.0);
  EXPECT_DOUBLE_EQ(c[2], 3.0 * 65.0 * 65.0 * 60.0 / 2.0);
  EXPECT_DOUBLE_EQ(c[1], 3.0 * 65.0 * 60.0 * 60.0 + 3.0 * 65.0 * 65.0 * 65.0 / 4.0);
  EXPECT_DOUBLE_EQ(c[0], 60.0 * 60.0 * 60.0 + 3.0 * 65.0 * 65.0 * 60.0 / 2.0);
}

RC_GTEST_PROP(ChebyshevLaw, BothFormsAgreeEverywhereAndConvertBack, ()) {
  ChebyshevSpan span;
  span.lowest = 100.0 * drawn(1000);
  span.highest = span.lowest + 1.0 + 100.0 * std::fabs(drawn(1000));
  const double centre = 100.0 * drawn(1500);
  Cubic c{};
  for (double& v : c) v = drawn(1000);
  const Cubic p = plumb::powers_from_chebyshev(c, span, centre);
  double largest = 1.0;
  for (int step = 0; step <= 8; ++step) {
    const double x = span.lowest + (span.highest - span.lowest) * step / 8.0;
    // What cancels in powers is as large as its largest term.
    const double d = x - centre;
    double size = 1.0;
    for (int k = 0; k < 4; ++k) size = std::fmax(size, std::fabs(p[static_cast<std::size_t>(k)] * std::pow(d, k)));
    largest = std::fmax(largest, size);
    RC_ASSERT(std::fabs(in_powers(p, d) - in_chebyshev(c, span.scaled(x))) <= 1e-13 * size);
  }
  const Cubic back = plumb::chebyshev_from_powers(p, span, centre);
  for (std::size_t k = 0; k < 4; ++k) RC_ASSERT(std::fabs(back[k] - c[k]) <= 1e-12 * largest);
}

}  // namespace
}  // namespace chebyshev_test
