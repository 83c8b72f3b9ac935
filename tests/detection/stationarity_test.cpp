#include "plumb/detection/stationarity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "plumb/array/geometry.hpp"
#include "support/simulated_tool.hpp"

namespace stationarity_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

constexpr double kSigma = 2e-4 * kG0_mps2;

BlockAccumulator fill(const SensorArray& array, Noise& noise, const Vec3& vibration_rms, int noisy = -1,
                      double noisy_rms = 0.0) {
  BlockAccumulator block;
  for (int k = 0; k < 32; ++k) {
    const Vec3 v = {vibration_rms[0] * noise.normal(), vibration_rms[1] * noise.normal(),
                    vibration_rms[2] * noise.normal()};
    Readings y{};
    for (int i = 0; i < array.size(); ++i) {
      double r = dot(array.axis(i), plus({0, 0, kG0_mps2}, v)) + array.sigma_mps2(i) * noise.normal();
      if (i == noisy) r += noisy_rms * noise.normal();
      y[static_cast<std::size_t>(i)] = r;
    }
    block.add(y, array.all(), 1);
  }
  return block;
}

// Verifies: REQ-058
TEST(Stationarity, AToolAtRestCountsAsAtRest) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const double factor = scatter_factor(4, 32, 1e-6);
  Noise noise(1);
  for (int k = 0; k < 2000; ++k) {
    const BlockJudgement j = judge_block(array, fill(array, noise, {0, 0, 0}), array.all(), factor, kG0_mps2);
    EXPECT_TRUE(j.quiet);
    EXPECT_TRUE(j.scattering.empty());
  }
}

// Verifies: REQ-058
TEST(Stationarity, ChannelScatterAndMeanAreThoseOfTheSamples) {
  BlockAccumulator block;
  Readings y{};
  for (double v : {1.0, 2.0, 4.0}) {
    y[0] = v;
    y[1] = -2.0 * v;
    block.add(y, SensorSet::first(2), 1);
  }
  EXPECT_DOUBLE_EQ(block.mean()[0], 7.0 / 3.0);
  EXPECT_NEAR(block.covariance(0, 0), 7.0 / 3.0, 1e-12);
  EXPECT_NEAR(block.covariance(0, 1), -14.0 / 3.0, 1e-12);
}

// Verifies: REQ-141
TEST(Stationarity, AChannelCountsWhileItDeliversHalfItsSamples) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  BlockAccumulator block;
  Readings y{};
  y.fill(1.0);
  for (int k = 0; k < 8; ++k) {
    SensorSet usable = array.all();
    if (k < 3) usable = usable.without(1);  // 5 of 8
    if (k < 5) usable = usable.without(2);  // 3 of 8
    block.add(y, usable, 1);
  }
  EXPECT_EQ(block.usable(), array.all().without(2));
  EXPECT_DOUBLE_EQ(block.mean()[1], 1.0);
  EXPECT_DOUBLE_EQ(block.samples(array.all().without(2)), 5.0) << "as noisy as the scarcest channel";
}

// Verifies: REQ-056
TEST(Stationarity, AnUnweightedMeanIsAsNoisyAsItsScarcestSamples) {
  BlockAccumulator block;
  Readings y{};
  block.add(y, SensorSet::first(4), 1);
  block.add(y, SensorSet::first(4), 1000);
  EXPECT_NEAR(block.samples(SensorSet::first(4)), 4.0 / 1.001, 1e-12);
}

// Negative: REQ-058
TEST(Stationarity, VibrationIsMotionAndNeverOneChannelsNoise) {
  // docs/theory.md, section 6.2: purely axial vibration shakes sensor 4 of the paper's tool three times as much as
  // the others; a rule that looked at single channels would blame the innocent.
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const double factor = scatter_factor(4, 32, 1e-6);
  Noise noise(5);
  int blamed = 0, moving = 0;
  for (int k = 0; k < 4000; ++k) {
    const double rms = kSigma * std::pow(10.0, 3.0 * noise.uniform());  // 1 to 1000 sigmas
    const BlockJudgement j = judge_block(array, fill(array, noise, {0, 0, rms}), array.all(), factor, kG0_mps2);
    blamed += j.noisy.empty() ? 0 : 1;
    moving += j.quiet ? 0 : 1;
  }
  EXPECT_EQ(blamed, 0);
  EXPECT_GT(moving, 2800);
}

// Verifies: REQ-058
TEST(Stationarity, AScatteringChannelInAToolAtRestIsFound) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const double factor = scatter_factor(4, 32, 1e-6);
  Noise noise(6);
  for (int i = 0; i < 4; ++i) {
    const BlockJudgement j = judge_block(array, fill(array, noise, {0, 0, 0}, i, 1.0), array.all(), factor, kG0_mps2);
    EXPECT_TRUE(j.quiet);
    EXPECT_EQ(j.noisy, SensorSet::of(i));
  }
}

/// Four of eight hang, three of the healthy ones hardly feel where the tool is pushed, the eighth does: its scatter is
/// not its own for certain, since whoever leaves the four out finds it in what the three feel
/// (`plumb_monitor_attacks --seed 5 --episode 118449`, and 142649).
// Negative: REQ-143
TEST(Stationarity, WhatHalfOfEightMayHideIsNotCertain) {
  if (kCapacity < 8) GTEST_SKIP() << "eight sensors";
  const SensorArray array = plumb_test::cone_array(8, kSigma);
  const SensorSet hanging = SensorSet(0b01101100);
  // The two of the healthy that feel it least hardly feel it.
  const Vec3 across = cross(array.axis(0), array.axis(1));
  const Vec3 line = scaled(across, 1.0 / norm(across));
  const double factor = scatter_factor(8, 32, 1e-6);
  Noise noise(11);
  int pushed = 0, certain = 0, own = 0;
  for (int k = 0; k < 3000; ++k) {
    BlockAccumulator block;
    const double rms = kSigma * std::pow(10.0, noise.uniform());
    for (int s = 0; s < 32; ++s) {
      const double push = rms * noise.normal();
      Readings y{};
      for (int i = 0; i < 8; ++i) {
        const double felt = hanging.has(i) ? 0.0 : dot(array.axis(i), line) * push;
        y[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2 + felt + kSigma * noise.normal();
      }
      block.add(y, array.all(), 1);
    }
    const BlockJudgement j = judge_block(array, block, array.all(), factor, kG0_mps2);
    pushed += j.noisy.size() == 1 ? 1 : 0;
    certain += j.noisy_for_certain.empty() ? 0 : 1;
    const BlockJudgement alone =
        judge_block(array, fill(array, noise, {0, 0, 0}, 7, 40.0 * kSigma), array.all(), factor, kG0_mps2);
    own += alone.noisy_for_certain == SensorSet::of(7) ? 1 : 0;
  }
  EXPECT_GT(pushed, 100) << "it does look noisy";
  EXPECT_LT(certain, pushed / 50);
  EXPECT_GT(own, 2900) << "and one that is noisy is known for it";
}

// Verifies: REQ-058
TEST(Stationarity, AnExcludedChannelCannotStopTheEvidence) {
  const SensorArray array = plumb_test::cone_array(5, kSigma);
  const double factor = scatter_factor(5, 32, 1e-6);
  Noise noise(7);
  const BlockJudgement j =
      judge_block(array, fill(array, noise, {0, 0, 0}, 2, 50.0), array.all().without(2), factor, kG0_mps2);
  EXPECT_TRUE(j.quiet);
  EXPECT_TRUE(j.scattering.empty());
}

// Negative: REQ-058
TEST(Stationarity, ABlockWithoutSamplesIsNotJudged) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const BlockAccumulator empty;
  EXPECT_EQ(empty.samples(array.all()), 0.0);
  const BlockJudgement j = judge_block(array, empty, array.all(), 2.0, kG0_mps2);
  EXPECT_FALSE(j.quiet);
  EXPECT_EQ(j.evidence.samples, 0.0);
  EXPECT_TRUE(j.evidence.usable.empty());
  EXPECT_EQ(scatter_factor(0, 32, 1e-6), 0.0);
  EXPECT_EQ(scatter_factor(4, 1, 1e-6), 0.0);
}

/// Sets that name sensors which no build has: those that there are count, and nothing is read beyond them.
// Negative: REQ-140
TEST(Stationarity, SensorsBeyondTheCapacityAreNotRead) {
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

}  // namespace
}  // namespace stationarity_test
