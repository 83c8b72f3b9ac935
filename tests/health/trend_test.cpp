#include "plumb/health/detail/trend.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "plumb/core/detail/archive.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-127

namespace trend_test {
namespace {

using namespace plumb;

BlockEvidence block_of(const SensorArray& array, const Vec3& x_mps2, double off_mps2) {
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  for (int i = 0; i < array.size(); ++i) block.mean_mps2[static_cast<std::size_t>(i)] = dot(array.axis(i), x_mps2);
  block.mean_mps2[1] += off_mps2;
  return block;
}

/// 0.36 m/s^2 an hour, of which the others check a quarter, under a scatter of a tenth of what it comes to in a block.
TEST(Trend, ReportsASlopeThatItsScatterDoesNotExplain) {
  const SensorArray array = plumb_test::tetrahedron();
  const Vec3 x = {0.0, 0.0, kG0_mps2};
  Trend trend;
  for (int k = 0; k < 64; ++k)
    trend.add(array, block_of(array, x, 1e-4 * k + (k % 2 == 0 ? 1e-5 : -1e-5)), array.all(), x, 1.0 * k);
  EXPECT_NEAR(trend.rate_mps2_per_h(1, 0.25), 4.0 * 0.36, 0.01);
  EXPECT_EQ(trend.rate_mps2_per_h(0, 0.25), 0.0);
  EXPECT_EQ(trend.rate_mps2_per_h(1, 0.0), 0.0) << "nobody checks it";
}

TEST(Trend, BlocksOfOneTimeHaveNoSlope) {
  const SensorArray array = plumb_test::tetrahedron();
  const Vec3 x = {0.0, 0.0, kG0_mps2};
  Trend trend;
  for (int k = 0; k < 64; ++k) trend.add(array, block_of(array, x, 1e-4 * k), array.all(), x, 5.0);
  EXPECT_EQ(trend.rate_mps2_per_h(1, 0.25), 0.0);
}

/// The trend as it is read back with `value` in the place of one figure, for each of them that may hold it.
std::vector<Trend> read_back_with(const Trend& trend, int sensors, double value) {
  ArchiveWriter counter(nullptr, 0, sensors);
  counter.put(trend);
  std::vector<std::uint8_t> bytes(counter.used());
  ArchiveWriter(bytes.data(), bytes.size(), sensors).put(trend);
  std::vector<Trend> out;
  for (std::size_t k = 0; k < bytes.size(); k += sizeof value) {
    std::vector<std::uint8_t> forged = bytes;
    std::memcpy(forged.data() + k, &value, sizeof value);
    Trend read;
    ArchiveReader in(forged.data(), forged.size(), sensors);
    in.get(read);
    if (in.sound()) out.push_back(read);
  }
  return out;
}

/// Four sums tell a slope: how much was seen, how far times and residuals scattered, and both together. Without one of
/// them nothing is told, a line without scatter among that: it has no sigma. The others change nothing.
TEST(Trend, WithoutOneOfItsSumsNothingIsReported) {
  const SensorArray array = plumb_test::tetrahedron();
  const Vec3 x = {0.0, 0.0, kG0_mps2};
  Trend trend;
  for (int k = 0; k < 64; ++k)
    trend.add(array, block_of(array, x, 1e-4 * k + (k % 2 == 0 ? 1e-5 : -1e-5)), array.all(), x, 1.0 * k);
  const double told = trend.rate_mps2_per_h(1, 0.25);
  ASSERT_NE(told, 0.0);
  int silent = 0;
  for (const Trend& read : read_back_with(trend, array.size(), 0.0)) {
    const double rate = read.rate_mps2_per_h(1, 0.25);
    EXPECT_TRUE(rate == 0.0 || rate == told) << rate;
    silent += rate == 0.0 ? 1 : 0;
  }
  EXPECT_EQ(silent, 4);
}

/// Sums that were read back may be anything: what is told of them is a number.
TEST(Trend, WhateverWasReadBackTheRateIsANumber) {
  const SensorArray array = plumb_test::tetrahedron();
  const Vec3 x = {0.0, 0.0, kG0_mps2};
  Trend trend;
  for (int k = 0; k < 64; ++k)
    trend.add(array, block_of(array, x, 1e-4 * k + (k % 2 == 0 ? 1e-5 : -1e-5)), array.all(), x, 1.0 * k);
  constexpr double kMost = std::numeric_limits<double>::max();
  for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL, kMost, -kMost, 5e-324, -1.0}) {
    for (const Trend& read : read_back_with(trend, array.size(), value))
      EXPECT_TRUE(std::isfinite(read.rate_mps2_per_h(1, 0.25))) << value;
  }
}

}  // namespace
}  // namespace trend_test
