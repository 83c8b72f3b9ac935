// Which faults explain what was rejected, against a search over all sets; grades of sensors and of chips.
#include "plumb/motion/motion_evidence.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

#include "motion/rigid_motion.hpp"

// Serves: REQ-201, REQ-209

namespace motion_evidence_test {
namespace {

using namespace plumb;
using plumb_test::cone_array;
using plumb_test::make_array;

RC_GTEST_PROP(RejectedSetsLaw, AnswerAsASearchOverAllSets, ()) {
  const int n = *rc::gen::inRange(4, kMotionCapacity + 1), most = *rc::gen::inRange(0, kMotionDepth + 1);
  const SensorUnits units = cone_array(n).units();
  const auto sets =
      *rc::gen::container<std::vector<std::uint32_t>>(rc::gen::inRange(1U, 1U << static_cast<unsigned>(n)));
  RejectedSets rejected;
  for (const std::uint32_t bits : sets) rejected.add(SensorSet(bits));
  SensorSet isolated = SensorSet::first(n), suspects;
  int least = most + 1;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::uint32_t bits = 0; bits < (1U << static_cast<unsigned>(n)); ++bits) {
      const SensorSet faults(bits);
      if (faults.size() > most) continue;
      bool explains = true;
      for (const std::uint32_t set : sets) explains = explains && (bits & set) != 0;
      if (!explains) continue;
      if (faults.size() < least) least = faults.size();
      if (pass == 1 && faults.size() == least) suspects = suspects | faults;
      isolated = isolated & faults;
    }
  }
  const MotionAnswer answer = rejected.answer(units, SensorSet::first(n), most);
  if (sets.empty()) {
    RC_ASSERT(answer.least == 0 && answer.isolated.empty() && answer.suspects.empty());
  } else {
    RC_ASSERT(answer.least == least);
    RC_ASSERT(answer.suspects == suspects);
    RC_ASSERT(answer.isolated == (least > most ? SensorSet{} : isolated));
  }
}

/// T11: while every rejected set has a faulty member, and no more are faulty than are searched for, nobody else is
/// isolated.
RC_GTEST_PROP(RejectedSetsLaw, IsolateNoHealthySensor, ()) {
  const int n = *rc::gen::inRange(4, kMotionCapacity + 1), most = *rc::gen::inRange(1, kMotionDepth + 1);
  const SensorUnits units = cone_array(n).units();
  SensorSet faulty;
  for (int k = 0; k < most; ++k) faulty = faulty.with(*rc::gen::inRange(0, n));
  RejectedSets rejected;
  for (int k = *rc::gen::inRange(0, 200); k > 0; --k) {
    const SensorSet set(*rc::gen::inRange(1U, 1U << static_cast<unsigned>(n)));
    if (!(set & faulty).empty()) rejected.add(set);
  }
  RC_ASSERT(faulty.contains(rejected.answer(units, SensorSet::first(n), most).isolated));
}

TEST(RejectedSets, ForgetThoseThatLeave) {
  RejectedSets rejected;
  rejected.add(SensorSet(0b001111));
  rejected.add(SensorSet(0b111100));
  rejected.keep_within(SensorSet(0b111110));
  EXPECT_TRUE(rejected.explained_by(SensorSet::of(5)));
  EXPECT_FALSE(rejected.explained_by(SensorSet::of(1)));
  rejected.clear();
  EXPECT_TRUE(rejected.empty());
}

/// Every set of four that holds one sensor: that sensor, and no other one alone.
TEST(RejectedSets, HaveRoomForEverySet) {
  const SensorUnits units = cone_array(kMotionCapacity).units();
  RejectedSets rejected;
  for (SensorSet s = SensorSet::first(4); SensorSet::first(kMotionCapacity).contains(s); s = next_of_same_size(s)) {
    if (s.has(0)) {
      EXPECT_TRUE(rejected.add(s));
    }
  }
  EXPECT_FALSE(rejected.add(SensorSet::first(5))) << "it holds one that is known";
  const MotionAnswer answer = rejected.answer(units, SensorSet::first(kMotionCapacity), 2);
  EXPECT_EQ(answer.least, 1);
  EXPECT_EQ(answer.isolated, SensorSet::of(0));
  EXPECT_EQ(answer.suspects, SensorSet::of(0));
}

TEST(MotionGrade, OfSensorsIsTheProvisionalOne) {
  for (int n = 4; n <= kMotionCapacity; ++n) {
    const SensorArray array = cone_array(n);
    const int expected = provisional_grade(array, array.all());
    EXPECT_EQ(motion_grade(array, array.all()), expected < kMotionDepth ? expected : kMotionDepth) << n;
  }
}

/// T12: of three parallel chips one can be told, of two none.
// Negative: REQ-209
TEST(MotionGrade, OfChipsCountsChips) {
  for (int chips = 1; chips <= 2; ++chips) {
    const SensorArray array = plumb_test::parallel_triads(chips);
    EXPECT_EQ(array.units().size(), chips);
    EXPECT_EQ(motion_grade(array, array.all()), 0);
  }
  // Two chips and two single sensors along the diagonals: one chip's loss leaves five axes, so one unit is told.
  AxisList axes{};
  for (std::size_t i = 0; i < 6; ++i) axes[i][i % 3] = 1.0;
  const double third = std::sqrt(1.0 / 3.0);
  axes[6] = {third, third, third};
  axes[7] = {third, -third, third};
  const SensorArray array = plumb_test::in_chips(make_array(axes, 8, 0.01), 3, 6);
  EXPECT_EQ(array.units().size(), 4);
  EXPECT_EQ(motion_grade(array, array.all()), 0) << "both chips gone, two axes are left";
  EXPECT_EQ(array.units().count(SensorSet(0b01000011)), 2);
}

}  // namespace
}  // namespace motion_evidence_test
