#include "plumb/findings/followed_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plumb/findings/temperature_gaps.hpp"

namespace followed_direction_test {
namespace {

using namespace plumb;

struct Recording {
  std::vector<Station> stations;
  std::vector<SeenAttitude> attitudes;
};

/// Eight attitudes about the y axis; the temperature by the direction of gravity.
template <class Temperature>
Recording recording(Temperature temperature_degc) {
  Recording out;
  for (int k = 0; k < 8; ++k) {
    SeenAttitude seen;
    seen.direction = {std::cos(0.7 * k), 0.0, std::sin(0.7 * k)};
    Station station;
    station.temperature_degc = temperature_degc(k, seen.direction);
    out.stations.push_back(station);
    out.attitudes.push_back(seen);
  }
  return out;
}

TEST(FollowedDirection, IsThatByWhichTheTemperatureIsKnown) {
  const Recording r = recording([](int, const Vec3& down) { return 60.0 - 20.0 * down[2]; });
  const findings::FollowedDirection found = findings::followed_direction(1, r.stations, r.attitudes);
  EXPECT_EQ(found.axis, 'z');
  EXPECT_NEAR(found.correlation, -1.0, 1e-9);
}

TEST(FollowedDirection, IsNoneWhereTheTemperatureGoesItsOwnWay) {
  const Recording r = recording([](int k, const Vec3&) { return k % 2 == 0 ? 20.0 : 80.0; });
  EXPECT_EQ(findings::followed_direction(1, r.stations, r.attitudes).axis, 0);
}

TEST(FollowedDirection, IsNotSoughtWhereNoDriftWasEstimated) {
  const Recording r = recording([](int, const Vec3& down) { return 60.0 - 20.0 * down[2]; });
  EXPECT_EQ(findings::followed_direction(0, r.stations, r.attitudes).axis, 0);
}

Station between(double begin_s, double end_s) {
  Station out;
  out.begin_s = begin_s;
  out.end_s = end_s;
  return out;
}

TEST(TemperatureGaps, CoverAStationInAGapWithADifferentTemperatureBehindIt) {
  findings::TemperatureGaps gaps;
  gaps.add(0.0, 20.0, false);
  gaps.add(1.0, 20.0, true);
  gaps.add(9.0, 20.0, true);
  gaps.add(10.0, 40.0, false);
  gaps.add(11.0, 40.0, true);
  gaps.add(19.0, 40.0, true);
  gaps.add(20.0, 41.0, false);
  gaps.finish();
  EXPECT_TRUE(gaps.cover(between(2.0, 8.0)));
  EXPECT_FALSE(gaps.cover(between(2.0, 10.0)));
  EXPECT_FALSE(gaps.cover(between(12.0, 18.0)));
}

TEST(TemperatureGaps, CoverAStationBehindTheLastTemperature) {
  findings::TemperatureGaps gaps;
  gaps.add(0.0, 20.0, false);
  gaps.add(1.0, 20.0, true);
  gaps.add(9.0, 20.0, true);
  gaps.finish();
  EXPECT_TRUE(gaps.cover(between(1.0, 9.0)));
}

}  // namespace
}  // namespace followed_direction_test
