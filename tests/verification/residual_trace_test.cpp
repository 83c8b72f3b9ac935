// What the health report draws of every sensor: its reading beside the others, bounded in size, blind to nothing.
#include "plumb/verification/residual_trace.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/io/array_file.hpp"

namespace residual_trace_test {
namespace {

using namespace plumb;
using verification::ResidualTrace;

constexpr int kWindow = 4;

/// The paper's tool, exact, read in m/s^2.
struct Bench {
  SensorArray array = io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml")->array;
  SensorModel model;
  ResidualTrace trace;
  int samples = 0;

  static SensorModel exact(int n) {
    SensorModel out;
    out.size = n;
    for (int i = 0; i < n; ++i) out.sensor[static_cast<std::size_t>(i)].scale[0] = 1.0;
    return out;
  }
  Bench() : model(exact(array.size())), trace(model, array, kWindow) {}

  /// One block of a tool that stands upright, sensor 1 off by this much.
  void block(double off_mps2, SensorSet in_service = SensorSet::first(4), SensorSet delivered = SensorSet::first(4)) {
    for (int k = 0; k < kWindow; ++k) {
      Sample sample;
      sample.delivered = delivered;
      for (int i = 0; i < array.size(); ++i)
        sample.raw[static_cast<std::size_t>(i)] = kG0_mps2 * array.axis(i)[2] + (i == 1 ? off_mps2 : 0.0);
      Verdict verdict;
      verdict.time_s = sample.time_s = 0.1 * ++samples;
      verdict.tick = k + 1 == kWindow;
      verdict.in_service = in_service;
      trace.take(sample, verdict, 100.0 + samples);
    }
  }
};

TEST(ResidualTrace, AHealthyToolIsZeroAndAnExcludedSensorShowsItsWholeError) {
  Bench bench;
  bench.block(0.0);
  bench.block(0.5, SensorSet::first(4) - SensorSet::of(1));
  ASSERT_EQ(bench.trace.points().size(), 2U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(bench.trace.points()[0].off_mps2[i], 0.0, 1e-12) << i;
  const verification::ResidualPoint& faulty = bench.trace.points()[1];
  EXPECT_NEAR(faulty.off_mps2[1], 0.5, 1e-12);
  for (const std::size_t i : {0U, 2U, 3U}) EXPECT_NEAR(faulty.off_mps2[i], 0.0, 1e-12) << i;
  EXPECT_DOUBLE_EQ(faulty.time_s, 0.8);
  EXPECT_DOUBLE_EQ(faulty.depth_m, 108.0);
}

TEST(ResidualTrace, AFaultInServiceStandsAgainstAllTheOthers) {
  Bench bench;
  bench.block(0.4);
  // The parity vector of the paper's tetrahedron is (1,1,1,-1)/2: a quarter of the error is left in every sensor.
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(std::fabs(bench.trace.points()[0].off_mps2[i]), 0.1, 1e-12) << i;
}

TEST(ResidualTrace, WhatIsNotThereIsNoNumber) {
  Bench bench;
  bench.block(0.0, SensorSet::first(4), SensorSet::first(4) - SensorSet::of(1));
  bench.block(0.0, SensorSet::first(2));
  const auto& points = bench.trace.points();
  EXPECT_TRUE(std::isnan(points[0].off_mps2[1]));
  EXPECT_NEAR(points[0].off_mps2[0], 0.0, 1e-12) << "the three others determine a vector";
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(std::isnan(points[1].off_mps2[i])) << "two sensors do not";
}

TEST(ResidualTrace, ALongRunKeepsItsLargestErrorInABoundedTrace) {
  Bench bench;
  constexpr int kBlocks = 5000, kFaulty = 3211;
  for (int b = 0; b < kBlocks; ++b) bench.block(b == kFaulty ? -2.0 : 0.001);
  const auto& points = bench.trace.points();
  EXPECT_LE(points.size(), ResidualTrace::kMostPoints);
  EXPECT_GE(points.size(), ResidualTrace::kMostPoints / 2);
  double most = 0.0, last = 0.0;
  for (const auto& point : points) {
    most = std::fmax(most, std::fabs(point.off_mps2[1]));
    EXPECT_GT(point.time_s, last);
    last = point.time_s;
  }
  EXPECT_NEAR(most, 0.5, 1e-9) << "merged away";
}

}  // namespace
}  // namespace residual_trace_test
