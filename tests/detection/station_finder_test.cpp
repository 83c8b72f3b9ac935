// Where a station begins and ends, and what of a stretch is kept as one.
#include <gtest/gtest.h>

#include <vector>

#include "plumb/detection/stationarity.hpp"
#include "support/simulated_tool.hpp"

namespace station_finder_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

constexpr double kSigma = 2e-4 * kG0_mps2;

/// A stream into a finder, a sample at a time.
struct Stream {
  explicit Stream(StationFinder::Settings settings = {})
      : array(plumb_test::cone_array(5, kSigma)), finder(array, kG0_mps2, settings) {}
  int feed(const Vec3& u, int samples, SensorSet usable = SensorSet::first(5)) {
    int ended = 0;
    for (int k = 0; k < samples; ++k) {
      Sample s;
      s.time_s = t += 0.01;
      s.station = tag;
      s.delivered = usable;
      Readings y{};
      for (int i = 0; i < 5; ++i) {
        const auto a = static_cast<std::size_t>(i);
        y[a] = s.raw[a] = dot(array.axis(i), u) * kG0_mps2 + kSigma * noise.normal();
      }
      if (finder.add(s, y, usable, last)) ++ended;
    }
    return ended;
  }
  SensorArray array;
  StationFinder finder;
  Noise noise{12};
  double t = 0.0;
  std::uint32_t tag = 0;
  Station last;
};

const Vec3 kDown = {0.0, 0.0, 1.0}, kAcross = {1.0, 0.0, 0.0};

// Verifies: REQ-039
TEST(StationFinder, FindsStretchesAtRestBetweenMotionAndKeepsTheirMeans) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  StationFinder finder(array, kG0_mps2, {});
  Noise noise(9);
  std::vector<Station> found;
  std::vector<Vec3> truth;
  double t = 0.0;
  const auto feed = [&](const Vec3& u, double rms, int samples) {
    for (int k = 0; k < samples; ++k) {
      Sample s;
      s.time_s = t += 0.01;
      s.delivered = array.all();
      Readings y{};
      for (int i = 0; i < 4; ++i) {
        const auto a = static_cast<std::size_t>(i);
        s.raw[a] = dot(array.axis(i), u) * kG0_mps2 + (kSigma + rms) * noise.normal();
        y[a] = s.raw[a];
      }
      Station st;
      if (finder.add(s, y, array.all(), st)) found.push_back(st);
    }
  };
  for (int k = 0; k < 6; ++k) {
    const Vec3 u = plumb_test::random_direction(noise);
    truth.push_back(u);
    feed(u, 0.0, 400);
    feed(u, 1.0, 100);
  }
  Station st;
  if (finder.finish(st)) found.push_back(st);
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_GE(found[k].count, 256U);
    for (int i = 0; i < 4; ++i) {
      const auto a = static_cast<std::size_t>(i);
      EXPECT_NEAR(found[k].mean[a], dot(array.axis(i), truth[k]) * kG0_mps2, 5 * kSigma / 16.0);
      EXPECT_NEAR(found[k].scatter[a], kSigma, 0.3 * kSigma);
    }
  }
}

// Negative: REQ-039
TEST(StationFinder, TagsSeparateStationsWithoutMotion) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  StationFinder finder(array, kG0_mps2, {});
  Noise noise(10);
  int found = 0;
  Station st;
  for (int k = 0; k < 3 * 128; ++k) {
    Sample s;
    s.time_s = 0.01 * k;
    s.station = static_cast<std::uint32_t>(1 + k / 128);
    Readings y{};
    for (int i = 0; i < 4; ++i) y[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2 + kSigma * noise.normal();
    found += finder.add(s, y, array.all(), st) ? 1 : 0;
  }
  found += finder.finish(st) ? 1 : 0;
  EXPECT_EQ(found, 3);
}

// Negative: REQ-039
TEST(StationFinder, AnotherRollGroupEndsAStationLikeAnotherTag) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  StationFinder finder(array, kG0_mps2, {});
  Noise noise(11);
  std::vector<std::uint32_t> groups;
  Station st;
  for (int k = 0; k < 3 * 192; ++k) {
    Sample s;
    s.time_s = 0.01 * k;
    s.roll_group = static_cast<std::uint32_t>(5 + k / 192);
    Readings y{};
    for (int i = 0; i < 4; ++i) y[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2 + kSigma * noise.normal();
    if (finder.add(s, y, array.all(), st)) groups.push_back(st.roll_group);
  }
  if (finder.finish(st)) groups.push_back(st.roll_group);
  EXPECT_EQ(groups, (std::vector<std::uint32_t>{5, 6, 7}));
}

// Verifies: REQ-039
TEST(StationFinder, ABreakInTimeEndsAStation) {
  for (const double step_s : {60.0, -1.0}) {
    Stream s;
    EXPECT_EQ(s.feed(kDown, 300), 0);
    s.t += step_s;
    EXPECT_EQ(s.feed(kDown, 300), 1) << step_s;
    EXPECT_TRUE(s.finder.finish(s.last)) << step_s;
  }
}

// Verifies: REQ-039
TEST(StationFinder, AnotherTagInTheMiddleOfABlockEndsAStation) {
  Stream s;
  s.tag = 1;
  EXPECT_EQ(s.feed(kDown, 300), 0);
  s.tag = 2;
  EXPECT_EQ(s.feed(kDown, 10), 1);
  EXPECT_EQ(s.last.tag, 1U);
  s.tag = 3;  // before the second had a block
  EXPECT_EQ(s.feed(kDown, 300), 0);
  EXPECT_TRUE(s.finder.finish(s.last));
  EXPECT_EQ(s.last.tag, 3U);
}

// Verifies: REQ-039
TEST(StationFinder, AnotherDirectionEndsAStationWithoutMotion) {
  Stream s;
  EXPECT_EQ(s.feed(kDown, 320), 0);
  EXPECT_EQ(s.feed(kAcross, 320), 1);
  EXPECT_TRUE(s.finder.finish(s.last));
}

// Negative: REQ-039
TEST(StationFinder, AStretchThatIsTooShortIsNoStation) {
  StationFinder::Settings settings;
  settings.min_blocks = 5;
  Stream s(settings);
  EXPECT_EQ(s.feed(kDown, 4 * 32), 0);
  EXPECT_FALSE(s.finder.finish(s.last));
}

// Negative: REQ-039
TEST(StationFinder, AChannelThatDoesNotDeliverIsNotUsed) {
  Stream s;
  EXPECT_EQ(s.feed(kDown, 320, SensorSet::first(5).without(3)), 0);
  ASSERT_TRUE(s.finder.finish(s.last));
  EXPECT_EQ(s.last.delivered, SensorSet::first(5).without(3));
  EXPECT_EQ(s.last.mean[3], 0.0);
  EXPECT_NEAR(s.last.mean[0], s.array.axis(0)[2] * kG0_mps2, 5 * kSigma);
}

// Negative: REQ-039
TEST(StationFinder, BlocksOfOneSampleHaveNoScatter) {
  StationFinder::Settings settings;
  settings.block = 1;
  Stream s(settings);
  s.feed(kDown, 12);
  ASSERT_TRUE(s.finder.finish(s.last));
  EXPECT_EQ(s.last.scatter[0], 0.0);
}

/// Means of one sample each: the one with the next tag ends the station before it, and is a block by itself.
// Verifies: REQ-039
TEST(StationFinder, OfBlocksOfOneSampleANewTagEndsTheStation) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  StationFinder::Settings settings;
  settings.block = 1;
  settings.min_blocks = 2;
  StationFinder finder(array, kG0_mps2, settings);
  Station finished;
  int found = 0;
  for (int k = 0; k < 12; ++k) {
    Sample sample;
    sample.time_s = 0.01 * k;
    sample.delivered = array.all();
    sample.station = static_cast<std::uint32_t>(1 + k / 6);
    sample.temperature_degc = 25.0;
    const Vec3 u = plumb_test::direction_at(40, k < 6 ? 20 : 120);
    Readings y{};
    for (int i = 0; i < 4; ++i) y[static_cast<std::size_t>(i)] = dot(array.axis(i), u) * kG0_mps2;
    sample.raw = y;
    const bool written = finder.add(sample, y, array.all(), finished);
    found += written ? 1 : 0;
    EXPECT_EQ(written, k == 6) << k;
  }
  EXPECT_EQ(found, 1);
  EXPECT_EQ(finished.tag, 1U);
}

}  // namespace
}  // namespace station_finder_test
