// The sigma to declare covers what means of blocks do, whatever the noise is.
#include "plumb/noise/whiteness.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulated_noise.hpp"

namespace whiteness_test {
namespace {

using namespace plumb;
using namespace plumb::noise;

constexpr double kPeriod_s = 0.01;
constexpr Coefficients kWhite = {0.0, 0.1, 0.0, 0.0, 0.0};  // sigma 1 of a sample

Whiteness of(const std::vector<double>& readings, std::size_t block, const Coefficients& noise = kWhite) {
  return whiteness(readings, prefix_sums(readings), noise, kPeriod_s, block);
}

TEST(Whiteness, OfWhiteNoiseDeclaresItsSigma) {
  const Whiteness found = of(simulated_noise::normals(1, 1, 100000), 32);
  EXPECT_EQ(found.verdict, WhitenessVerdict::white);
  EXPECT_NEAR(found.sample_sigma, 1.0, 0.01);
  EXPECT_NEAR(found.declare_sigma, 1.0, 0.06);
  EXPECT_GE(found.declare_sigma, found.sample_sigma);
  EXPECT_EQ(found.best_block, kLongestWindow);
  EXPECT_EQ(found.wander, 0.0);
}

TEST(Whiteness, OfAFilterDeclaresMore) {
  // A running mean of eight: samples scatter by 1/sqrt(8), and means of blocks as before.
  const std::vector<double> white = simulated_noise::normals(2, 1, 100008);
  std::vector<double> filtered;
  for (std::size_t k = 0; k + 8 <= white.size(); ++k) {
    double sum = 0.0;
    for (std::size_t i = k; i < k + 8; ++i) sum += white[i] / 8.0;
    filtered.push_back(sum);
  }
  const Whiteness found = of(filtered, 64);
  EXPECT_EQ(found.verdict, WhitenessVerdict::correlated);
  EXPECT_NEAR(found.sample_sigma, std::sqrt(1.0 / 8.0), 0.03);
  EXPECT_NEAR(found.declare_sigma, 1.0, 0.08);
  EXPECT_GT(found.factor, 2.0);
}

TEST(Whiteness, OfQuantisedSumsDeclaresTheSample) {
  const std::vector<double> codes = simulated_noise::normals(3, 1, 100001);
  std::vector<double> readings;
  for (std::size_t k = 0; k + 1 < codes.size(); ++k) readings.push_back(codes[k + 1] - codes[k]);
  const Whiteness found = of(readings, 32, {0.01, 0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(found.verdict, WhitenessVerdict::opposed);
  EXPECT_EQ(found.declare_sigma, found.sample_sigma);
}

TEST(Whiteness, WanderIsToldApartFromNoise) {
  const Coefficients noise = {0.0, 0.1, 0.0, 0.02, 0.0};
  const Whiteness found = of(simulated_noise::Source(noise, 200000, kPeriod_s).draw(4), 32, noise);
  EXPECT_EQ(found.verdict, WhitenessVerdict::white);
  EXPECT_GT(found.wander, 0.2);
  EXPECT_NEAR(found.declare_sigma, 1.0, 0.06);
}

RC_GTEST_PROP(Whiteness, DeclaredSigmaCoversSamplesAndBlocks, ()) {
  const auto seed = static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000000));
  const auto block = static_cast<std::size_t>(*rc::gen::element(1, 2, 16, 100, 256));
  const double memory = *rc::gen::element(-0.9, -0.3, 0.0, 0.5, 0.95);
  const std::vector<double> white = simulated_noise::normals(seed, 1, 4096);
  std::vector<double> readings;
  double last = 0.0;
  for (const double w : white) readings.push_back(last = memory * last + w);
  const Whiteness found = of(readings, block);
  RC_ASSERT(found.declare_sigma >= found.sample_sigma);
  RC_ASSERT(found.declare_sigma / std::sqrt(static_cast<double>(block)) >= found.block_sigma);
  RC_ASSERT(found.best_block >= 1 && found.best_block <= kLongestWindow);
}

}  // namespace
}  // namespace whiteness_test
