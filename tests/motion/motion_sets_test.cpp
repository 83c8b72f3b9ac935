// Minimal dependent sets: each null vector annihilates its axes, and no set holds another.
#include "plumb/motion/motion_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/rigid_motion.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-201

namespace motion_sets_test {
namespace {

using namespace plumb;
using plumb_test::cone_array;
using plumb_test::make_array;

void expect_sound(const SensorArray& array, const MotionSets& sets) {
  for (int k = 0; k < sets.size(); ++k) {
    Vec3 rest{};
    double length = 0.0;
    for (std::size_t j = 0; j < sets[k].size; ++j) {
      rest = plus(rest, scaled(array.axis(sets[k].sensor[j]), sets[k].null[j]));
      length += sets[k].null[j] * sets[k].null[j];
    }
    EXPECT_NEAR(length, 1.0, 1e-12);
    EXPECT_LE(norm(rest), kMotionRest + 1e-12);
    EXPECT_NEAR(norm(minus(rest, sets[k].rest)), 0.0, 1e-12);
    for (int j = 0; j < sets.size(); ++j) EXPECT_TRUE(j == k || !sets[k].all.contains(sets[j].all));
  }
}

TEST(MotionSets, OfAPaperToolAreOneSetWithEqualWeights) {
  const SensorArray array = plumb_test::tetrahedron();
  const MotionSets sets(array);
  ASSERT_EQ(sets.size(), 1);
  for (const double v : sets[0].null) EXPECT_NEAR(std::fabs(v), 0.5, 1e-12);
  expect_sound(array, sets);
}

TEST(MotionSets, OfAConeAreAllFours) {
  for (int n = 4; n <= kCapacity; ++n) {
    const SensorArray array = cone_array(n);
    const MotionSets sets(array);
    EXPECT_EQ(sets.size(), n * (n - 1) * (n - 2) * (n - 3) / 24);
    expect_sound(array, sets);
  }
}

/// Parallel axes check each other two by two; a third axis in their plane would add nothing.
TEST(MotionSets, OfParallelTriadsArePairs) {
  AxisList axes{};
  for (std::size_t i = 0; i < 6; ++i) axes[i][i % 3] = i == 4 ? -1.0 : 1.0;
  const SensorArray array = make_array(axes, 6, 0.01);
  const MotionSets sets(array);
  ASSERT_EQ(sets.size(), 3);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(sets[k].all, SensorSet::of(k).with(k + 3));
  expect_sound(array, sets);
}

TEST(MotionSets, OfThreeInAPlaneAreThatThree) {
  AxisList axes{};
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = {std::sqrt(0.5), std::sqrt(0.5), 0.0};
  axes[3] = {0.0, 0.6, 0.8};
  const SensorArray array = make_array(axes, 4, 0.01);
  const MotionSets sets(array);
  ASSERT_EQ(sets.size(), 1);
  EXPECT_EQ(sets[0].all, SensorSet::first(3));
  expect_sound(array, sets);
}

TEST(MotionSets, OfAxesParallelButForADegreeCarryWhatIsLeft) {
  AxisList axes{};
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = {0.0, 0.0, 1.0};
  axes[3] = {std::cos(rad_from_deg(1.0)), std::sin(rad_from_deg(1.0)), 0.0};
  const SensorArray array = make_array(axes, 4, 0.01);
  const MotionSets sets(array);
  ASSERT_EQ(sets.size(), 1);
  EXPECT_EQ(sets[0].all, SensorSet::of(0).with(3));
  EXPECT_GT(norm(sets[0].rest), 0.01);
  expect_sound(array, sets);
}

/// The axes of two chips say how large the force is that a slight turn of one of them mixes in.
TEST(MotionSets, OfChipsCountAllTheirAxes) {
  AxisList axes{};
  for (std::size_t i = 0; i < 6; ++i) axes[i][i % 3] = 1.0;
  const SensorArray single = make_array(axes, 6, 0.01);
  const MotionSets sets(plumb_test::in_chips(single, 3)), alone(single);
  ASSERT_EQ(sets.size(), 3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(sets[k].all, SensorSet::first(6));
    EXPECT_NEAR(sets[k].least_singular, std::sqrt(2.0), 1e-12);
    EXPECT_EQ(alone[k].all.size(), 2);
    EXPECT_EQ(alone[k].least_singular, 0.0);
  }
}

}  // namespace
}  // namespace motion_sets_test
