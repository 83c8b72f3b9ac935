// Triangle means: T11's identity for a derivative, and blocks that are put together from smaller ones.
#include "plumb/motion/motion_window.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/simulated_tool.hpp"

// Serves: REQ-201

namespace motion_window_test {
namespace {

using namespace plumb;

constexpr double kPeriod_s = 0.001;

MotionSample sample_of(int number, double reading_mps2, const Vec3& rate_radps = {}) {
  MotionSample s;
  s.time_s = 5.0 + number * kPeriod_s;
  s.delivered = SensorSet::first(3);
  s.reading_mps2 = {reading_mps2, -reading_mps2, 1.0};
  s.rate_radps[0] = rate_radps;
  s.rate_given[0] = true;
  return s;
}

/// The weights (k + 1/2) / N going up over block A and down over block B, divided by N.
double weight(int k, int samples) {
  const double up = k < samples ? k + 0.5 : 2 * samples - k - 0.5;
  return up / (static_cast<double>(samples) * samples);
}

RC_GTEST_PROP(MotionWindow, EveryScaleIsTheWeightedMeanOfItsSamples, ()) {
  plumb_test::Noise noise(*rc::gen::arbitrary<std::uint32_t>());
  BlockSamples blocks = kMotionSamples;
  for (std::size_t s = 1; s < blocks.size() && *rc::gen::arbitrary<bool>(); ++s)
    blocks[s] = blocks[s - 1] * *rc::gen::inRange(2, 7);
  for (std::size_t s = 1; s < blocks.size(); ++s) {
    if (blocks[s] % blocks[s - 1] != 0 || blocks[s] == blocks[s - 1]) blocks[s] = 3 * blocks[s - 1];
  }
  MotionWindow window(3, 1, kPeriod_s, blocks);
  std::vector<MotionSample> past;
  for (int k = 0; k < 600; ++k) {
    const Vec3 rate{noise.normal(), noise.normal(), noise.normal()};
    past.push_back(sample_of(k, 10.0 * noise.normal(), rate));
    window.add(past.back());
    for (int s = 0; s < kMotionScales; ++s) {
      const int n = blocks[static_cast<std::size_t>(s)];
      RC_ASSERT(((window.ended() >> static_cast<unsigned>(s)) & 1U) == ((k % n == 0 && k >= 2 * n) ? 1U : 0U));
      if ((window.ended() >> static_cast<unsigned>(s) & 1U) == 0) continue;
      double bend = 0.0;
      for (std::size_t j = past.size() - 1 - static_cast<std::size_t>(2 * n); j + 1 < past.size(); ++j) {
        const auto y = [&](std::size_t at) { return past[at].reading_mps2[0]; };
        if (j > 0) bend = std::max(bend, std::fabs(y(j - 1) - 2.0 * y(j) + y(j + 1)));
      }
      double mean = 0.0, square = 0.0, product = 0.0, share = 0.0, slope = 0.0, turn = 0.0;
      for (int j = 0; j < 2 * n; ++j) {
        const MotionSample& one = past[past.size() - 1 - static_cast<std::size_t>(2 * n - j)];
        const double y = one.reading_mps2[0], w = weight(j, n), sign = j < n ? -1.0 : 1.0;
        mean += w * y;
        square += w * y * y;
        share += w * w;
        product += w * one.rate_radps[0][0] * one.rate_radps[0][1];
        slope += sign * y / (n * n * kPeriod_s);
        turn += sign * one.rate_radps[0][2] / (n * n * kPeriod_s);
      }
      const MotionMeans means = window.means(s);
      RC_ASSERT(means.samples == n && means.usable == SensorSet::first(3) && means.gyro[0].given);
      RC_ASSERT(std::fabs(means.time_s - (past.back().time_s - (n + 0.5) * kPeriod_s)) < 1e-9);
      RC_ASSERT(std::fabs(means.noise_share() - share) < 1e-12);
      RC_ASSERT(std::fabs(means.reading_mps2[0] - mean) < 1e-9);
      RC_ASSERT(std::fabs(means.square_m2ps4[0] - square) < 1e-7);
      RC_ASSERT(std::fabs(means.slope_mps3[0] - slope) < 1e-6);
      RC_ASSERT(std::fabs(means.bend_mps2[0] - bend) < 1e-9);
      RC_ASSERT(std::fabs(means.gyro[0].rate_product[3] - product) < 1e-9);
      RC_ASSERT(std::fabs(means.gyro[0].acceleration_radps2[2] - turn) < 1e-6);
    }
  }
}

/// T11: the weighted mean of the steps of a signal is the difference of the block means, whatever the signal.
RC_GTEST_PROP(MotionWindow, TheMeanOfADerivativeIsADifferenceOfMeans, ()) {
  plumb_test::Noise noise(*rc::gen::arbitrary<std::uint32_t>());
  MotionWindow window(3, 0, kPeriod_s);
  std::vector<double> y;
  for (int k = 0; k < 64; ++k) {
    y.push_back(noise.normal());
    window.add(sample_of(k, y.back()));
  }
  window.add(sample_of(64, 0.0));
  double steps = 0.0;
  for (int k = 1; k < 64; ++k)
    steps += (k <= 32 ? k : 64 - k) * (y[static_cast<std::size_t>(k)] - y[static_cast<std::size_t>(k) - 1]);
  RC_ASSERT(std::fabs(window.means(2).slope_mps3[0] - steps / (32.0 * 32.0 * kPeriod_s)) < 1e-9);
}

TEST(MotionWindow, BeginsAnewWhereTimeJumpsOrIsNoNumber) {
  for (const double jump_s :
       {0.0, -0.002, 0.002, 100.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    MotionWindow window(3, 1, kPeriod_s);
    for (int k = 0; k < 80; ++k) window.add(sample_of(k, 1.0));
    MotionSample late = sample_of(80, 1.0);
    late.time_s += jump_s;
    window.add(late);
    if (jump_s == 0.0) {
      EXPECT_EQ(window.ended(), 3U);  // 80 samples: a pair of one, a pair of four
      continue;
    }
    EXPECT_EQ(window.ended(), 0U) << jump_s;
    EXPECT_EQ(window.means(2).samples, 0) << jump_s;
  }
}

TEST(MotionWindow, AChannelAtFullScaleStaysOutForFourSamplesMore) {
  MotionWindow window(3, 0, kPeriod_s);
  for (int k = 0; k < 12; ++k) {
    MotionSample s = sample_of(k, 1.0);
    if (k == 4) s.clipped = SensorSet::of(1);
    window.add(s);
    if (k < 2) continue;
    const bool out = k >= 5 && k <= 10;  // the pair of samples 8 and 9 is the last with a member that is out
    EXPECT_EQ(window.means(0).usable.has(1), !out) << k;
    EXPECT_TRUE(window.means(0).usable.has(0));
  }
}

TEST(MotionWindow, AMissingOrBrokenReadingVoidsItsBlocksAlone) {
  MotionWindow window(3, 1, kPeriod_s);
  for (int k = 0; k < 65; ++k) {
    MotionSample s = sample_of(k, 1.0);
    if (k == 10) s.reading_mps2[0] = std::numeric_limits<double>::quiet_NaN();
    if (k == 40) s.rate_radps[0][1] = std::numeric_limits<double>::infinity();
    window.add(s);
  }
  const MotionMeans means = window.means(2);
  EXPECT_EQ(means.usable, SensorSet::first(3).without(0));
  EXPECT_FALSE(means.gyro[0].given);
  EXPECT_NEAR(means.reading_mps2[1], -1.0, 1e-12);
  EXPECT_TRUE(window.means(1).gyro[0].given);
}

/// The largest of both blocks counts, and what cannot be such a bound makes its reading unusable.
TEST(MotionWindow, WhatInterpolationAddsIsTheLargestOfBothBlocks) {
  MotionWindow window(3, 1, kPeriod_s);
  for (int k = 0; k < 80; ++k) {
    MotionSample s = sample_of(k, 1.0);
    s.interpolation_mps2 = {0.1, k == 40 ? 0.7 : 0.1, k == 50 ? std::numeric_limits<double>::quiet_NaN() : 0.1};
    s.interpolation_radps[0] = k == 3 ? 0.3 : 0.2;
    window.add(s);
    if (k == 64) {
      const MotionMeans means = window.means(2);
      EXPECT_EQ(means.usable, SensorSet::first(2));
      EXPECT_EQ(means.interpolation_mps2[0], 0.1);
      EXPECT_EQ(means.interpolation_mps2[1], 0.7);
      EXPECT_EQ(means.gyro[0].interpolation_radps, 0.3);
    }
    if (k == 20) {
      EXPECT_EQ(window.means(1).interpolation_mps2[1], 0.1);
    }
  }
  MotionSample s = sample_of(80, 1.0);
  s.interpolation_mps2[0] = -1.0;
  s.interpolation_radps[0] = std::numeric_limits<double>::infinity();
  window.add(s);
  window.add(sample_of(81, 1.0));
  EXPECT_FALSE(window.means(0).usable.has(0));
  EXPECT_FALSE(window.means(0).gyro[0].given);
}

}  // namespace
}  // namespace motion_window_test
