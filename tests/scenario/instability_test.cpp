#include "plumb/scenario/instability.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb {
namespace scenario {
namespace instability_test {
namespace {

constexpr int kRuns = 4000;

/// Mean of x(s) x(t) over many seeds.
double covariance(const InstabilityLaw& law, std::uint64_t s, std::uint64_t t) {
  double sum = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Instability wander(law, 1000, 0.1, static_cast<std::uint64_t>(seed), 0);
    sum += wander.at(s) * wander.at(t);
  }
  return sum / kRuns;
}

// Bounds: five standard errors of a mean of products of two normals.
TEST(Instability, GaussMarkovHasItsSigmaAndItsCorrelationEverywhere) {
  InstabilityLaw law;
  law.sigma_mps2 = 2.0;
  law.correlation_s = 20.0;
  const double error = 5.0 * 4.0 * std::sqrt(2.0 / kRuns);
  for (const std::uint64_t t : {0U, 1U, 512U, 513U, 999U}) EXPECT_NEAR(covariance(law, t, t), 4.0, error) << t;
  EXPECT_NEAR(covariance(law, 300, 500), 4.0 * std::exp(-1.0), error) << "20 s apart, one correlation time";
  EXPECT_NEAR(covariance(law, 511, 512), 4.0 * std::exp(-0.005), error) << "across the first halving";
  EXPECT_NEAR(covariance(law, 0, 999), 4.0 * std::exp(-4.995), error);
}

TEST(Instability, RandomWalkGrowsWithTheRootOfTime) {
  InstabilityLaw law;
  law.walk_mps2 = 0.5;
  for (const std::uint64_t t : {1U, 10U, 500U, 512U, 999U}) {
    const double variance = 0.25 * 0.1 * static_cast<double>(t);
    EXPECT_NEAR(covariance(law, t, t), variance, 5.0 * variance * std::sqrt(2.0 / kRuns)) << t;
  }
  EXPECT_NEAR(covariance(law, 300, 700), 0.25 * 30.0, 5.0 * 0.25 * std::sqrt(30.0 * 100.0 / kRuns));
  EXPECT_EQ(Instability(law, 1000, 0.1, 1, 0).at(0), 0.0);
}

TEST(Instability, IsAFunctionOfSeedSensorAndTickAlone) {
  InstabilityLaw law;
  law.sigma_mps2 = 1.0;
  law.walk_mps2 = 1.0;
  const Instability one(law, 700, 0.01, 5, 2), again(law, 700, 0.01, 5, 2), other(law, 700, 0.01, 5, 3);
  for (std::uint64_t t = 0; t <= 700; ++t) EXPECT_EQ(one.at(t), again.at(700 - (700 - t)));
  EXPECT_NE(one.at(350), other.at(350));
  EXPECT_EQ(Instability({}, 700, 0.01, 5, 2).at(350), 0.0);
}

}  // namespace
}  // namespace instability_test
}  // namespace scenario
}  // namespace plumb
