// Which sets may doubt gravity, and for how many of them there is room.
#include "plumb/detection/reference_doubt.hpp"

#include <gtest/gtest.h>

// Serves: REQ-061

namespace reference_doubt_test {
namespace {

using namespace plumb;

const SensorSet kTold = SensorSet::first(4), kPart = SensorSet::first(3), kOther = SensorSet::of(0).with(5);

TEST(ReferenceDoubtSets, ExcusesThePartsOfEverySetThatDoubts) {
  ReferenceDoubt doubt;
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

TEST(ReferenceDoubtSets, ExcusesEverythingOnlyBeyondTheSetsThatItHasRoomFor) {
  ReferenceDoubt doubt;
  for (int k = 1; k <= ReferenceDoubt::kMax; ++k) {
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
  claims.hear(told, 0.50, 0.25);
  claims.hear(other, -3.0, 0.25);
  claims.hear(told, 1.00, 0.25);  // from 0.75, where the first one ends
  EXPECT_FALSE(claims.refuted(told));
  claims.hear(told, 0.50, 1.00);  // says less
  EXPECT_FALSE(claims.refuted(told));
  claims.hear(told, 1.25, 0.25);
  EXPECT_TRUE(claims.refuted(told));
  EXPECT_FALSE(claims.refuted(other));
  claims.clear();
  EXPECT_FALSE(claims.refuted(told));
  claims.hear(told, 1.25, 0.25);
  EXPECT_FALSE(claims.refuted(told));
}

}  // namespace
}  // namespace reference_doubt_test
