// Legendre functions and the ellipsoid by their laws.
#include "../../src/geomagnetic/ellipsoid.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "../../src/geomagnetic/legendre.hpp"
#include "plumb/core/units.hpp"

namespace ellipsoid_test {
namespace {

using namespace plumb;
using namespace plumb::geomagnetic;

double any_colatitude_rad() {
  const double at = *rc::gen::inRange(0, 1000001) / 1e6 * kPi;
  return *rc::gen::element(at, 0.0, kPi, kPi / 2.0, 1e-9, kPi - 1e-9);
}

RC_GTEST_PROP(LegendreLaw, SquaresOfADegreeSumToOne, ()) {
  // The addition theorem of spherical harmonics at zero distance, in Schmidt's normalisation.
  const double theta = any_colatitude_rad();
  const LegendreTable p = legendre_table(std::cos(theta), std::sin(theta));
  for (int n = 1; n <= kMaxDegree; ++n) {
    double value = 0.0, slope = 0.0;
    for (int m = 0; m <= n; ++m) {
      const std::size_t at = coefficient_index(n, m);
      value += p.value[at] * p.value[at];
      slope += p.slope[at] * p.slope[at];
      if (m > 0) RC_ASSERT(std::fabs(p.value[at] - std::sin(theta) * p.over_sine[at]) < 1e-14);
    }
    RC_ASSERT(std::fabs(value - 1.0) < 1e-13);
    RC_ASSERT(std::fabs(slope - n * (n + 1) / 2.0) < 1e-11);  // its second derivative there
  }
}

RC_GTEST_PROP(LegendreLaw, SlopesAreDifferences, ()) {
  const double theta = any_colatitude_rad(), step = 1e-5;
  const LegendreTable p = legendre_table(std::cos(theta), std::sin(theta));
  const LegendreTable ahead = legendre_table(std::cos(theta + step), std::sin(theta + step));
  const LegendreTable behind = legendre_table(std::cos(theta - step), std::sin(theta - step));
  for (std::size_t k = 0; k < kCoefficientCount; ++k)
    RC_ASSERT(std::fabs((ahead.value[k] - behind.value[k]) / (2.0 * step) - p.slope[k]) < 1e-7);
}

TEST(Legendre, AreThoseOfTheTables) {
  const double theta = rad_from_deg(37.0), c = std::cos(theta), s = std::sin(theta);
  const LegendreTable p = legendre_table(c, s);
  EXPECT_NEAR(p.value[coefficient_index(1, 0)], c, 1e-15);
  EXPECT_NEAR(p.value[coefficient_index(1, 1)], s, 1e-15);
  EXPECT_NEAR(p.value[coefficient_index(2, 0)], 1.5 * c * c - 0.5, 1e-15);
  EXPECT_NEAR(p.value[coefficient_index(2, 1)], std::sqrt(3.0) * c * s, 1e-15);
  EXPECT_NEAR(p.value[coefficient_index(2, 2)], std::sqrt(3.0) / 2.0 * s * s, 1e-15);
  EXPECT_NEAR(p.value[coefficient_index(3, 2)], std::sqrt(15.0) / 2.0 * s * s * c, 1e-15);
}

RC_GTEST_PROP(EllipsoidLaw, ThereAndBack, ()) {
  Place place{*rc::gen::inRange(-90000, 90001) / 1000.0, *rc::gen::inRange(-180000, 180001) / 1000.0,
              *rc::gen::inRange(-15000, 850001) * 1.0};
  if (*rc::gen::inRange(0, 5) == 0) place.latitude_deg = *rc::gen::element(90.0, -90.0, 0.0, 89.999999, -1e-9);
  const Place back = geodetic_of(geocentric_of(place));
  RC_ASSERT(std::fabs(back.latitude_deg - place.latitude_deg) < 1e-10);
  RC_ASSERT(std::fabs(back.longitude_deg - place.longitude_deg) < 1e-10);
  RC_ASSERT(std::fabs(back.height_m - place.height_m) < 1e-6);
}

TEST(Ellipsoid, HasItsRadii) {
  EXPECT_NEAR(geocentric_of({0.0, 0.0, 0.0}).radius_m, 6378137.0, 1e-9);
  EXPECT_NEAR(geocentric_of({90.0, 12.0, 0.0}).radius_m, 6356752.314245, 1e-6);
  EXPECT_EQ(geocentric_of({90.0, 12.0, 0.0}).sin_colatitude, 0.0);
  EXPECT_EQ(geocentric_of({-90.0, 12.0, 5.0}).sin_colatitude, 0.0);
}

}  // namespace
}  // namespace ellipsoid_test
