#include "plumb/study/proportion.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace proportion_test {
namespace {

using plumb::study::interval_text;
using plumb::study::interval_words;
using plumb::study::proportion;
using plumb::study::Proportion;
using plumb::study::rounded_down;
using plumb::study::rounded_share;
using plumb::study::rounded_up;

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

// Verifies: REQ-184
TEST(Proportion, IntervalsAreRoundedOutwards) {
  const auto text = [](std::uint64_t k, std::uint64_t n) { return interval_text(proportion(k, n)); };
  EXPECT_EQ(text(20000, 20000), "[0.999815, 1]");  // 0.99981557...
  EXPECT_EQ(text(0, 20000), "[0, 0.000185]");      // 0.00018442...
  EXPECT_EQ(text(1, 1), "[0.025, 1]");
  EXPECT_EQ(text(0, 1), "[0, 0.975]");
  EXPECT_EQ(text(5, 10), "[0.187, 0.813]");
  EXPECT_EQ(text(0, 1000000), "[0, 3.69e-06]");
  EXPECT_EQ(text(1000000, 1000000), "[0.99999631, 1]");
  EXPECT_EQ(text(999999, 1000000), "[0.99999442, 0.9999999747]");
  EXPECT_EQ(text(0, 0), "[0, 1]");
  EXPECT_EQ(interval_text(proportion(0, 200), 3, 100.0), "[0, 1.83]");
}

// Verifies: REQ-184
TEST(Proportion, AOneSidedBoundIsNamedAsOne) {
  const auto words = [](std::uint64_t k, std::uint64_t n) { return interval_words(proportion(k, n)); };
  EXPECT_EQ(words(0, 20000), "at most 0.000185 with 97.5 % confidence");
  EXPECT_EQ(words(20000, 20000), "at least 0.999815 with 97.5 % confidence");
  EXPECT_EQ(words(3, 20000), "95 % interval 3.09e-05 to 0.000439");
  EXPECT_EQ(interval_words(proportion(0, 440), 3, 100.0), "at most 0.835 % with 97.5 % confidence");
  EXPECT_EQ(words(0, 0), "no trials");
}

// Negative: REQ-184
TEST(Proportion, AShareIsNeverPrintedAsAllOrNoneWhereItIsNot) {
  const auto share = [](std::uint64_t k, std::uint64_t n) { return rounded_share(proportion(k, n)); };
  EXPECT_EQ(share(20000, 20000), "1");
  EXPECT_EQ(share(0, 20000), "0");
  EXPECT_EQ(share(999999, 1000000), "0.999999");
  EXPECT_EQ(share(1, 1000000), "1e-06");
  EXPECT_EQ(share(1, 3), "0.3333");
}

/// Read back, what is printed holds what was computed.
// Verifies: REQ-184
RC_GTEST_PROP(ProportionLaw, WhatIsPrintedHoldsTheInterval, ()) {
  const auto trials = *rc::gen::inRange<std::uint64_t>(1, 3000000);
  const auto count = *rc::gen::oneOf(rc::gen::inRange<std::uint64_t>(0, trials + 1), rc::gen::just<std::uint64_t>(0),
                                     rc::gen::just(trials), rc::gen::just(trials - 1), rc::gen::just<std::uint64_t>(1));
  const int digits = *rc::gen::inRange(1, 6);
  const Proportion p = proportion(count, trials);
  const double low = std::stod(rounded_down(p.low, digits)), high = std::stod(rounded_up(p.high, digits));
  RC_ASSERT(low <= p.low);
  RC_ASSERT(high >= p.high);
  RC_ASSERT(high <= 1.0);
  RC_ASSERT(low >= 0.0);
  RC_ASSERT(p.high == 1.0 || high < 1.0 || p.high > 1.0 - 1e-13);
  RC_ASSERT(p.low == 0.0 || low > 0.0);
  // And no further than one place.
  RC_ASSERT(p.low - low <= std::pow(10.0, 1 - digits) * p.low * 1.001 + 1e-15);
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
