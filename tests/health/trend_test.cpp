#include "plumb/health/trend.hpp"

#include <gtest/gtest.h>

#include "support/member.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-127

namespace trend_test {
namespace {

using namespace plumb;
using plumb_test::member;

BlockEvidence block_of(const SensorArray& array, const Vec3& x_mps2, double off_mps2) {
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  for (int i = 0; i < array.size(); ++i) block.mean_mps2[static_cast<std::size_t>(i)] = dot(array.axis(i), x_mps2);
  block.mean_mps2[1] += off_mps2;
  return block;
}

/// 0.36 m/s^2 an hour, of which the others check a quarter, under a scatter of a tenth of what it comes to in a block.
TEST(Trend, TellsASlopeThatItsScatterDoesNotExplain) {
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
  Trend still = trend;
  member<2, double>(still) = 0.0;
  EXPECT_EQ(still.rate_mps2_per_h(1, 0.25), 0.0);
}

/// Without scatter there is no sigma to tell a slope by: sums that were read back so are no news.
TEST(Trend, ALineWithoutScatterIsNotTold) {
  Trend trend;
  member<0, double>(trend) = 100.0;
  for (const double square : {1.0, 2.0}) {
    member<2, double>(trend) = 1.0;
    member<4, std::array<double, kCapacity>>(trend)[1] = 1.0;
    member<5, std::array<double, kCapacity>>(trend)[1] = square;
    EXPECT_EQ(trend.rate_mps2_per_h(1, 0.25) == 0.0, square == 1.0) << square;
  }
}

}  // namespace
}  // namespace trend_test
