#include "plumb/scenario/library.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace plumb {
namespace scenario {
namespace library_test {
namespace {

double inclination_deg(const Vec3& g) { return deg_from_rad(std::atan2(std::hypot(g[0], g[1]), g[2])); }

TEST(Library, PaperDatasheetIsTheTetrahedronInVolts) {
  const Datasheet sheet = paper_datasheet();
  ASSERT_EQ(sheet.size, 4);
  EXPECT_STREQ(sheet.sensor[1].row.id.data(), "a2");
  // Parity of eq (16): h1 + h2 + h3 - h4 = 0.
  Vec3 parity = scaled(sheet.sensor[3].row.axis, -1.0);
  for (std::size_t i = 0; i < 3; ++i) parity = plus(parity, sheet.sensor[i].row.axis);
  EXPECT_LT(norm(parity), 1e-15);
  EXPECT_DOUBLE_EQ(sheet.sensor[0].coefficients.scale[0] * kG0_mps2, 3.0);
}

TEST(Library, CalibrationRunHas48TaggedAttitudes) {
  auto run = *Simulator::make(calibration_run(paper_tool(1), 1));
  EXPECT_EQ(run.size(), 48U * 200U);
  Sample sample;
  std::uint32_t last = 0;
  double last_s = -1.0;
  while (run.next(sample)) {
    EXPECT_FALSE(run.truth().moving);
    EXPECT_TRUE(sample.station == last || sample.station == last + 1);
    EXPECT_GT(sample.time_s, last_s);
    last = sample.station;
    last_s = sample.time_s;
    for (std::size_t i = 0; i < 4; ++i) ASSERT_LT(std::abs(sample.raw[i]), 0.7 * kPaperFullScale_V);
  }
  EXPECT_EQ(last, 48U);
}

/// Sample standard deviation of channel i over rows [begin, end).
double scatter(const Simulator& run, std::uint64_t begin, std::uint64_t end, std::size_t i) {
  double sum = 0.0;
  double square = 0.0;
  const double first = run.at(begin).raw[i];
  for (std::uint64_t row = begin; row < end; ++row) {
    const double v = run.at(row).raw[i] - first;
    sum += v;
    square += v * v;
  }
  const auto n = static_cast<double>(end - begin);
  return std::sqrt((square - sum * sum / n) / (n - 1.0));
}

TEST(Library, DrillingRunAlternatesRestAndMotion) {
  const auto run = *Simulator::make(drilling_run(paper_tool(1), 1));
  ASSERT_EQ(run.size(), 14U * 200U + 13U * 100U);
  EXPECT_NEAR(run.duration_s(), 40.99, 1e-9);
  const double sigma = kPaperNoise_mps2 * kPaperScale_VpMps2;
  for (std::uint64_t station = 0; station < 14; ++station) {
    const std::uint64_t begin = station * 300;
    Truth truth;
    run.at(begin + 199, &truth);
    EXPECT_FALSE(truth.moving);
    EXPECT_EQ(truth.station, station + 1);
    EXPECT_NEAR(inclination_deg(truth.gravity_mps2), 5.0 + 55.0 / 13.0 * static_cast<double>(station), 1e-9);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(scatter(run, begin, begin + 200, i) / sigma, 1.0, 0.3);
    if (station == 13) break;
    run.at(begin + 200, &truth);
    EXPECT_TRUE(truth.moving);
    EXPECT_EQ(truth.station, station + 1) << "motion belongs to the station left behind";
    EXPECT_EQ(run.at(begin + 200).station, 0U) << "no tags: plumb finds the stations";
    for (std::size_t i = 0; i < 4; ++i) EXPECT_GT(scatter(run, begin + 200, begin + 300, i) / sigma, 50.0);
  }
}

TEST(Library, MotionJoinsTheStationsSmoothly) {
  const auto run = *Simulator::make(drilling_run(paper_tool(1), 1));
  Truth before;
  Truth after;
  run.at(0, &before);
  for (std::uint64_t row = 1; row < run.size(); ++row) {
    run.at(row, &after);
    const double step_deg = deg_from_rad(angle_between_rad(before.gravity_mps2, after.gravity_mps2));
    const double allowed_deg = after.moving || before.moving ? 2.5 : 1e-12;
    EXPECT_LE(step_deg, allowed_deg) << row;
    before = after;
  }
}

TEST(Library, SensorGetsStuckAtItsStationForGood) {
  const auto run = *Simulator::make(drilling_run(paper_tool(1), 1, {dead_at_station(1, 6)}));
  const std::uint64_t onset = 5 * 300;
  for (std::uint64_t row = 0; row < run.size(); ++row) {
    Truth truth;
    const Sample sample = run.at(row, &truth);
    EXPECT_EQ(truth.faulty, row >= onset ? SensorSet::of(1) : SensorSet());
    EXPECT_EQ(sample.raw[1] == 0.0, row >= onset) << row;
  }
}

// Pinned: the demo's logs, the reference figures of the tests and the docs come from these bits.
TEST(Library, DemoLogsArePinned) {
  const auto hash_of = [](const Scenario& scenario) {
    auto run = *Simulator::make(scenario);
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    Sample sample;
    while (run.next(sample)) {
      for (std::size_t i = 0; i < 4; ++i) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &sample.raw[i], sizeof bits);
        hash = (hash ^ bits) * 0x100000001b3ULL;
      }
    }
    return hash;
  };
  const Tool tool = paper_tool(1);
  EXPECT_EQ(hash_of(calibration_run(tool, 1)), 4745016575087532837ULL);
  EXPECT_EQ(hash_of(drilling_run(tool, 1, {dead_at_station(1, 6)})), 6732220743714890853ULL);
}

}  // namespace
}  // namespace library_test
}  // namespace scenario
}  // namespace plumb
