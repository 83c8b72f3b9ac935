// Sums of a block in single precision. They are over differences from the block's first sample, which is one of those
// whose scatter they make: with D the largest difference, the sum of squares about the mean is at least D^2 / 2. By the
// rounding of 32 additions and as many products the mean is then within 1.5e-5 of the standard deviation, 8.5e-5 of its
// own standard error, and the variance within 3.6e-4 of itself: whatever the readings are.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "plumb/detection/stationarity.hpp"

namespace block_sums_test {
namespace {

using namespace plumb;

double any_in(double low, double high) { return low + (high - low) * (*rc::gen::inRange(0, 1 << 30) / 1073741824.0); }

constexpr long double wide(double value) { return static_cast<long double>(value); }

/// Noise of any size about any reading; one of the samples may stand out by any factor, the first as well.
std::vector<double> any_block() {
  const double level = any_in(-20.0, 20.0), size = std::ldexp(1.0, *rc::gen::inRange(-24, 5));
  std::vector<double> out(static_cast<std::size_t>(kWindowCapacity));
  for (double& y : out) y = level + any_in(-size, size);
  if (*rc::gen::arbitrary<bool>()) {
    const auto which = static_cast<std::size_t>(*rc::gen::inRange(0, kWindowCapacity));
    out[which] += size * std::ldexp(1.0, *rc::gen::inRange(0, 20));
  }
  return out;
}

RC_GTEST_PROP(BlockSumsLaw, MeanAndVarianceAreWithinTheStatedBounds, ()) {
  const std::vector<double> block = any_block();
  BlockAccumulator sums;
  long double mean = 0.0L;
  for (const double y : block) {
    Readings readings{};
    readings[0] = y;
    sums.add(readings, SensorSet::of(0), 1.0);
    mean += wide(y);
  }
  const auto n = static_cast<long double>(block.size());
  mean /= n;
  long double squares = 0.0L;
  for (const double y : block) squares += (wide(y) - mean) * (wide(y) - mean);
  const long double variance = squares / (n - 1.0L), deviation = std::sqrt(variance);
  RC_ASSERT(std::fabs(wide(sums.mean()[0]) - mean) <= 1.5e-5L * deviation + 1e-14L);
  RC_ASSERT(std::fabs(wide(sums.covariance(0, 0)) - variance) <= 3.6e-4L * variance + 1e-14L * deviation);
  RC_ASSERT(sums.holds());
}

}  // namespace
}  // namespace block_sums_test
