#include "plumb/study/proportion.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace proportion_test {
namespace {

using plumb::study::proportion;
using plumb::study::Proportion;

// Verifies: REQ-181
TEST(Proportion, KnownIntervals) {
  // No success of n: the upper bound is 1 - (alpha/2)^(1/n).
  const Proportion none = proportion(0, 50);
  EXPECT_DOUBLE_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 1.0 - std::pow(0.025, 1.0 / 50.0), 1e-12);
  // Clopper and Pearson's table, 5 of 10.
  const Proportion half = proportion(5, 10);
  EXPECT_NEAR(half.low, 0.1871, 5e-5);
  EXPECT_NEAR(half.high, 0.8129, 5e-5);
  const Proportion wider = proportion(5, 10, 0.99);
  EXPECT_LT(wider.low, half.low);
  EXPECT_GT(wider.high, half.high);
}

// Negative: REQ-181
TEST(Proportion, NonsenseIsTamed) {
  EXPECT_EQ(proportion(7, 5).count, 5U);
  const Proportion empty = proportion(0, 0);
  EXPECT_EQ(empty.low, 0.0);
  EXPECT_EQ(empty.high, 1.0);
  EXPECT_EQ(empty.share(), 0.0);
  EXPECT_EQ(proportion(5, 10, std::nan("")).low, proportion(5, 10).low);
}

RC_GTEST_PROP(ProportionLaw, HoldsTheShareAndMirrors, ()) {
  const auto trials = *rc::gen::inRange<std::uint64_t>(1, 2000);
  const auto count = *rc::gen::inRange<std::uint64_t>(0, trials + 1);
  const Proportion p = proportion(count, trials);
  RC_ASSERT(p.low <= p.share());
  RC_ASSERT(p.share() <= p.high);
  const Proportion mirror = proportion(trials - count, trials);
  RC_ASSERT(std::abs(mirror.low - (1.0 - p.high)) < 1e-9);
}

}  // namespace
}  // namespace proportion_test
