// Which sets may doubt gravity, and for how many of them there is room.
#include "plumb/detection/detail/norm_mismatch_doubt.hpp"

#include <gtest/gtest.h>

#include "detection/still_block.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-061

namespace norm_mismatch_doubt_test {
namespace {

using namespace plumb;

const SensorSet kTold = SensorSet::first(4), kPart = SensorSet::first(3), kOther = SensorSet::of(0).with(5);

TEST(NormMismatchDoubtSets, ExcusesThePartsOfEverySetThatDoubts) {
  NormMismatchDoubt doubt;
  EXPECT_FALSE(doubt.any());
  EXPECT_FALSE(doubt.excuses(kPart));
  doubt.add(kOther);
  EXPECT_TRUE(doubt.any());
  EXPECT_FALSE(doubt.excuses(kPart));
  doubt.add(kTold);
  EXPECT_TRUE(doubt.excuses(kPart));
  EXPECT_TRUE(doubt.excuses(kOther));
  EXPECT_FALSE(doubt.excuses(kTold | kOther));
}

TEST(NormMismatchDoubtSets, ExcusesEverythingOnlyBeyondTheSetsThatItHasRoomFor) {
  NormMismatchDoubt doubt;
  for (int k = 1; k <= NormMismatchDoubt::kMax; ++k) {
    doubt.add(kTold);
    ASSERT_FALSE(doubt.excuses(kOther)) << k;
    ASSERT_TRUE(doubt.excuses(kPart)) << k;
  }
  for (int k = 0; k < 10; ++k) {
    doubt.add(kTold);
    ASSERT_TRUE(doubt.excuses(kOther)) << "more than fit: " << k + 1;
  }
}

/// A claim stands while some gravity lies between all that was heard, the ends among them.
TEST(ReferenceClaims, AreRefutedWhereNoOneGravityExplainsThem) {
  const int told = static_cast<int>(kTold.bits), other = static_cast<int>(kOther.bits);
  ReferenceClaims claims;
  claims.hear(told, {0.50, 0.25});
  claims.hear(other, {-3.0, 0.25});
  claims.hear(told, {1.00, 0.25});  // from 0.75, where the first one ends
  EXPECT_FALSE(claims.refuted(told));
  claims.hear(told, {0.50, 1.00});  // says less
  EXPECT_FALSE(claims.refuted(told));
  claims.hear(told, {1.25, 0.25});
  EXPECT_TRUE(claims.refuted(told));
  EXPECT_FALSE(claims.refuted(other));
  claims.clear();
  EXPECT_FALSE(claims.refuted(told));
  claims.hear(told, {1.25, 0.25});
  EXPECT_FALSE(claims.refuted(told));
}

/// Gravity is off upward at one block and downward at the next: no one gravity explains both. That counts once the
/// second has been heard, and not while it is only held against the record.
// Verifies: REQ-061
TEST(ReferenceClaims, AreUpdatedAtAVoteAndOnlyReadOtherwise) {
  const SensorArray array = plumb_test::cone_array(6, 2e-4 * kG0_mps2);
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  const BlockEvidence block = plumb_test::block_at(array, plumb_test::direction_at(60, 30));
  const GravityReference low{0.99 * kG0_mps2, 1e-4, GravityModel::value};
  const GravityReference high{1.01 * kG0_mps2, 1e-4, GravityModel::value};
  const BlockTests above(array, low, limits, block), below(array, high, limits, block);
  const ReferencePanel panel = {array.all(), array.all(), array.units(), coplanarity(array, array.all())};
  const int told = static_cast<int>(kTold.bits);
  VoteRecord record;
  EXPECT_TRUE(hear_doubt(above, panel, record).excuses(array.all()));
  EXPECT_FALSE(record.claims.refuted(told));
  EXPECT_TRUE(recall_doubt(below, panel, record).excuses(array.all()));
  EXPECT_FALSE(record.claims.refuted(told));
  EXPECT_TRUE(hear_doubt(below, panel, record).excuses(array.all()));
  EXPECT_TRUE(record.claims.refuted(told));
}

}  // namespace
}  // namespace norm_mismatch_doubt_test
