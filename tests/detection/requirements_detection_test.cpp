// Requirements on limits and votes, each with what happens where its rule is taken away.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "plumb/detection/isolation.hpp"
#include "plumb/numeric/tails.hpp"
#include "support/simulated_tool.hpp"

namespace requirements_detection_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

constexpr double kSigma = 2e-4 * kG0_mps2;

BlockEvidence block_at(const SensorArray& array, const Vec3& direction, double g_mps2, double samples) {
  BlockEvidence block;
  block.usable = array.all();
  block.samples = samples;
  for (int i = 0; i < array.size(); ++i)
    block.mean_mps2[static_cast<std::size_t>(i)] = dot(array.axis(i), direction) * g_mps2;
  return block;
}

// Negative: REQ-022
TEST(RequirementLimits, WithoutTheSigmaOfGravityAHealthySetIsRejected) {
  const SensorArray array = plumb_test::cone_array(5, kSigma);
  const TestLimits limits = TestLimits::from_rates(5, 1e-5, 1e-6);
  const double sigma_g = kDefaultGravitySigma_mps2;
  const BlockEvidence block = block_at(array, plumb_test::direction_at(40, 70), kG0_mps2 + 2.9 * sigma_g, 1e6);
  const GravityReference honest{kG0_mps2, sigma_g, GravityModel::value};
  const GravityReference vain{kG0_mps2, 0.0, GravityModel::value};
  EXPECT_TRUE(test_set(array, honest, limits, block, array.all()).consistent(limits));
  EXPECT_FALSE(test_set(array, vain, limits, block, array.all()).consistent(limits));
  EXPECT_EQ(limits.gravity, 3.0);
}

// Negative: REQ-056
TEST(RequirementLimits, WithoutTheCalibrationBoundAHealthySetIsRejected) {
  SensorArray array = plumb_test::cone_array(5, kSigma);
  const TestLimits limits = TestLimits::from_rates(5, 1e-5, 1e-6);
  const GravityReference gravity{kG0_mps2, 0.0, GravityModel::value};
  BlockEvidence block = block_at(array, plumb_test::direction_at(40, 70), kG0_mps2, 1e9);
  block.mean_mps2[2] += 2e-3;  // two sigmas of an offset that calibration left
  EXPECT_FALSE(test_set(array, gravity, limits, block, array.all()).consistent(limits));
  RowUncertainty u;
  for (int i = 0; i < 5; ++i) {
    const auto k = static_cast<std::size_t>(4 * i + 3);
    u.covariance[k * (k + 1) / 2 + k] = 1e-3 * 1e-3;
  }
  array.set_uncertainty(u);
  EXPECT_TRUE(test_set(array, gravity, limits, block, array.all()).consistent(limits));
}

// Verifies: REQ-056
TEST(RequirementLimits, NoiseFallsWithTheBlockAndTheBoundDoesNot) {
  const SensorArray array = plumb_test::cone_array(5, kSigma);
  const TestLimits limits = TestLimits::from_rates(5, 1e-5, 1e-6);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  BlockEvidence block = block_at(array, plumb_test::direction_at(40, 70), kG0_mps2, 1.0);
  block.spread_mps2_sq = 0.01;
  const SetTest one = test_set(array, gravity, limits, block, array.all());
  // By hand, in m/s^2: three sigmas of gravity and v/(2G).
  EXPECT_NEAR(one.norm_systematic * one.norm_sigma_mps2, 3.0 * 1e-3 + 0.01 / (2.0 * kG0_mps2), 1e-12);
  const TestLimits allowing = TestLimits::from_rates(5, 1e-5, 1e-6, 0.05);
  const SetTest pushed = test_set(array, gravity, allowing, block, array.all());
  EXPECT_NEAR((pushed.norm_systematic - one.norm_systematic) * one.norm_sigma_mps2, 0.05, 1e-12);
  EXPECT_EQ(pushed.parity_systematic, one.parity_systematic) << "all sensors feel the same acceleration";
  block.samples = 400.0;
  const SetTest many = test_set(array, gravity, limits, block, array.all());
  EXPECT_NEAR(many.norm_systematic / 20.0, one.norm_systematic, 1e-9) << "in sigmas of the block mean it grows";
  EXPECT_NEAR(many.norm_alarm_limit(limits) / 20.0, limits.norm_alarm / 20.0 + one.norm_systematic, 1e-9);
}

/// How often parity of a block misses a fault of `share` times the least detectable one, in 20 000 attitudes.
int missed(double share) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  const GravityReference gravity{kG0_mps2, 0.0, GravityModel::value};
  const double k_fa = normal_tail_quantile(0.5e-5), k_md = normal_tail_quantile(1e-3);
  const double fault = share * 2.0 * (k_fa + k_md) * kSigma / std::sqrt(32.0);
  Noise noise(77);
  int count = 0;
  for (int k = 0; k < 20000; ++k) {
    BlockEvidence block = block_at(array, plumb_test::random_direction(noise), kG0_mps2, 32.0);
    for (std::size_t i = 0; i < 4; ++i) block.mean_mps2[i] += kSigma / std::sqrt(32.0) * noise.normal();
    block.mean_mps2[static_cast<std::size_t>(k % 4)] += k % 8 < 4 ? fault : -fault;
    const SetTest t = test_set(array, gravity, limits, block, array.all());
    count += t.parity > t.parity_alarm_limit(limits) ? 0 : 1;
  }
  return count;
}

// Verifies: REQ-055
TEST(RequirementLeastFault, IsHardlyEverMissedAtAnyAttitude) { EXPECT_LE(missed(1.0), 40); }

// Negative: REQ-055
TEST(RequirementLeastFault, HalfOfItIsMissedOften) { EXPECT_GT(missed(0.5), 12000); }

// Verifies: REQ-070
TEST(RequirementExclusion, SetsThatCouldNotBeTestedStayConsistent) {
  const SensorArray array = plumb_test::cone_array(6, kSigma);
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  Isolation isolation;
  isolation.pose(array, array.all());
  BlockEvidence block = block_at(array, plumb_test::direction_at(70, 10), kG0_mps2, 32.0);
  block.mean_mps2[2] += 2.0;
  block.usable = array.all().without(5);
  const IsolationAnswer answer = isolation.vote({array, gravity, limits, block});
  EXPECT_GE(answer.live, 10) << "the ten triples with sensor 5 had no vote";
  EXPECT_TRUE(answer.strict.empty()) << "and one of them may still clear sensor 2";
  EXPECT_TRUE(answer.parity.empty());
}

// Verifies: REQ-077
TEST(RequirementNoConsistentHypothesis, WithoutAConsistentHypothesisItReportsSoAndExcludesNoSensor) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  Isolation isolation;
  isolation.pose(array, array.all());
  Noise noise(4);
  IsolationAnswer answer;
  for (int station = 0; station < 4; ++station) {
    BlockEvidence block = block_at(array, plumb_test::random_direction(noise), kG0_mps2, 32.0);
    block.mean_mps2[0] = 20.0 * (noise.uniform() - 0.5);
    block.mean_mps2[1] = 20.0 * (noise.uniform() - 0.5);
    answer = isolation.vote({array, gravity, limits, block});
    EXPECT_EQ(answer.no_consistent_hypothesis, answer.live == 0);
    EXPECT_TRUE(answer.strict.empty() && answer.parity.empty());
  }
  EXPECT_TRUE(answer.no_consistent_hypothesis);
}

// Negative: REQ-075
RC_GTEST_PROP(RequirementEpisodeLaw, ARejectedHypothesisStaysRejectedWhateverFollows, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  const SensorArray array = plumb_test::cone_array(n, kSigma);
  const TestLimits limits = TestLimits::from_rates(n, 1e-5, 1e-6);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  Isolation isolation;
  isolation.pose(array, array.all());
  int before = isolation.voting();
  for (int station = 0; station < 12; ++station) {
    const bool faulty = noise.uniform() < 0.5;
    BlockEvidence block = block_at(array, plumb_test::random_direction(noise), kG0_mps2, 32.0);
    if (faulty) block.mean_mps2[static_cast<std::size_t>(noise.uniform() * n)] += 3.0 * noise.uniform();
    const IsolationAnswer answer = isolation.vote({array, gravity, limits, block});
    RC_ASSERT(answer.live <= before);
    RC_ASSERT(answer.live == isolation.live());
    before = answer.live;
  }
}

}  // namespace
}  // namespace requirements_detection_test
