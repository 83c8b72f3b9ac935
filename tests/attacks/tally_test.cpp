// What episodes of an attack came to, added up.
#include "tally.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tally_test {
namespace {

using plumb_bench::Count;
using plumb_bench::kNominalBins;
using plumb_bench::Tally;

TEST(AttackTally, AddsEveryNumber) {
  Tally a, b;
  for (int k = 0; k < plumb_bench::kCounts; ++k) {
    a[static_cast<Count>(k)] = static_cast<std::uint64_t>(k);
    b[static_cast<Count>(k)] = 100;
  }
  a.to_nominal[3] = 2;
  b.to_nominal[3] = 5;
  b.to_nominal[kNominalBins - 1] = 1;
  a.add(b);
  for (int k = 0; k < plumb_bench::kCounts; ++k) {
    EXPECT_EQ(a[static_cast<Count>(k)], static_cast<std::uint64_t>(k) + 100U) << k;
  }
  EXPECT_EQ(a.to_nominal[3], 7U);
  EXPECT_EQ(a.to_nominal[kNominalBins - 1], 1U);
}

TEST(AttackTally, UnsafeIsTheSafetyColumnsAlone) {
  Tally t;
  t[Count::episodes] = t[Count::failed] = t[Count::unpromised] = t[Count::false_doubt] = 7;
  EXPECT_EQ(t.unsafe(), 0U);
  for (const Count c : plumb_bench::kSafety) t[c] = 1;
  EXPECT_EQ(t.unsafe(), plumb_bench::kSafety.size());
}

TEST(AttackTally, MedianOfBlocksToNominal) {
  Tally t;
  t.to_nominal[4] = 3;
  t.to_nominal[9] = 2;
  EXPECT_EQ(t.median_to_nominal(), 4U);
  t.to_nominal[kNominalBins - 1] = 6;
  EXPECT_EQ(t.median_to_nominal(), kNominalBins - 1) << "more than half of them never";
}

TEST(AttackTally, EveryCountHasANameOfItsOwn) {
  std::set<std::string> names;
  for (int k = 0; k < plumb_bench::kCounts; ++k) names.insert(to_string(static_cast<Count>(k)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(plumb_bench::kCounts));
  EXPECT_EQ(names.count("?"), 0U);
}

}  // namespace
}  // namespace tally_test
