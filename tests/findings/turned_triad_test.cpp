// A whole triad mounted turned, or with its axes named in another frame: told as that, not as a faulty sensor.
#include "plumb/findings/turned_triad.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "plumb/findings/second_look.hpp"
#include "plumb/io/array_file.hpp"

namespace turned_triad_test {
namespace {

using namespace plumb;
using findings::TurnedTriad;

/// `triads` parallel ones, x1 y1 z1 x2 ...
io::ArrayFile parallel(int triads) {
  io::ArrayFile out;
  std::vector<SensorRow> rows;
  out.datasheet.size = 3 * triads;
  for (int i = 0; i < 3 * triads; ++i) {
    SensorRow row;
    const std::string id = std::string(1, "xyz"[i % 3]) + std::to_string(i / 3 + 1);
    std::copy(id.begin(), id.end(), row.id.begin());
    row.axis = {i % 3 == 0 ? 1.0 : 0.0, i % 3 == 1 ? 1.0 : 0.0, i % 3 == 2 ? 1.0 : 0.0};
    row.sigma_mps2 = 2e-3;
    rows.push_back(row);
    DatasheetSensor& sheet = out.datasheet.sensor[static_cast<std::size_t>(i)];
    sheet.row = row;
    sheet.coefficients.scale = {3.0 + 0.1 * i, 0, 0, 0};
    sheet.coefficients.bias = {0.02 * i, 0, 0, 0};
  }
  out.array = *SensorArray::make(rows.data(), out.datasheet.size);
  return out;
}

/// 40 stations of a tool whose axes, scales and biases lie within the datasheet's; `wrong` is how one triad is mounted.
std::vector<Station> recorded(const io::ArrayFile& array, const TurnedTriad& wrong, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&random](double most) {
    return most * (2.0 * static_cast<double>(random()) / 4294967296.0 - 1.0);
  };
  const auto n = static_cast<std::size_t>(array.datasheet.size);
  std::vector<Vec3> axis(n);
  std::vector<double> scale(n), bias(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = plus(array.array.axis(static_cast<int>(i)), {uniform(0.02), uniform(0.02), uniform(0.02)});
    axis[i] = scaled(a, 1.0 / norm(a));
    scale[i] = array.datasheet.sensor[i].coefficients.scale[0] * (1.0 + uniform(0.02));
    bias[i] = array.datasheet.sensor[i].coefficients.bias[0] + uniform(0.2);
  }
  std::vector<Vec3> mounted = axis;
  for (std::size_t k = 0; k < 3; ++k)
    mounted[static_cast<std::size_t>(wrong.sensor[k])] =
        scaled(axis[static_cast<std::size_t>(wrong.sensor[static_cast<std::size_t>(wrong.source[k])])], wrong.sign[k]);
  std::vector<Station> out;
  for (int s = 0; s < 40; ++s) {
    const Vec3 d = {uniform(1.0), uniform(1.0), uniform(1.0)};
    const Vec3 g = scaled(d, array.gravity.g_mps2 / norm(d));
    Station station;
    station.delivered = array.array.all();
    station.temperature_degc = 25.0;
    station.count = 100;
    for (std::size_t i = 0; i < n; ++i) station.mean[i] = scale[i] * (dot(mounted[i], g) + bias[i] + uniform(2e-4));
    out.push_back(station);
  }
  return out;
}

findings::SecondLook look_at(const io::ArrayFile& array, const TurnedTriad& wrong, unsigned seed) {
  return findings::second_look(array, recorded(array, wrong, seed), TemperatureOptions{}, nullptr);
}

TEST(TurnedTriad, ThereAre23TurnsAnd24MirrorImages) {
  const std::vector<TurnedTriad> all = findings::turns_of({0, 1, 2});
  ASSERT_EQ(all.size(), 47U);
  EXPECT_EQ(std::count_if(all.begin(), all.end(), findings::is_turn), 23);
  int by_angle[3] = {};
  for (const TurnedTriad& one : all) {
    if (!findings::is_turn(one)) continue;
    const findings::AxisAngle a = findings::axis_of(one);
    ++by_angle[a.deg / 30 == 3 ? 0 : a.deg / 30 == 4 ? 1 : 2];
    EXPECT_NE(a.axis, (std::array<int, 3>{}));
  }
  EXPECT_EQ(by_angle[0], 6);  // quarter turns about three axes, either way
  EXPECT_EQ(by_angle[1], 8);
  EXPECT_EQ(by_angle[2], 9);
}

TEST(TurnedTriad, TheAxisIsThatAboutWhichTheChipWasTurned) {
  // A chip that was turned by 90 deg about z, counterclockwise, has its x where y was and its y where -x was.
  const findings::AxisAngle a = findings::axis_of({{0, 1, 2}, {1, 0, 2}, {1, -1, 1}});
  EXPECT_EQ(a.deg, 90);
  EXPECT_EQ(a.axis, (std::array<int, 3>{0, 0, 1}));
  const findings::AxisAngle ned = findings::axis_of({{0, 1, 2}, {1, 0, 2}, {1, 1, -1}});
  EXPECT_EQ(ned.deg, 180);
  EXPECT_EQ(ned.axis, (std::array<int, 3>{1, 1, 0}));
}

TEST(TurnedTriad, ThreeSensorsInARowAtRightAnglesAreOne) {
  EXPECT_EQ(findings::triads_of(parallel(3).array, {}).size(), 3U);
  const io::ArrayFile cone = *io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml");
  EXPECT_TRUE(findings::triads_of(cone.array, {}).empty());
}

/// x1 x2 y1 y2 z1 z2: none in a row, and two by their packages.
// Verifies: REQ-043
TEST(TurnedTriad, ThePackagesTellTriadsWhereverTheirSensorsStand) {
  std::vector<SensorRow> rows;
  std::vector<std::string> package;
  for (int i = 0; i < 6; ++i) {
    SensorRow row;
    row.id = make_id(("s" + std::to_string(i)).c_str());
    row.axis = {i / 2 == 0 ? 1.0 : 0.0, i / 2 == 1 ? 1.0 : 0.0, i / 2 == 2 ? 1.0 : 0.0};
    row.sigma_mps2 = 2e-3;
    rows.push_back(row);
    package.push_back(i % 2 == 0 ? "imu1" : "imu2");
  }
  const SensorArray array = *SensorArray::make(rows.data(), 6);
  EXPECT_TRUE(findings::triads_of(array, {}).empty());
  EXPECT_EQ(findings::triads_of(array, package),
            (std::vector<std::array<int, 3>>{std::array<int, 3>{0, 2, 4}, std::array<int, 3>{1, 3, 5}}));
  EXPECT_EQ(findings::triads_of(parallel(3).array, std::vector<std::string>(9, "one")).size(), 3U)
      << "named alike by mistake: as they stand";
}

/// Every way to mount the second of three: found, that one alone, with the axes that mend the array file.
// Verifies: REQ-043
TEST(TurnedTriad, EveryTurnAndMirrorImageOfOneOfThreeIsNamed) {
  const io::ArrayFile array = parallel(3);
  int named = 0;
  for (const TurnedTriad& wrong : findings::turns_of({3, 4, 5})) {
    const findings::SecondLook found = look_at(array, wrong, 7);
    ASSERT_TRUE(found.found());
    if (!found.exchanged.empty()) continue;  // one sign, or two columns: told as that
    ASSERT_EQ(found.turned.size(), 1U);
    EXPECT_TRUE(found.turned[0] == wrong);
    ++named;
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = findings::mended_axis(array.array, found.turned[0], k);
      const std::size_t source = static_cast<std::size_t>(3 + wrong.source[static_cast<std::size_t>(k)]);
      EXPECT_EQ(axis, scaled(array.array.axis(static_cast<int>(source)), wrong.sign[static_cast<std::size_t>(k)]));
    }
  }
  EXPECT_GE(named, 40);
}

/// Of two triads either may be the one that is turned, and the tool says so rather than blame one.
// Negative: REQ-043
TEST(TurnedTriad, OfTwoNeitherIsBlamedAlone) {
  const io::ArrayFile array = parallel(2);
  for (const TurnedTriad& wrong : findings::turns_of({3, 4, 5})) {
    const findings::SecondLook found = look_at(array, wrong, 8);
    ASSERT_TRUE(found.found());
    if (!found.exchanged.empty()) continue;
    ASSERT_EQ(found.turned.size(), 2U);
    EXPECT_NE(found.turned[0].sensor, found.turned[1].sensor);
    EXPECT_TRUE(found.turned[0] == wrong || found.turned[1] == wrong);
  }
}

TEST(TurnedTriad, NoneIsNamedWhereNoneIsTurned) {
  const io::ArrayFile array = parallel(2);
  std::vector<Station> stations = recorded(array, TurnedTriad{{3, 4, 5}}, 9);
  for (std::size_t k = 0; k < stations.size(); ++k) stations[k].mean[1] = k % 2 == 0 ? 9.0 : -20.0;  // broken
  EXPECT_TRUE(findings::second_look(array, stations, TemperatureOptions{}, nullptr).turned.empty());
}

}  // namespace
}  // namespace turned_triad_test
