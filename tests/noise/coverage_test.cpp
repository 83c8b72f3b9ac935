// Intervals hold the coefficients that logs were made with, as often as they say. plumb_noise_coverage runs 1e4 logs a
// case.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>

#include "plumb/noise/fit.hpp"
#include "simulated_noise.hpp"

namespace coverage_test {
namespace {

using namespace plumb;
using namespace plumb::noise;

/// Of 95 % intervals so many of `logs` hold the truth, within four sigmas of the binomial law.
void expect_coverage(const Coefficients& truth, std::size_t readings, int logs) {
  simulated_noise::Source source(truth, readings, 0.01);
  Coefficients held{};
  for (int k = 0; k < logs; ++k) {
    const NoiseFit fit = fit_noise(source.draw(20180227U + static_cast<std::uint64_t>(k)), 0.01, {});
    for (const Term term : kAllTerms) {
      const TermEstimate& one = fit.of(term);
      held[index(term)] += one.low <= truth[index(term)] && truth[index(term)] <= one.high ? 1.0 : 0.0;
    }
  }
  const double sigma = std::sqrt(0.05 * 0.95 / logs);
  for (const Term term : kAllTerms) {
    if (truth[index(term)] == 0.0) continue;
    const double share = held[index(term)] / logs;
    std::cout << "[ measured ] " << symbol(term) << " in its interval in " << 100.0 * share << " % of " << logs << "\n";
    EXPECT_GT(share, 0.93 - 4.0 * sigma) << symbol(term);
    EXPECT_LT(share, 0.97 + 4.0 * sigma) << symbol(term);
  }
}

TEST(NoiseCoverage, OfAllTermsTogether) {
  const bool is_long = std::getenv("PLUMB_LONG") != nullptr;
  expect_coverage({2e-5, 1e-3, 2e-3, 2e-3, 1e-3}, 16384, is_long ? 4000 : 250);
}

TEST(NoiseCoverage, OfWhiteNoiseAndAWalk) {
  const bool is_long = std::getenv("PLUMB_LONG") != nullptr;
  expect_coverage({0.0, 1e-3, 0.0, 2e-3, 0.0}, 8192, is_long ? 4000 : 250);
}

}  // namespace
}  // namespace coverage_test
