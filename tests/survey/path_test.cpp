// Minimum curvature against circles, straight lines and its own laws.
#include "plumb/survey/path.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "plumb/core/units.hpp"

namespace path_test {
namespace {

using namespace plumb;
using namespace plumb::survey;

TEST(SurveyPath, OfAQuarterCircleIsItsRadius) {
  const double radius = 300.0, arc = 0.5 * kPi * radius;
  const auto path = minimum_curvature({{1000.0, 0.0, true, 0.0}, {1000.0 + arc, 0.5 * kPi, true, rad_from_deg(30.0)}});
  ASSERT_TRUE(path.has_value()) << path.error().text();
  EXPECT_NEAR((*path)[1].north_m, radius * std::cos(rad_from_deg(30.0)), 1e-9);
  EXPECT_NEAR((*path)[1].east_m, radius * 0.5, 1e-9);
  EXPECT_NEAR((*path)[1].tvd_m, 1000.0 + radius, 1e-9);
  EXPECT_NEAR((*path)[1].dogleg_deg_per_30m, 90.0 * 30.0 / arc, 1e-9);
}

/// Worked example of the literature on minimum curvature: 15 deg at 20 deg azimuth, 100 units on 25 deg at 45 deg.
TEST(SurveyPath, IsThatOfTheTextbook) {
  const auto path = minimum_curvature(
      {{3500.0, rad_from_deg(15.0), true, rad_from_deg(20.0)}, {3600.0, rad_from_deg(25.0), true, rad_from_deg(45.0)}});
  ASSERT_TRUE(path.has_value());
  EXPECT_NEAR((*path)[1].north_m, 27.22, 5e-3);
  EXPECT_NEAR((*path)[1].east_m, 19.45, 5e-3);
  EXPECT_NEAR((*path)[1].tvd_m - 3500.0, 94.01, 5e-3);
}

PathStation any_station(double md_m) {
  return {md_m, *rc::gen::inRange(0, 1801) * kPi / 1800.0, true, *rc::gen::inRange(0, 3600) * kPi / 1800.0};
}

RC_GTEST_PROP(SurveyPathLaw, ChordAndArcBelongToOneCircle, ()) {
  const double length = *rc::gen::inRange(1, 3000) / 10.0;
  const PathStation a = any_station(100.0), b = any_station(100.0 + length);
  const auto path = minimum_curvature({a, b});
  RC_PRE(path.has_value());  // straight back there is no one circle
  const PathPoint& p = (*path)[1];
  const double chord = std::hypot(std::hypot(p.north_m, p.east_m), p.tvd_m - 100.0), half = 0.5 * p.dogleg_rad;
  RC_ASSERT(std::fabs(chord - (half > 0.0 ? length * std::sin(half) / half : length)) < 1e-8 * length / std::cos(half));
  RC_ASSERT(chord <= length * (1.0 + 1e-12));
}

RC_GTEST_PROP(SurveyPathLaw, TheWayBackIsTheSame, ()) {
  const PathStation a = any_station(0.0), b = any_station(30.0), c = any_station(75.0);
  const auto there = minimum_curvature({a, b, c});
  const auto turned = [](PathStation s, double md_m) {
    s.md_m = md_m;
    s.inclination_rad = kPi - s.inclination_rad;
    s.azimuth_rad += kPi;
    return s;
  };
  const auto back = minimum_curvature({turned(c, 0.0), turned(b, 45.0), turned(a, 75.0)});
  RC_ASSERT(there.has_value() == back.has_value());
  if (!there) return;
  RC_ASSERT(std::fabs(there->back().north_m + back->back().north_m) < 1e-6);
  RC_ASSERT(std::fabs(there->back().east_m + back->back().east_m) < 1e-6);
  RC_ASSERT(std::fabs(there->back().tvd_m + back->back().tvd_m) < 1e-6);
}

TEST(SurveyPath, LosesNoDigitsInStraightHoles) {
  for (const double turn : {0.0, 1e-16, 1e-12, 1e-9, 1e-8, 1e-6, 1e-4, 0.0199, 0.0201}) {
    const auto path = minimum_curvature({{0.0, 1.0, true, 0.0}, {30.0, 1.0 + turn, true, 0.0}});
    ASSERT_TRUE(path.has_value());
    const PathPoint& p = (*path)[1];
    EXPECT_NEAR(p.dogleg_rad, turn, 1e-15 + 1e-9 * turn);
    const double factor = turn > 0.0 ? std::sin(0.5 * turn) / (0.5 * turn) : 1.0;
    EXPECT_NEAR(std::hypot(p.north_m, p.tvd_m), 30.0 * factor, 1e-12);
    EXPECT_NEAR(p.dogleg_deg_per_30m, deg_from_rad(turn), 1e-9);
  }
}

TEST(SurveyPath, TakesAStationThatIsVerticalWithoutAzimuth) {
  const auto path =
      minimum_curvature({{0.0, 0.001, false, 99.0}, {30.0, 0.002, false, std::nan("")}, {60.0, 0.1, true, 1.0}});
  ASSERT_TRUE(path.has_value()) << path.error().text();
  EXPECT_EQ((*path)[1].north_m, 0.0);
  EXPECT_EQ((*path)[1].tvd_m, 30.0);
  EXPECT_NEAR((*path)[2].dogleg_rad, 0.1, 1e-12);
}

void expect_refused(const std::vector<PathStation>& stations, const char* text) {
  const auto path = minimum_curvature(stations);
  ASSERT_FALSE(path.has_value()) << text;
  EXPECT_NE(path.error().what.find(text), std::string::npos) << path.error().text();
  EXPECT_FALSE(path.error().remedy.empty());
}

TEST(SurveyPath, RefusesWhatIsNoPath) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused({}, "no station");
  expect_refused({{nan, 0.0, true, 0.0}}, "not finite");
  expect_refused({{0.0, 0.0, true, nan}}, "not finite");
  expect_refused({{0.0, 3.2, true, 0.0}}, "inclination of 183");
  expect_refused({{0.0, -0.1, true, 0.0}}, "inclination of -5.7");
  expect_refused({{0.0, 0.5, false, 0.0}}, "has no azimuth");
  expect_refused({{10.0, 0.5, true, 0.0}, {10.0, 0.5, true, 0.0}}, "does not lie below");
  expect_refused({{0.0, 0.5 * kPi, true, 0.0}, {10.0, 0.5 * kPi, true, kPi}}, "180 deg");
  expect_refused({{0.0, 0.0, true, 0.0}, {10.0, kPi, true, 1.0}}, "180 deg");
  expect_refused({{0.0, 0.0, false, 0.0}, {10.0, kPi, false, 1.0}}, "180 deg");
  EXPECT_TRUE(minimum_curvature({{0.0, 0.5 * kPi, true, 0.0}, {10.0, 0.5 * kPi, true, kPi - 1e-5}}).has_value());
}

}  // namespace
}  // namespace path_test
