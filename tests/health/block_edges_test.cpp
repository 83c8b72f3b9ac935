// Edges of a block: readings without noise, a station that never ends, a channel that is noisy and at full scale.
#include <gtest/gtest.h>

#include "health/recalibration_support.hpp"

// Serves: REQ-070

namespace block_edges_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;
using plumb_test::Shadow;

/// Three sensors that read gravity to the last bit, a channel of which missed a sample: nothing is off, nobody checks a
/// triple, and there is no limit of which something would be left.
TEST(MonitorBlockEdge, WithoutNoiseAndWithoutATestedTripleThereIsNoMargin) {
  Rig rig(Shadow::triad());
  const Vec3 up = {0.0, 0.0, 1.0};
  rig.distort = [&rig, &up](int i, double, int) { return dot(rig.setup.array.axis(i), up) * kG0_mps2; };
  for (int k = 0; k < rig.setup.config.window; ++k) {
    Sample s = rig.sample(up, kG0_mps2);
    if (k == 3) s.delivered = s.delivered.without(1);
    rig.step(s);
  }
  const Verdict& v = rig.monitor.verdict();
  EXPECT_TRUE(v.tick);
  EXPECT_EQ(v.statistic, 0.0);
  EXPECT_EQ(v.limit, 0.0);
  EXPECT_EQ(v.margin, 0.0);
  rig.stay(up);
  EXPECT_GT(rig.monitor.verdict().limit, 0.0);
  EXPECT_EQ(rig.monitor.verdict().margin, 1.0);
}

/// More blocks at one station than are counted: it stays the station that it was.
TEST(MonitorBlockEdge, AStationThatNeverEndsIsCountedUpToItsBound) {
  MonitorConfig config;
  config.window = 8;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  const HealthState before = rig.monitor.verdict().state;
  rig.stay(direction_at(40, 40), 1003);
  EXPECT_EQ(rig.monitor.verdict().state, before);
  EXPECT_TRUE(rig.ever_blamed.empty());
}

/// It jumps from one end of its range to the other: full scale says more than noise.
TEST(MonitorBlockEdge, NoisyAndAtFullScaleIsNamedByFullScale) {
  Rig rig(plumb_test::cone_array(6));
  rig.setup.full_scale_raw.fill(1.05 * kG0_mps2);
  rig.restart();
  rig.prove();
  rig.distort = [](int i, double r, int k) { return i == 2 ? 1.05 * kG0_mps2 - (k % 2) * 0.02 : r; };
  for (int k = 0; k < 8; ++k) rig.stay(direction_at(30 + 15 * k, 50 * k));
  const Verdict& v = rig.monitor.verdict();
  ASSERT_TRUE((v.excluded | v.set_aside).has(2));
  EXPECT_EQ(v.sensor_cause[2], Cause::clipped) << to_string(v.sensor_cause[2]);
}

/// Two faults are asserted, which of four sensors nobody could tell apart: the votes of the stations convict one alone.
// Verifies: REQ-070
TEST(MonitorBlockEdge, WhatTheAssertionCannotNameTheVotesMay) {
  MonitorConfig config;
  config.asserted_faults = 2;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  for (int k = 0; k < 12; ++k) rig.stay(direction_at(25 + 37 * (k % 4), 67 * k), 2);
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(2));
  EXPECT_EQ(rig.ever_blamed, SensorSet::of(2));
}

}  // namespace
}  // namespace block_edges_test
