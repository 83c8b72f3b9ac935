#include "plumb/detection/mae_test.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plumb/numeric/tails.hpp"
#include "support/simulated_tool.hpp"

namespace mae_test_test {
namespace {

using namespace plumb;

constexpr double kSigma = 2e-4 * kG0_mps2;

BlockEvidence block_at(const SensorArray& array, const Vec3& direction, double samples) {
  BlockEvidence block;
  block.usable = array.all();
  block.samples = samples;
  for (int i = 0; i < array.size(); ++i)
    block.mean_mps2[static_cast<std::size_t>(i)] = dot(array.axis(i), direction) * kG0_mps2;
  return block;
}

// Verifies: REQ-054
TEST(MaeLimit, IsTheSigmaOfTheTripleTimesTheQuantilePlusWhatIsSystematic) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-3, 1e-6);
  const Vec3 u = plumb_test::direction_at(35, 110);
  const BlockEvidence block = block_at(array, u, 32.0);
  const double quantile = half_normal_mean_quantile(32, 1e-3);
  for (int k = 0; k < array.triple_count(); ++k) {
    const SetTest t = test_set(array, gravity, limits, block, array.triple(k).set());
    // |W'u| sigma by the inverse of the three rows.
    const Mat3 map = triple_map(array, k);
    double square = 0.0;
    for (std::size_t c = 0; c < 3; ++c) square += std::pow(map[c] * u[0] + map[3 + c] * u[1] + map[6 + c] * u[2], 2);
    const MaeLimit limit = computed_mae_limit(t, block, 32, quantile);
    EXPECT_NEAR(limit.noise_mps2, std::sqrt(square) * kSigma * quantile, 1e-12);
    EXPECT_NEAR(limit.systematic_mps2, 3e-3, 1e-12) << "three sigmas of gravity";
    EXPECT_NEAR(limit.mean_mps2, std::sqrt(square) * kSigma * std::sqrt(2.0 / kPi), 1e-12);
    EXPECT_NEAR(limit.ratio(limit.limit_mps2()), 1.0, 1e-12);
    EXPECT_NEAR(limit.ratio(limit.mean_mps2), 0.0, 1e-12);
    EXPECT_NEAR(limit.clear_mps2(1.0), limit.limit_mps2(), 1e-12);
    // A sample that is a mean of 16 has a quarter of the noise; the systematic part stays.
    const BlockEvidence means = block_at(array, u, 16.0 * 32.0);
    const SetTest finer = test_set(array, gravity, limits, means, array.triple(k).set());
    const MaeLimit narrower = computed_mae_limit(finer, means, 32, quantile);
    EXPECT_NEAR(narrower.noise_mps2, 0.25 * limit.noise_mps2, 1e-12);
    EXPECT_NEAR(narrower.systematic_mps2, limit.systematic_mps2, 1e-12);
  }
}

// Verifies: REQ-053
TEST(MaeLimit, AGivenOneIsTakenAsItIs) {
  const MaeLimit limit = given_mae_limit(0.5);
  EXPECT_EQ(limit.limit_mps2(), 0.5);
  EXPECT_EQ(limit.ratio(0.25), 0.5);
  EXPECT_EQ(limit.clear_mps2(0.7), 0.35);
}

// Negative: REQ-054
TEST(MaeLimit, WithoutRoomNothingIsWithinIt) {
  EXPECT_GT(MaeLimit{}.ratio(0.0), 1.0);
  EXPECT_GT(MaeLimit{}.ratio(1.0), 1.0);
}

// Verifies: REQ-054
TEST(MaeLimit, TheRateIsSharedByTheMonitoredTriples) {
  EXPECT_EQ(voting_triples(plumb_test::tetrahedron()), 4);
  EXPECT_DOUBLE_EQ(triple_share(plumb_test::tetrahedron(), 1e-3), 2.5e-4);
  AxisList axes{};
  axes[0] = {1, 0, 0};
  axes[1] = {0, 1, 0};
  const Vec3 flat = {1.0, 1.0, 0.03};
  axes[2] = scaled(flat, 1.0 / norm(flat));
  axes[3] = {0, 0, 1};
  const SensorArray nearly_flat = plumb_test::make_array(axes, 4, kSigma);
  EXPECT_EQ(voting_triples(nearly_flat), 3) << "the near-singular one has no vote and no share";
  EXPECT_DOUBLE_EQ(triple_share(nearly_flat, 3e-3), 1e-3);
}

/// An array of which no three axes are apart enough to vote.
// Serves: REQ-005
TEST(MaeLimit, WithoutAMonitoredTripleTheRateIsNotShared) {
  AxisList axes{};
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = {std::sqrt(0.5), std::sqrt(0.5 - 1e-4), 1e-2};
  const SensorArray flat = plumb_test::make_array(axes, 3, kSigma);
  EXPECT_EQ(voting_triples(flat), 0);
  EXPECT_EQ(triple_share(flat, 1e-5), 1e-5);
  EXPECT_EQ(triple_share(plumb_test::tetrahedron(kSigma), 1e-5), 1e-5 / 4);
}

}  // namespace
}  // namespace mae_test_test
