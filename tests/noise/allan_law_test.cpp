// The overlapping Allan variance against its definition, and the terms' power against their Allan variance.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "plumb/core/units.hpp"
#include "plumb/noise/allan.hpp"
#include "plumb/noise/terms.hpp"

namespace allan_law_test {
namespace {

using namespace plumb;
using noise::Coefficients;
using noise::Term;

/// Numbers of everyday size: readings beside a large mean are among them.
std::vector<double> drawn_readings() {
  const double level = *rc::gen::element(0.0, 9.8, -1e6);
  const auto steps =
      *rc::gen::container<std::vector<int>>(*rc::gen::inRange<std::size_t>(2, 120), rc::gen::inRange(-1000, 1001));
  std::vector<double> out;
  for (const int step : steps) out.push_back(level + 1e-3 * step);
  return out;
}

/// By the definition: half the mean square of the difference of neighbouring means, from every place.
double by_definition(const std::vector<double>& y, std::size_t m) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k + 2 * m <= y.size(); ++k, ++count) {
    double difference = 0.0;
    for (std::size_t i = 0; i < m; ++i) difference += y[k + m + i] - y[k + i];
    sum += std::pow(difference / static_cast<double>(m), 2);
  }
  return 0.5 * sum / static_cast<double>(count);
}

RC_GTEST_PROP(AllanLaw, IsThatOfTheDefinition, ()) {
  const std::vector<double> y = drawn_readings();
  const std::size_t m = *rc::gen::inRange<std::size_t>(1, y.size() / 2 + 1);
  const double found = noise::allan_variance(noise::prefix_sums(y), m), expected = by_definition(y, m);
  RC_ASSERT(std::fabs(found - expected) <= 1e-9 * (expected + 1e-6));
}

RC_GTEST_PROP(AllanLaw, ALevelChangesNothingAndAFactorIsSquared, (int level, unsigned char factor)) {
  const std::vector<double> y = drawn_readings();
  std::vector<double> other = y;
  const double times = 1.0 + factor;
  for (double& one : other) one = times * (one - y.front()) + 1e-3 * (level % 1000);
  const double before = noise::allan_variance(noise::prefix_sums(y), 1),
               after = noise::allan_variance(noise::prefix_sums(other), 1);
  RC_ASSERT(std::fabs(after - times * times * before) <= 1e-6 * (after + 1e-12));
}

TEST(AllanLaw, OfALineIsThatOfItsDriftRate) {
  std::vector<double> line;
  for (int k = 0; k < 1000; ++k) line.push_back(5.0 + 0.01 * 0.3 * k);  // 0.3 a second at 100 Hz
  const std::vector<double> sums = noise::prefix_sums(line);
  for (const std::size_t m : {1U, 10U, 333U})
    EXPECT_NEAR(
        noise::allan_variance(sums, m) / noise::allan_variance(Term::drift_rate, 0.3, 0.01 * static_cast<double>(m)),
        1.0, 1e-9);
}

TEST(AllanLaw, NothingIsSaidBeyondHalfTheLog) {
  const std::vector<double> sums = noise::prefix_sums({1.0, 2.0, 4.0, 7.0});
  EXPECT_GT(noise::allan_variance(sums, 2), 0.0);
  EXPECT_EQ(noise::allan_variance(sums, 3), 0.0);
  EXPECT_EQ(noise::allan_variance(sums, 0), 0.0);
  EXPECT_EQ(noise::allan_variance(std::vector<double>{}, 1), 0.0);
}

TEST(AllanLaw, LengthsGoUpToAThirdOfTheLogAndNeverTwice) {
  for (const int per_octave : {1, 4, 12}) {
    const std::vector<std::size_t> lengths = noise::averaging_lengths(1000, per_octave);
    ASSERT_FALSE(lengths.empty());
    EXPECT_EQ(lengths.front(), 1U);
    EXPECT_LE(lengths.back(), 333U);
    for (std::size_t k = 1; k < lengths.size(); ++k) EXPECT_GT(lengths[k], lengths[k - 1]);
  }
  EXPECT_TRUE(noise::averaging_lengths(2, 1).empty());
}

/// The Allan variance of samples with that power: each component passes with sin^4(pi f m)/(m sin(pi f))^2, twice (IEEE
/// Std 952, annex C, for means of discrete samples). Logarithmic steps of frequency, since slow terms grow without
/// bound.
double from_power(Term term, std::size_t m, double period_s) {
  const double length = static_cast<double>(m);
  double sum = 0.0, before_f = 0.0, before_y = 0.0;
  constexpr int kSteps = 40000;
  for (int k = 0; k <= kSteps; ++k) {
    const double f = 0.5 * std::pow(1e-7, 1.0 - static_cast<double>(k) / kSteps);
    const double pass = std::pow(std::sin(kPi * f * length), 4) / std::pow(length * std::sin(kPi * f), 2);
    const double y = 4.0 * noise::power_of_unit_terms(f, period_s)[noise::index(term)] * pass;
    if (k > 0) sum += 0.5 * (y + before_y) * (f - before_f);
    before_f = f;
    before_y = y;
  }
  return sum;
}

TEST(AllanLaw, ThePowerOfEachTermGivesItsAllanVariance) {
  constexpr double kPeriod_s = 0.01;
  for (const Term term : {Term::quantisation, Term::white, Term::bias_instability, Term::random_walk}) {
    for (const std::size_t m : {1U, 5U, 40U}) {
      const double tau_s = kPeriod_s * static_cast<double>(m);
      EXPECT_NEAR(from_power(term, m, kPeriod_s) / noise::allan_variance(term, 1.0, tau_s), 1.0, 2e-3)
          << noise::to_string(term) << " over " << m;
    }
  }
}

}  // namespace
}  // namespace allan_law_test
