// Sets of possible faults: intersections and the merging of the nearest two.
#include "plumb/detection/fault_ranges.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

// Serves: REQ-220

namespace fault_ranges_test {
namespace {

using namespace plumb;

/// Up to six appended ones in increasing order, some touching; what was appended in `all`.
FaultRanges drawn(std::vector<FaultRange>& all) {
  FaultRanges out;
  double at = 0.01 * *rc::gen::inRange(-300, 0);
  const int count = *rc::gen::inRange(0, 7);
  for (int k = 0; k < count; ++k) {
    const double low = at + 0.01 * *rc::gen::inRange(0, 80);
    at = low + 0.01 * *rc::gen::inRange(0, 80);
    all.push_back({low, at});
    out.append(all.back());
  }
  return out;
}

bool in_any(const std::vector<FaultRange>& all, double f) {
  for (const FaultRange& r : all)
    if (r.has(f)) return true;
  return false;
}

RC_GTEST_PROP(FaultRangesLaw, WhatWasAppendedStaysPossibleAndOrderHolds, ()) {
  std::vector<FaultRange> all;
  const FaultRanges ranges = drawn(all);
  RC_ASSERT(ranges.plausible());
  for (const FaultRange& r : all) RC_ASSERT(ranges.has(r.low_mps2) && ranges.has(r.high_mps2));
  if (all.size() <= FaultRanges::kMost) {
    for (int k = -400; k <= 900; ++k) RC_ASSERT(ranges.has(0.01 * k + 0.003) == in_any(all, 0.01 * k + 0.003));
  }
}

RC_GTEST_PROP(FaultRangesLaw, TheIntersectionLosesNothingThatIsInBoth, ()) {
  std::vector<FaultRange> first, second;
  const FaultRanges a = drawn(first), b = drawn(second), both = a.with(b);
  RC_ASSERT(both.plausible());
  RC_ASSERT(a.with(FaultRanges{}).empty());
  for (int k = -400; k <= 900; ++k) {
    const double f = 0.01 * k;
    if (a.has(f) && b.has(f)) RC_ASSERT(both.has(f));
    if (both.has(f)) RC_ASSERT(both.count == FaultRanges::kMost || (a.has(f) && b.has(f)));
  }
}

TEST(FaultRanges, TheNearestTwoOfFiveBecomeOne) {
  FaultRanges ranges;
  for (const double low : {0.0, 10.0, 13.0, 20.0, 30.0}) ranges.append({low, low + 1.0});
  EXPECT_EQ(ranges.count, 4);
  EXPECT_TRUE(ranges.has(12.0));
  EXPECT_FALSE(ranges.has(5.0));
  EXPECT_FALSE(ranges.has(25.0));
  EXPECT_TRUE(ranges.has(30.5));
  const FaultRanges wide = ranges.widened(3.0);
  EXPECT_EQ(wide.count, 3);  // 14 + 3 meets 20 - 3
  EXPECT_TRUE(wide.has(17.0));
}

TEST(FaultRanges, DamageIsNoticed) {
  FaultRanges ranges;
  ranges.append({0.0, 1.0});
  ranges.append({2.0, 3.0});
  EXPECT_TRUE(ranges.plausible());
  FaultRanges swapped = ranges;
  swapped.range[0] = {5.0, 6.0};
  EXPECT_FALSE(swapped.plausible());
  FaultRanges upside = ranges;
  upside.range[1] = {3.0, 2.0};
  EXPECT_FALSE(upside.plausible());
  FaultRanges many = ranges;
  many.count = FaultRanges::kMost + 1;
  EXPECT_FALSE(many.plausible());
}

}  // namespace
}  // namespace fault_ranges_test
