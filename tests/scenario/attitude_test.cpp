#include "plumb/scenario/attitude.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plumb/core/units.hpp"

namespace plumb {
namespace scenario {
namespace attitude_test {
namespace {

double inclination_of(const Vec3& g) { return std::atan2(std::hypot(g[0], g[1]), g[2]); }
double toolface_of(const Vec3& g) {
  const double tau = std::atan2(-g[0], -g[1]);
  return tau < 0.0 ? tau + 2.0 * kPi : tau;
}

TEST(Attitude, DirectionFollowsTheDrillersFormula) {
  for (const double inclination_deg : {0.5, 5.0, 45.0, 90.0, 135.0, 179.0}) {
    for (const double toolface_deg : {0.0, 30.0, 137.5, 270.0, 359.0}) {
      const Vec3 g = gravity_direction({rad_from_deg(inclination_deg), 1.0, rad_from_deg(toolface_deg)});
      EXPECT_NEAR(norm(g), 1.0, 4e-16);
      EXPECT_NEAR(deg_from_rad(inclination_of(g)), inclination_deg, 1e-12);
      EXPECT_NEAR(std::remainder(deg_from_rad(toolface_of(g)) - toolface_deg, 360.0), 0.0, 1e-11);
    }
  }
  const Vec3 down_hole = gravity_direction({});
  EXPECT_EQ(down_hole[2], 1.0);
}

TEST(Attitude, LawsGiveTheirStations) {
  EXPECT_EQ(directions_of(FixedAttitude{}, 1)->size(), 1U);
  EXPECT_EQ(directions_of(DirectionList{{{1, 0, 0}, {0, 1, 0}}}, 1)->size(), 2U);
  EXPECT_EQ(directions_of(RandomStations{48}, 1)->size(), 48U);
  const auto roll = *directions_of(RollTest{rad_from_deg(60.0), 8, 0.0}, 1);
  ASSERT_EQ(roll.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(deg_from_rad(inclination_of(roll[k])), 60.0, 1e-12);
    EXPECT_NEAR(std::remainder(deg_from_rad(toolface_of(roll[k])) - 45.0 * static_cast<double>(k), 360.0), 0.0, 1e-11);
  }
}

TEST(Attitude, DrillingPathBuildsAndTurns) {
  const DrillingPath path;
  const auto stations = *directions_of(path, 1);
  ASSERT_EQ(stations.size(), 14U);
  EXPECT_NEAR(deg_from_rad(inclination_of(stations.front())), 5.0, 1e-12);
  EXPECT_NEAR(deg_from_rad(inclination_of(stations.back())), 60.0, 1e-12);
  for (std::size_t k = 1; k < stations.size(); ++k) {
    EXPECT_GT(inclination_of(stations[k]), inclination_of(stations[k - 1]));
    EXPECT_GT(deg_from_rad(angle_between_rad(stations[k], stations[k - 1])), 2.0) << "plumb tells stations by 2 deg";
  }
  DrillingPath shaky = path;
  shaky.toolface_jitter_rad = 0.1;
  EXPECT_NE(*directions_of(shaky, 1), stations);
  EXPECT_NE(*directions_of(shaky, 1), *directions_of(shaky, 2));
  EXPECT_EQ(*directions_of(shaky, 1), *directions_of(shaky, 1));
  const Attitude last = attitude_at(path, 13, Stream(1, Purpose::attitude));
  EXPECT_NEAR(deg_from_rad(last.azimuth_rad), 19.5, 1e-12);
}

TEST(Attitude, RandomStationsDependOnTheSeedAlone) {
  EXPECT_EQ(*directions_of(RandomStations{20}, 7), *directions_of(RandomStations{20}, 7));
  EXPECT_NE(*directions_of(RandomStations{20}, 7), *directions_of(RandomStations{20}, 8));
  const auto few = *directions_of(RandomStations{5}, 7);
  const auto many = *directions_of(RandomStations{20}, 7);
  for (std::size_t k = 0; k < few.size(); ++k) EXPECT_EQ(few[k], many[k]) << "more stations, same first ones";
}

TEST(Attitude, BadLawsAreRefusedWithARemedy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const AttitudeLaw bad[] = {DirectionList{},
                             DirectionList{{{0, 0, 2}}},
                             FixedAttitude{{nan, 0, 0}},
                             RandomStations{0},
                             RollTest{nan, 8, 0.0},
                             RollTest{1.0, -1, 0.0},
                             DrillingPath{0, {}, 0, 0, 0, 0},
                             DrillingPath{3, {}, nan, 0, 0, 0}};
  for (const AttitudeLaw& law : bad) {
    const auto directions = directions_of(law, 1);
    ASSERT_FALSE(directions) << law.index();
    EXPECT_NE(directions.error().find("Remedy: "), std::string::npos) << directions.error();
  }
}

TEST(Passage, GoesTheShortWayAtUnitLength) {
  const Stream stream(5, Purpose::test);
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Vec3 from = stream.direction(2 * k);
    const Vec3 to = stream.direction(2 * k + 1);
    const Passage passage(from, to);
    EXPECT_NEAR(passage.angle_rad(), angle_between_rad(from, to), 1e-14);
    double gone = 0.0;
    for (int step = 1; step <= 100; ++step) {
      const Vec3 here = passage.at(0.01 * step);
      EXPECT_NEAR(norm(here), 1.0, 1e-14);
      gone += angle_between_rad(passage.at(0.01 * (step - 1)), here);
    }
    EXPECT_NEAR(gone, passage.angle_rad(), 1e-12);
    EXPECT_LT(norm(minus(passage.at(0.0), from)), 1e-15);
    EXPECT_LT(norm(minus(passage.at(1.0), to)), 1e-14);
  }
}

TEST(Passage, HoldsStillAndTurnsRound) {
  const Vec3 down = {0.0, 0.0, 1.0};
  EXPECT_EQ(Passage(down, down).angle_rad(), 0.0);
  EXPECT_EQ(Passage(down, down).at(0.5), down);
  const Passage round(down, {0.0, 0.0, -1.0});
  EXPECT_NEAR(round.angle_rad(), kPi, 1e-14);
  EXPECT_NEAR(round.at(0.5)[2], 0.0, 1e-14);
  EXPECT_NEAR(round.at(1.0)[2], -1.0, 1e-14);
}

TEST(Passage, StartsAndEndsGently) {
  const Passage passage({0.0, 0.0, 1.0}, {1.0, 0.0, 0.0});
  const double first = angle_between_rad(passage.at(0.0), passage.at(0.01));
  const double middle = angle_between_rad(passage.at(0.5), passage.at(0.51));
  EXPECT_LT(first, 0.05 * middle);
}

TEST(Perpendicular, IsPerpendicularEverywhere) {
  const Stream stream(6, Purpose::test);
  for (std::uint64_t k = 0; k < 1000; ++k) {
    const Vec3 v = stream.direction(k);
    EXPECT_NEAR(dot(v, perpendicular_to(v)), 0.0, 1e-15);
    EXPECT_NEAR(norm(perpendicular_to(v)), 1.0, 4e-16);
  }
  for (const Vec3& v : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
    EXPECT_EQ(dot(v, perpendicular_to(v)), 0.0);
  }
}

}  // namespace
}  // namespace attitude_test
}  // namespace scenario
}  // namespace plumb
