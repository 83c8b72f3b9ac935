// The temperatures of stations sorted into levels, and which of them are missing.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "plumb/calibration/temperature_fit.hpp"

namespace temperature_levels_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<plumb::Station> at_degc(const std::vector<double>& degc) {
  std::vector<plumb::Station> out;
  for (const double t : degc) {
    plumb::Station s;
    s.count = 1;
    s.temperature_degc = t;
    out.push_back(s);
  }
  return out;
}

plumb::TemperatureLevels levels_at(const std::vector<plumb::Station>& stations) {
  return plumb::temperature_levels(stations.data(), static_cast<int>(stations.size()));
}

TEST(TemperatureLevels, OfMoreThanAreKeptTheLowestAreKept) {
  std::vector<double> degc;
  for (int k = 0; k < plumb::kMaxTemperatureLevels + 4; ++k) degc.push_back(-100.0 + 20.0 * k);
  const plumb::TemperatureLevels levels = levels_at(at_degc(degc));
  EXPECT_EQ(levels.count, plumb::kMaxTemperatureLevels);
  EXPECT_EQ(levels.degc[0], -100.0);
  EXPECT_EQ(levels.highest_degc, degc.back());
}

TEST(TemperatureLevels, WhereEveryStationIsAloneTheLevelsAreTheSpan) {
  auto stations = at_degc({20.0, 60.0, 100.0, kNan});
  const plumb::TemperatureLevels levels = levels_at(stations);
  const plumb::ChebyshevSpan span = plumb::confirmed_span(stations.data(), 4, levels);
  EXPECT_EQ(span.lowest, 20.0);
  EXPECT_EQ(span.highest, 100.0);
  stations[1].count = 0;
  EXPECT_EQ(plumb::confirmed_span(stations.data(), 4, levels).highest, 100.0);
}

TEST(TemperatureLevels, TheFullestMayBeAnyOfThem) {
  const auto stations = at_degc({20.0, 60.0, 61.0, 100.0});
  const plumb::ChebyshevSpan span = plumb::fullest_level(stations.data(), 4, levels_at(stations));
  EXPECT_EQ(span.lowest, 60.0);
  EXPECT_EQ(span.highest, 61.0);
}

TEST(TemperatureLevels, NoMoreAreAskedForThanThereIsRoomToSay) {
  std::array<double, plumb::kMaxTemperatureOrder + 1> degc{};
  const plumb::TemperatureLevels none;
  EXPECT_EQ(plumb::missing_levels(none, {20.0, 150.0}, 20, degc), plumb::kMaxTemperatureOrder + 1);
  for (std::size_t k = 1; k < degc.size(); ++k) EXPECT_GT(degc[k], degc[k - 1]);
  const auto stations = at_degc({20.0, 20.0});
  EXPECT_EQ(plumb::missing_levels(levels_at(stations), {20.0, 150.0}, 4, degc), 3);
  EXPECT_LT(degc[0], degc[1]);
  EXPECT_LT(degc[1], degc[2]);
}

}  // namespace
}  // namespace temperature_levels_test
