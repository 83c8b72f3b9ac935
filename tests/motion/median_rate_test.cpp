// The median of gyro triads (docs/theory.md, T15).
#include "plumb/motion/median_rate.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

// Serves: REQ-214

namespace median_rate_test {
namespace {

using namespace plumb;

TriadRates of(const std::vector<Vec3>& rates) {
  TriadRates out;
  out.triads = static_cast<int>(rates.size());
  for (std::size_t k = 0; k < rates.size(); ++k) {
    out.rate_radps[k] = rates[k];
    out.given[k] = true;
  }
  return out;
}

/// Any number: what a gyro that failed may read.
double anything() {
  return *rc::gen::oneOf(rc::gen::arbitrary<double>(),
                         rc::gen::element(0.0, 1e308, -1e308, std::numeric_limits<double>::infinity(),
                                          std::numeric_limits<double>::quiet_NaN()));
}

// Verifies: REQ-214
RC_GTEST_PROP(MedianRateLaw, EachComponentLiesBetweenTwoHealthyTriads, ()) {
  const int triads = *rc::gen::inRange(1, kMostTriads + 1);
  const int faults = (triads - 1) / 2;
  TriadRates rates;
  rates.triads = triads;
  std::vector<int> order(static_cast<std::size_t>(triads));
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
  std::shuffle(order.begin(), order.end(), std::mt19937(*rc::gen::arbitrary<std::uint32_t>()));
  Vec3 least{}, most{};
  least.fill(HUGE_VAL);
  most.fill(-HUGE_VAL);
  int silent = 0;
  for (int k = 0; k < triads; ++k) {
    const auto at = static_cast<std::size_t>(order[static_cast<std::size_t>(k)]);
    rates.given[at] = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const double healthy = 0.001 * *rc::gen::inRange(-10000, 10001);
      rates.rate_radps[at][c] = k < faults ? anything() : healthy;
      if (k < faults) continue;
      least[c] = std::min(least[c], healthy);
      most[c] = std::max(most[c], healthy);
    }
    const Vec3& w = rates.rate_radps[at];
    if (!(std::isfinite(w[0]) && std::isfinite(w[1]) && std::isfinite(w[2]))) ++silent;
  }
  const MedianRate found = median_rate(rates, faults);
  RC_ASSERT(found.given == (triads - silent > 2 * faults));
  if (!found.given) return;
  for (std::size_t c = 0; c < 3; ++c) {
    RC_ASSERT(found.rate_radps[c] >= least[c]);
    RC_ASSERT(found.rate_radps[c] <= most[c]);
  }
}

// What it is stated to be off by holds of the length of its error, at the largest errors of healthy triads too.
// Verifies: REQ-214
RC_GTEST_PROP(MedianRateLaw, ItsErrorIsWithinWhatIsStated, ()) {
  const GyroErrors triad = {0.01 * *rc::gen::inRange(0, 20), 0.01 * *rc::gen::inRange(0, 20),
                            0.001 * *rc::gen::inRange(0, 20), 0.001 * *rc::gen::inRange(0, 5), 0.0};
  constexpr double kSigmas = 3.0;
  const auto part = [] { return *rc::gen::oneOf(rc::gen::element(-1.0, 1.0), rc::gen::just(0.0)); };
  const Vec3 truth = {0.1 * *rc::gen::inRange(-100, 101), 0.1 * *rc::gen::inRange(-100, 101),
                      0.1 * *rc::gen::inRange(-100, 101)};
  TriadRates rates;
  rates.triads = 3;
  for (std::size_t g = 0; g < 3; ++g) {
    rates.given[g] = true;
    for (std::size_t c = 0; c < 3; ++c) {
      // A turn of an axis reads across it: by the length of what lies there.
      const double across = std::sqrt(dot(truth, truth) - truth[c] * truth[c]);
      rates.rate_radps[g][c] = truth[c] * (1.0 + part() * triad.scale) + part() * triad.axis_rad * across +
                               part() * (triad.bias_radps + kSigmas * triad.noise_radps);
    }
  }
  rates.rate_radps[1] = {anything(), anything(), anything()};
  const MedianRate found = median_rate(rates, 1);
  const Vec3& third = rates.rate_radps[1];
  RC_ASSERT(found.given == (std::isfinite(third[0]) && std::isfinite(third[1]) && std::isfinite(third[2])));
  if (!found.given) return;
  const double error = norm(minus(found.rate_radps, truth));
  RC_ASSERT(error <= median_error_radps(triad, norm(found.rate_radps), kSigmas) * (1.0 + 1e-12) + 1e-12);
}

// Verifies: REQ-214
TEST(MedianRate, WhereScaleAndAxesMayBeAnythingNothingIsStated) {
  EXPECT_EQ(median_error_radps({0.4, 0.2, 0.0, 0.0, 0.0}, 1.0, 6.0), std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(median_error_radps({0.0, 0.0, 0.1, 0.0, 0.0}, 1.0, 6.0), 0.1 * std::sqrt(3.0));
}

// With one fault more than it is asked to stand, it goes where the faulty ones want.
TEST(MedianRate, TwoOfThreeOutvoteTheThird) {
  const MedianRate found = median_rate(of({{9.0, 9.0, 9.0}, {1.0, 1.0, 1.0}, {9.5, 9.5, 9.5}}), 1);
  ASSERT_TRUE(found.given);
  EXPECT_DOUBLE_EQ(found.rate_radps[0], 9.0);
}

// Negative: REQ-214
TEST(MedianRate, OneMeasuresTwoAreAveragedAndTooFewGiveNothing) {
  EXPECT_EQ(median_rate(of({{1.0, 2.0, 3.0}}), 0).rate_radps, (Vec3{1.0, 2.0, 3.0}));
  EXPECT_EQ(median_rate(of({{1.0, 2.0, 3.0}, {3.0, 2.0, 1.0}}), 0).rate_radps, (Vec3{2.0, 2.0, 2.0}));
  EXPECT_FALSE(median_rate(of({{1.0, 2.0, 3.0}, {3.0, 2.0, 1.0}}), 1).given);
  EXPECT_FALSE(median_rate(TriadRates{}, 0).given);
  EXPECT_FALSE(median_rate(of({{1.0, 2.0, 3.0}}), -1).given);
  TriadRates one_silent = of({{1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {3.0, 0.0, 0.0}});
  one_silent.given[1] = false;
  EXPECT_FALSE(median_rate(one_silent, 1).given);
  EXPECT_DOUBLE_EQ(median_rate(one_silent, 0).rate_radps[0], 2.0);
}

TEST(MedianRate, ACountBeyondTheRoomIsTheRoom) {
  TriadRates rates = of(std::vector<Vec3>(kMostTriads, Vec3{1.0, 1.0, 1.0}));
  rates.triads = 1000;
  EXPECT_TRUE(median_rate(rates, 3).given);
  rates.triads = -1;
  EXPECT_FALSE(median_rate(rates, 0).given);
}

}  // namespace
}  // namespace median_rate_test
