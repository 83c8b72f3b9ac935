// Terms of noise found again in logs that were made with them.
#include "plumb/noise/fit.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "plumb/core/units.hpp"
#include "simulated_noise.hpp"

namespace fit_test {
namespace {

using namespace plumb;
using namespace plumb::noise;

constexpr double kPeriod_s = 0.01;

std::vector<double> log_of(const Coefficients& truth, std::size_t readings, std::uint64_t seed) {
  return simulated_noise::Source(truth, readings, kPeriod_s).draw(seed);
}

TEST(NoiseFit, FindsAllTermsOfALongLog) {
  const Coefficients truth = {2e-5, 1e-3, 2e-3, 2e-3, 1e-3};
  const NoiseFit fit = fit_noise(log_of(truth, 60000, 3), kPeriod_s, {});
  for (const Term term : kAllTerms) {
    const TermEstimate& one = fit.of(term);
    EXPECT_TRUE(one.visible) << symbol(term);
    EXPECT_NEAR(one.value / truth[index(term)], 1.0, 0.35) << symbol(term);
    EXPECT_LT(one.low, one.value) << symbol(term);
    EXPECT_GT(one.high, one.value) << symbol(term);
    EXPECT_FALSE(one.more_hours.has_value()) << symbol(term);
  }
  EXPECT_EQ(fit.misfit, 1.0);
  EXPECT_NEAR(fit.highest_hz, 50.0, 1e-9);
}

TEST(NoiseFit, SaysHowMuchLongerALogMustBeForATermThatItDoesNotShow) {
  const Coefficients truth = {0.0, 1e-3, 0.0, 2e-5, 0.0};
  const std::vector<double> readings = log_of(truth, 20000, 5);
  const NoiseFit fit = fit_noise(readings, kPeriod_s, {});
  EXPECT_TRUE(fit.of(Term::white).visible);
  const TermEstimate& walk = fit.of(Term::random_walk);
  EXPECT_FALSE(walk.visible);
  EXPECT_EQ(walk.low, 0.0);
  EXPECT_GT(walk.high, truth[index(Term::random_walk)]);
  ASSERT_TRUE(walk.more_hours.has_value());
  EXPECT_GT(*walk.more_hours, 0.2 * 200.0 / 3600.0);
  // It keeps its promise: a walk of half the bound shows in a log of that length.
  const auto length = 20000 + static_cast<std::size_t>(*walk.more_hours * 3600.0 / kPeriod_s);
  int shown = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const NoiseFit longer =
        fit_noise(log_of({0.0, 1e-3, 0.0, 0.5 * walk.high, 0.0}, length, 100 + seed), kPeriod_s, {});
    shown += longer.of(Term::random_walk).visible ? 1 : 0;
  }
  EXPECT_GE(shown, 8);
}

TEST(NoiseFit, GoesOnlyByFrequenciesBelowAnOutputFilter) {
  // A running mean of four halves the power at 11 Hz and takes all of it at 25 Hz.
  const std::vector<double> white = log_of({0.0, 1e-3, 0.0, 0.0, 0.0}, 60004, 7);
  std::vector<double> filtered;
  for (std::size_t k = 0; k + 4 <= white.size(); ++k)
    filtered.push_back(0.25 * (white[k] + white[k + 1] + white[k + 2] + white[k + 3]));
  const NoiseFit fit = fit_noise(filtered, kPeriod_s, {});
  EXPECT_LT(fit.highest_hz, 12.0);
  EXPECT_GT(fit.highest_hz, 0.7);
  EXPECT_EQ(fit.misfit, 1.0);
  EXPECT_NEAR(fit.of(Term::white).value, 1e-3, 0.05e-3);
}

TEST(NoiseFit, LeavesOutBandsWithLines) {
  std::vector<double> readings = log_of({0.0, 1e-3, 0.0, 0.0, 0.0}, 40000, 9);
  for (std::size_t k = 0; k < readings.size(); ++k)
    readings[k] += 0.05 * std::sin(2.0 * kPi * 7.3 * static_cast<double>(k) * kPeriod_s);
  const NoiseFit with = fit_noise(readings, kPeriod_s, {});
  EXPECT_LT(with.highest_hz, 7.3);  // it holds below the line at best
  const NoiseFit fit = fit_noise(readings, kPeriod_s, {{6.0, 8.6}});
  EXPECT_EQ(fit.misfit, 1.0);
  EXPECT_NEAR(fit.highest_hz, 50.0, 1e-9);
  EXPECT_NEAR(fit.of(Term::white).value, 1e-3, 0.05e-3);
}

TEST(NoiseFit, OfALongLogIsThatOfItsPieces) {
  // Above 2^18 readings the log is cut into pieces: the same truth is found, and more sharply.
  const Coefficients truth = {2e-5, 1e-3, 0.0, 3e-4, 0.0};
  const NoiseFit longer = fit_noise(log_of(truth, 400000, 11), kPeriod_s, {});
  const NoiseFit shorter = fit_noise(log_of(truth, 100000, 11), kPeriod_s, {});
  for (const Term term : {Term::quantisation, Term::white, Term::random_walk}) {
    const TermEstimate& one = longer.of(term);
    EXPECT_NEAR(one.value / truth[index(term)], 1.0, 0.2) << symbol(term);
    const double part = (one.high - one.low) / (shorter.of(term).high - shorter.of(term).low);
    EXPECT_NEAR(part, 0.5, 0.15) << symbol(term);
  }
}

TEST(NoiseFit, DriftHasItsSign) {
  const NoiseFit fit = fit_noise(log_of({0.0, 1e-3, 0.0, 0.0, -1e-3}, 8192, 13), kPeriod_s, {});
  const TermEstimate& drift = fit.of(Term::drift_rate);
  EXPECT_TRUE(drift.visible);
  EXPECT_NEAR(drift.value, -1e-3, 2e-5);
  EXPECT_LT(drift.low, drift.value);
  EXPECT_LT(drift.high, 0.0);
}

RC_GTEST_PROP(NoiseFit, ScalesWithUnitsAndRate, ()) {
  const auto seed = static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000000));
  const double unit = *rc::gen::element(1e-6, 1.0, 2048.0, 1e9);
  const double rate = *rc::gen::element(0.5, 1.0, 8.0);
  const double level = *rc::gen::element(0.0, -33123.0);
  const std::vector<double> readings = log_of({1e-5, 1e-3, 5e-4, 1e-3, 1e-4}, 2048, seed);
  std::vector<double> scaled;
  for (const double y : readings) scaled.push_back(unit * (y + level));
  const NoiseFit one = fit_noise(readings, kPeriod_s, {}), other = fit_noise(scaled, kPeriod_s / rate, {});
  // tau is shorter by the rate: Q per time, N per root of it, B, K times the root, R times it.
  const double per[] = {1.0 / rate, 1.0 / std::sqrt(rate), 1.0, std::sqrt(rate), rate};
  for (const Term term : kAllTerms) {
    const double factor = unit * per[index(term)];
    const double size = 1e-3 * one.of(term).high * factor + 1e-12 * unit;
    RC_ASSERT(std::fabs(other.of(term).high - one.of(term).high * factor) <= 20.0 * std::fabs(size));
  }
}

RC_GTEST_PROP(NoiseFit, HoldsItsOwnEstimateForAnyReadings, ()) {
  // Readings that are no noise at all: steps, few codes, spikes.
  const auto readings =
      *rc::gen::container<std::vector<double>>(300, rc::gen::element(0.0, 1.0, -1.0, 1e3, 1e-9, 1.0 / 3.0));
  RC_PRE(std::set<double>(readings.begin(), readings.end()).size() > 1);
  const NoiseFit fit = fit_noise(readings, kPeriod_s, {});
  for (const Term term : kAllTerms) {
    const TermEstimate& one = fit.of(term);
    RC_ASSERT(std::isfinite(one.value) && std::isfinite(one.low) && std::isfinite(one.high));
    RC_ASSERT(one.low <= one.value && one.value <= one.high);
  }
}

}  // namespace
}  // namespace fit_test
