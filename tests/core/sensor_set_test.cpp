#include "plumb/core/sensor_set.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bitset>
#include <type_traits>
#include <vector>

namespace plumb {
namespace sensor_set_test {
namespace {

static_assert(std::is_trivially_copyable<SensorSet>::value, "part of every snapshot");
static_assert(SensorSet::first(4).bits == 0xFU, "usable at compile time");
static_assert(SensorSet::of(3).lowest() == 3 && SensorSet::first(24).size() == 24, "usable at compile time");

/// Any 32 bits, the empty and the full set and single members often.
SensorSet any_set() {
  const auto bits = *rc::gen::weightedOneOf<std::uint32_t>(
      {{6, rc::gen::arbitrary<std::uint32_t>()},
       {3, rc::gen::map(rc::gen::inRange(0, 65536), [](int k) { return static_cast<std::uint32_t>(k) * 65537U; })},
       {2, rc::gen::elementOf(std::vector<std::uint32_t>{0U, ~0U, 1U, 0x80000000U, 0x7FFFFFFFU})}});
  return SensorSet(bits);
}

int any_index() { return *rc::gen::inRange(-2, 35); }

TEST(SensorSet, FirstIsClampedToItsBits) {
  EXPECT_EQ(SensorSet::first(-1), SensorSet());
  EXPECT_EQ(SensorSet::first(0), SensorSet());
  EXPECT_EQ(SensorSet::first(3), SensorSet(7U));
  EXPECT_EQ(SensorSet::first(31), SensorSet(0x7FFFFFFFU));
  EXPECT_EQ(SensorSet::first(32), SensorSet(~0U));
  EXPECT_EQ(SensorSet::first(33), SensorSet(~0U));
}

TEST(SensorSet, AnIndexOutsideIsNoMember) {
  EXPECT_TRUE(SensorSet::of(-1).empty());
  EXPECT_TRUE(SensorSet::of(32).empty());
  EXPECT_FALSE(SensorSet(~0U).has(32));
  EXPECT_EQ(SensorSet(5U).with(40), SensorSet(5U));
  EXPECT_EQ(SensorSet(5U).without(-3), SensorSet(5U));
}

TEST(SensorSet, NextOfSameSizeVisitsEveryCombinationOnceInOrder) {
  const int choose[7][7] = {
      {1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}, {1, 5, 10, 10, 5, 1}, {1, 6, 15, 20, 15, 6, 1}};
  for (int n = 1; n <= 6; ++n) {
    for (int k = 1; k <= n; ++k) {
      int count = 0;
      std::uint32_t previous = 0;
      for (SensorSet s = SensorSet::first(k); SensorSet::first(n).contains(s); s = next_of_same_size(s)) {
        ASSERT_EQ(s.size(), k);
        ASSERT_GT(s.bits, previous);
        previous = s.bits;
        ++count;
      }
      EXPECT_EQ(count, choose[n][k]) << n << " choose " << k;
    }
  }
}

TEST(SensorSet, NextBeyondTheLastCombinationLeavesEveryUniverse) {
  EXPECT_EQ(next_of_same_size(SensorSet(0x80000000U)), SensorSet(~0U));
  EXPECT_EQ(next_of_same_size(SensorSet(~0U)), SensorSet(~0U));
}

RC_GTEST_PROP(SensorSetLaw, SizeCountsTheMembersAndLowestIsTheFirst, ()) {
  const SensorSet s = any_set();
  int count = 0;
  int lowest = -1;
  for (int i = 31; i >= 0; --i) {
    if (!s.has(i)) continue;
    ++count;
    lowest = i;
  }
  RC_ASSERT(s.size() == count);
  RC_ASSERT(s.size() == static_cast<int>(std::bitset<32>(s.bits).count()));
  RC_ASSERT(s.lowest() == lowest);
  RC_ASSERT(s.empty() == (count == 0));
}

RC_GTEST_PROP(SensorSetLaw, AlgebraIsThatOfSets, ()) {
  const SensorSet a = any_set();
  const SensorSet b = any_set();
  for (int i = -1; i < 33; ++i) {
    RC_ASSERT((a | b).has(i) == (a.has(i) || b.has(i)));
    RC_ASSERT((a & b).has(i) == (a.has(i) && b.has(i)));
    RC_ASSERT((a - b).has(i) == (a.has(i) && !b.has(i)));
  }
  RC_ASSERT(((a - b) | (a & b)) == a);
  RC_ASSERT(a.contains(b) == ((a | b) == a));
  RC_ASSERT((a != b) == !(a == b));
}

RC_GTEST_PROP(SensorSetLaw, WithAndWithoutChangeOneMember, ()) {
  const SensorSet s = any_set();
  const int i = any_index();
  const bool real = i >= 0 && i < 32;
  RC_ASSERT(s.with(i).has(i) == real);
  RC_ASSERT(!s.without(i).has(i));
  RC_ASSERT(s.with(i).without(i) == s.without(i));
  RC_ASSERT((s.with(i) - SensorSet::of(i)) == s.without(i));
}

RC_GTEST_PROP(SensorSetLaw, NextHasTheSameSizeAndNothingLiesBetween, ()) {
  const SensorSet s = SensorSet(any_set().bits & 0xFFFFU);
  RC_PRE(!s.empty());
  const SensorSet next = next_of_same_size(s);
  RC_ASSERT(next.size() == s.size());
  RC_ASSERT(next.bits > s.bits);
  const std::uint32_t end = next.bits - s.bits > 300U ? s.bits + 300U : next.bits;
  for (std::uint32_t between = s.bits + 1; between < end; ++between) RC_ASSERT(SensorSet(between).size() != s.size());
}

}  // namespace
}  // namespace sensor_set_test
}  // namespace plumb
