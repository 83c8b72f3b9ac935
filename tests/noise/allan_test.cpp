// Allan deviations of logs whose answer is known.
#include "plumb/noise/allan.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulated_noise.hpp"

namespace allan_test {
namespace {

using namespace plumb;
using namespace plumb::noise;

/// The sum of the definition, over every pair of neighbouring means.
double by_definition(const std::vector<double>& readings, std::size_t m) {
  double total = 0.0;
  std::size_t pairs = 0;
  for (std::size_t at = 0; at + 2 * m <= readings.size(); ++at, ++pairs) {
    double first = 0.0, second = 0.0;
    for (std::size_t i = 0; i < m; ++i) {
      first += readings[at + i] / static_cast<double>(m);
      second += readings[at + m + i] / static_cast<double>(m);
    }
    total += (second - first) * (second - first);
  }
  return total / (2.0 * static_cast<double>(pairs));
}

/// The 1000 numbers of NIST SP 1065, section 12.4: a generator of Park and Miller's kind.
std::vector<double> thousand_points() {
  std::vector<double> out;
  std::uint64_t state = 1234567890;
  for (int k = 0; k < 1000; ++k) {
    out.push_back(static_cast<double>(state) / 2147483647.0);
    state = 16807 * state % 2147483647;
  }
  return out;
}

TEST(Allan, IsThatOfTheHandbooksThousandPoints) {
  // NIST SP 1065, table 31: overlapping Allan deviation of the 1000-point suite at averaging factors 1, 10 and 100.
  const std::vector<double> sums = prefix_sums(thousand_points());
  EXPECT_NEAR(std::sqrt(allan_variance(sums, 1)), 2.922319e-01, 5e-8);
  EXPECT_NEAR(std::sqrt(allan_variance(sums, 10)), 9.159953e-02, 5e-9);
  EXPECT_NEAR(std::sqrt(allan_variance(sums, 100)), 3.241343e-02, 5e-9);
}

TEST(Allan, OfALineIsItsSlope) {
  std::vector<double> readings;
  for (int k = 0; k < 1000; ++k) readings.push_back(7.0 + 0.25 * k);
  const std::vector<double> sums = prefix_sums(readings);
  for (const std::size_t m : {1U, 7U, 100U, 499U})
    EXPECT_NEAR(std::sqrt(allan_variance(sums, m)), 0.25 * static_cast<double>(m) / std::sqrt(2.0), 1e-7);
}

TEST(Allan, HasNoValueWhereTheLogIsTooShort) {
  const std::vector<double> sums = prefix_sums({1.0, 2.0, 4.0});
  EXPECT_GT(allan_variance(sums, 1), 0.0);
  EXPECT_EQ(allan_variance(sums, 2), 0.0);
  EXPECT_EQ(allan_variance(sums, 0), 0.0);
  EXPECT_EQ(allan_variance(prefix_sums({}), 1), 0.0);
}

RC_GTEST_PROP(Allan, IsItsDefinition, ()) {
  const int length = *rc::gen::inRange(2, 60);
  const auto codes = *rc::gen::container<std::vector<int>>(static_cast<std::size_t>(length), rc::gen::inRange(-9, 9));
  const double level = *rc::gen::element(0.0, 9.80665, -1e6);
  std::vector<double> readings;
  for (const int code : codes) readings.push_back(level + 0.125 * code);
  const std::vector<double> sums = prefix_sums(readings);
  const auto m = static_cast<std::size_t>(*rc::gen::inRange(1, length / 2 + 1));
  RC_ASSERT(std::fabs(allan_variance(sums, m) - by_definition(readings, m)) < 1e-7);
}

RC_GTEST_PROP(Allan, AveragingLengthsGrowFromOneToAThird, ()) {
  const auto readings = static_cast<std::size_t>(*rc::gen::inRange(3, 2000000));
  const int per_octave = *rc::gen::inRange(1, 9);
  const std::vector<std::size_t> lengths = averaging_lengths(readings, per_octave);
  RC_ASSERT(!lengths.empty());
  RC_ASSERT(lengths.front() == 1U);
  RC_ASSERT(lengths.back() <= readings / 3);
  RC_ASSERT(std::is_sorted(lengths.begin(), lengths.end()));
  RC_ASSERT(std::adjacent_find(lengths.begin(), lengths.end()) == lengths.end());
  RC_ASSERT(4 * lengths.back() > readings / 3);
}

TEST(EquivalentFreedom, IsThatOfTheHandbookForWhiteNoise) {
  // NIST SP 1065, section 12.4: 146.177 for 1000 readings of white noise at an averaging factor of 10, from
  // (3 (N - 1)/(2 m) - 2 (N - 2)/N) 4 m^2/(4 m^2 + 5), N = 1001 phases.
  EXPECT_NEAR(equivalent_freedom({0.0, 1.0, 0.0, 0.0, 0.0}, 1000, 10, 1.0), 146.177, 0.02 * 146.177);
  // The same formulas (section 5.4.1) at other lengths, for white, flicker and random-walk frequency noise.
  const auto white = [](double n, double m) {
    return (3.0 * (n - 1.0) / (2.0 * m) - 2.0 * (n - 2.0) / n) * 4.0 * m * m / (4.0 * m * m + 5.0);
  };
  const auto flicker = [](double n, double m) { return 5.0 * n * n / (4.0 * m * (n + 3.0 * m)); };
  const auto walk = [](double n, double m) {
    return (n - 2.0) / m * (std::pow(n - 1.0, 2) - 3.0 * m * (n - 1.0) + 4.0 * m * m) / std::pow(n - 3.0, 2);
  };
  for (const std::size_t m : {4U, 30U, 300U}) {
    const double phases = 10001.0, f = static_cast<double>(m);
    EXPECT_NEAR(equivalent_freedom({0.0, 1.0, 0.0, 0.0, 0.0}, 10000, m, 1.0) / white(phases, f), 1.0, 0.03) << m;
    EXPECT_NEAR(equivalent_freedom({0.0, 0.0, 1.0, 0.0, 0.0}, 10000, m, 1.0) / flicker(phases, f), 1.0, 0.12) << m;
    EXPECT_NEAR(equivalent_freedom({0.0, 0.0, 0.0, 1.0, 0.0}, 10000, m, 1.0) / walk(phases, f), 1.0, 0.12) << m;
  }
}

TEST(EquivalentFreedom, DoesNotDependOnUnits) {
  const Coefficients noise = {1e-5, 1e-3, 2e-3, 1e-3, 0.0};
  Coefficients scaled = noise;
  for (double& c : scaled) c *= 1e4;
  for (const std::size_t m : {1U, 16U, 1024U})
    EXPECT_NEAR(equivalent_freedom(noise, 20000, m, 0.01), equivalent_freedom(scaled, 20000, m, 0.01), 1e-6);
}

TEST(AllanIntervals, HoldTheTrueDeviation) {
  // 95 % intervals, 300 logs of white noise: between 92 and 98 % hold what the noise is (binomial, 3 sigma).
  const Coefficients noise = {0.0, 1.0, 0.0, 0.0, 0.0};
  int held = 0, judged = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const std::vector<double> readings = simulated_noise::normals(seed, 1, 2000);
    std::vector<AllanPoint> points = allan_deviation(prefix_sums(readings), 1.0, 1);
    add_intervals(points, noise, readings.size(), 1.0);
    const AllanPoint& point = points[5];
    ASSERT_EQ(point.samples, 32U);
    const double truth = std::sqrt(allan_variance(noise, point.tau_s));
    held += point.low <= truth && truth <= point.high ? 1 : 0;
    ++judged;
  }
  EXPECT_GE(held, 274) << judged;
  EXPECT_LE(held, 296) << judged;
}

}  // namespace
}  // namespace allan_test
