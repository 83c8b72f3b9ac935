// Edges of the detection room: blocks of nothing, sets that are none, streams that break off.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "plumb/array/geometry.hpp"
#include "plumb/detection/alarm_form.hpp"
#include "plumb/detection/block_tests.hpp"
#include "plumb/detection/detectable.hpp"
#include "plumb/detection/mae_test.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/detection/thresholds.hpp"
#include "plumb/numeric/tails.hpp"
#include "support/simulated_tool.hpp"

namespace detection_edges_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

constexpr double kSigma = 2e-4 * kG0_mps2;

// Negative: REQ-058
TEST(BlockEdge, OfNoSamplesThereIsNothingToJudge) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const BlockAccumulator empty;
  EXPECT_EQ(empty.samples(array.all()), 0.0);
  const BlockJudgement j = judge_block(array, empty, array.all(), 2.0, kG0_mps2);
  EXPECT_FALSE(j.quiet);
  EXPECT_EQ(j.evidence.samples, 0.0);
  EXPECT_TRUE(j.evidence.usable.empty());
  EXPECT_EQ(restless_factor(0, 32, 1e-6), 0.0);
  EXPECT_EQ(restless_factor(4, 1, 1e-6), 0.0);
}

/// Sets that name sensors which no build has: those that there are count, and nothing is read beyond them.
// Negative: REQ-140
TEST(BlockEdge, SensorsThatThereAreNotAreNotRead) {
  const SensorSet all(~std::uint32_t{0});
  BlockAccumulator block;
  Readings y{};
  y.fill(1.0);
  block.add(y, all, 1);
  block.add(y, all, 1);
  EXPECT_EQ(block.usable(), SensorSet::first(kCapacity));
  EXPECT_EQ(block.mean()[kCapacity - 1], 1.0);
  EXPECT_TRUE(block.holds());
  LeastSquares map = least_squares(plumb_test::tetrahedron(kSigma), SensorSet::first(4));
  const Vec3 x = map.estimate(y);
  map.used = all;
  EXPECT_EQ(map.estimate(y), x) << "columns of no sensor are zero";
}

/// Two pairs: without one of the single axes the others are a plane, so nobody vouches for it.
// Negative: REQ-060
TEST(BlockTestsEdge, NobodyVouchesForALengthThatNobodyChecks) {
  AxisList axes{};
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = axes[3] = {0.0, 0.0, 1.0};
  const SensorArray array = plumb_test::make_array(axes, 4, kSigma);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  block.mean_mps2[2] = block.mean_mps2[3] = kG0_mps2;
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  const BlockTests tests(array, gravity, limits, block);
  EXPECT_FALSE(tests.vouches_for_norm(array.all(), SetTest{}));
  EXPECT_FALSE(tests.vouches_for_norm(array.all(), tests.of(array.all())));
  const SensorArray cone = plumb_test::cone_array(6, kSigma);
  for (int i = 0; i < 6; ++i) block.mean_mps2[static_cast<std::size_t>(i)] = cone.axis(i)[2] * kG0_mps2;
  block.usable = cone.all();
  const TestLimits limits_of_six = TestLimits::from_rates(6, 1e-5, 1e-6);
  const BlockTests six(cone, gravity, limits_of_six, block);
  SetTest badly_checked = six.of(cone.all());
  badly_checked.least_leverage = 0.0;
  for (double& c : badly_checked.covariance) c *= 10.0;
  EXPECT_TRUE(six.vouches_for_norm(cone.all(), badly_checked)) << "the others say the same";
  badly_checked.norm_error_mps2 += 1.0;
  EXPECT_FALSE(six.vouches_for_norm(cone.all(), badly_checked)) << "the others deny it";
}

// Negative: REQ-052
TEST(SetTestEdge, WhatIsNoSetOfTheArrayIsNotTested) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  BlockEvidence block;
  block.usable = SensorSet::first(5);
  block.samples = 32.0;
  for (int i = 0; i < 4; ++i) block.mean_mps2[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2;
  EXPECT_TRUE(test_set(array, gravity, limits, block, SensorSet::first(4)).tested);
  EXPECT_FALSE(test_set(array, gravity, limits, block, SensorSet::first(5)).tested);
  EXPECT_FALSE(test_set(array, gravity, limits, block, SensorSet::first(2)).tested);
  block.samples = 0.0;
  EXPECT_FALSE(test_set(array, gravity, limits, block, SensorSet::first(4)).tested);
}

/// Free fall: no reading, no direction, and no tilt that could be told.
// Negative: REQ-052
TEST(SetTestEdge, WithoutAVectorTheTiltIsOpen) {
  SensorArray array = plumb_test::tetrahedron(kSigma);
  RowUncertainty u;
  for (int a = 0; a < 16; ++a) u.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = 1e-8;
  array.set_uncertainty(u);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  const SetTest t = test_set(array, gravity, limits, block, array.all());
  ASSERT_TRUE(t.tested);
  EXPECT_EQ(calibration_tilt_sigma_rad(array, t, array.all()), kPi);
  const SetTest q = in_quadrature(array, gravity, block, array.all(), t);
  EXPECT_EQ(q.parity, 0.0);
  EXPECT_TRUE(std::isfinite(q.norm));
  // Nothing is open about a vector whose sensors err along it alone.
  block.mean_mps2 = {};
  for (int i = 0; i < 4; ++i) block.mean_mps2[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2;
  const SetTest seen = test_set(array, gravity, limits, block, array.all());
  EXPECT_EQ(tilt_sigma_rad(seen.x_mps2, {}), 0.0);
}

/// Three of five: those that are not asked about do not enter.
// Verifies: REQ-057
TEST(AlarmFormEdge, OnlyTheSetIsAsked) {
  SensorArray array = plumb_test::cone_array(6, kSigma);
  RowUncertainty u;
  for (int a = 0; a < 24; ++a) u.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = 1e-8;
  array.set_uncertainty(u);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  Noise noise(4);
  for (int i = 0; i < 6; ++i) {
    block.mean_mps2[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2 + 1e-3 * noise.normal();
  }
  const SensorSet five = array.all().without(2);
  const SetTest before = test_set(array, gravity, limits, block, five);
  const SetTest q = in_quadrature(array, gravity, block, five, before);
  block.mean_mps2[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(in_quadrature(array, gravity, block, five, before).parity, q.parity);
  EXPECT_GT(before.parity, q.parity);
}

// Serves: REQ-055
TEST(DetectableEdge, AShiftBeyondWhatIsComputedIsTheUpperBound) {
  const double small = detectable_shift(10.0, 3, 1e-3);
  EXPECT_GT(small, 10.0);
  EXPECT_GT(detectable_shift(1e12, 3, 1e-3), 1e12);
  EXPECT_EQ(detectable_shift(25.0, 1, 1e-300), 25.0 + normal_tail_quantile(1e-300));
}

/// An array of which no three axes are apart enough to vote.
// Serves: REQ-005
TEST(MaeEdge, WithoutATripleThatVotesTheRateIsNotShared) {
  AxisList axes{};
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = {std::sqrt(0.5), std::sqrt(0.5 - 1e-4), 1e-2};
  const SensorArray flat = plumb_test::make_array(axes, 3, kSigma);
  EXPECT_EQ(voting_triples(flat), 0);
  EXPECT_EQ(triple_share(flat, 1e-5), 1e-5);
  EXPECT_EQ(triple_share(plumb_test::tetrahedron(kSigma), 1e-5), 1e-5 / 4);
}

// Negative: REQ-016
TEST(ThresholdsEdge, AnArrayOfNothingProtectsNothing) {
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  EXPECT_EQ(protection_level_rad(SensorArray{}, gravity, {}), kPi);
  const ErrorBudget none = error_budget(SensorArray{}, gravity, {});
  EXPECT_EQ(none.noise_factor, 0.0);
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const double level = protection_level_rad(array, gravity, {});
  EXPECT_EQ(level, thresholds_of(array, gravity, {}).protection_rad);
  EXPECT_LT(level, 0.1);
  TestSettings settings;
  settings.false_alarm_rate = 1e-9;
  settings.rejection_rate = 1e-2;
  EXPECT_GT(protection_level_rad(array, gravity, settings), level) << "an alarm that is seldom hides more";
}

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
TEST(StationFinderEdge, ABreakInTimeEndsAStation) {
  for (const double step_s : {60.0, -1.0}) {
    Stream s;
    EXPECT_EQ(s.feed(kDown, 300), 0);
    s.t += step_s;
    EXPECT_EQ(s.feed(kDown, 300), 1) << step_s;
    EXPECT_TRUE(s.finder.finish(s.last)) << step_s;
  }
}

// Verifies: REQ-039
TEST(StationFinderEdge, AnotherTagInTheMiddleOfABlockEndsAStation) {
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
TEST(StationFinderEdge, AnotherDirectionEndsAStationWithoutMotion) {
  Stream s;
  EXPECT_EQ(s.feed(kDown, 320), 0);
  EXPECT_EQ(s.feed(kAcross, 320), 1);
  EXPECT_TRUE(s.finder.finish(s.last));
}

// Negative: REQ-039
TEST(StationFinderEdge, AStretchThatIsTooShortIsNoStation) {
  StationFinder::Settings settings;
  settings.min_blocks = 5;
  Stream s(settings);
  EXPECT_EQ(s.feed(kDown, 4 * 32), 0);
  EXPECT_FALSE(s.finder.finish(s.last));
}

// Negative: REQ-039
TEST(StationFinderEdge, AChannelThatDoesNotDeliverIsLeftOut) {
  Stream s;
  EXPECT_EQ(s.feed(kDown, 320, SensorSet::first(5).without(3)), 0);
  ASSERT_TRUE(s.finder.finish(s.last));
  EXPECT_EQ(s.last.delivered, SensorSet::first(5).without(3));
  EXPECT_EQ(s.last.mean[3], 0.0);
  EXPECT_NEAR(s.last.mean[0], s.array.axis(0)[2] * kG0_mps2, 5 * kSigma);
}

// Negative: REQ-039
TEST(StationFinderEdge, BlocksOfOneSampleHaveNoScatter) {
  StationFinder::Settings settings;
  settings.block = 1;
  Stream s(settings);
  s.feed(kDown, 12);
  ASSERT_TRUE(s.finder.finish(s.last));
  EXPECT_EQ(s.last.scatter[0], 0.0);
}

}  // namespace
}  // namespace detection_edges_test
