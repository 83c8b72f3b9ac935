// By how much a tool may have turned unseen: what some sensor feels at least, and what noise hides.
#include "plumb/health/detail/motion_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/simulated_tool.hpp"

namespace motion_bound_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

// Verifies: REQ-068
TEST(MotionBound, TheShareIsCloseBelowTheLeastEigenvalue) {
  const SensorArray array = plumb_test::tetrahedron();
  // Of four axes sum h h' is 4/3 in every direction, of three of them 1/3 in one.
  const double of_four = least_share_felt(array, array.all()), true_of_four = std::sqrt(4.0 / 3.0 / 4.0);
  const double of_three = least_share_felt(array, array.all().without(0)), true_of_three = std::sqrt(1.0 / 3.0 / 3.0);
  EXPECT_LE(of_four, true_of_four);
  EXPECT_GE(of_four, 0.85 * true_of_four);
  EXPECT_LE(of_three, true_of_three + 1e-12);
  EXPECT_GE(of_three, 0.98 * true_of_three);
}

// Negative: REQ-068
TEST(MotionBound, SomeSensorFeelsThatShareWhateverTheDirection) {
  Noise noise(3);
  for (const int n : {3, 4, 5, 8}) {
    const SensorArray array = n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n);
    const double share = least_share_felt(array, array.all());
    EXPECT_GT(share, 0.0) << n;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 d = plumb_test::random_direction(noise);
      double felt = 0.0;
      for (int i = 0; i < n; ++i) felt = std::fmax(felt, std::fabs(dot(array.axis(i), d)));
      ASSERT_GE(felt, share * (1.0 - 1e-12)) << n;
    }
  }
}

// Negative: REQ-068
TEST(MotionBound, SensorsThatSpanNoSpaceFeelNoShare) {
  const SensorArray array = plumb_test::tetrahedron();
  EXPECT_NEAR(least_share_felt(array, SensorSet::of(0).with(1)), 0.0, 1e-6);
  EXPECT_EQ(least_share_felt(array, SensorSet{}), 0.0);
}

/// 2.9 times the variance of noise passes for quiet: a turn that adds 1.9 of it to a channel is hidden.
// Verifies: REQ-068
TEST(MotionBound, TheHiddenTurnScattersAChannelByWhatNoiseHides) {
  InForce in_force;
  in_force.array = plumb_test::tetrahedron();
  in_force.gravity = {kG0_mps2, 1e-4 * kG0_mps2, GravityModel::value};
  const SensorSet all = in_force.array.all();
  const double turn_rad = hidden_turn_rad(in_force, all, all, 2.9, 1.0);
  const double felt_mps2 = turn_rad * kG0_mps2 * least_share_felt(in_force.array, all);
  const double sigma_mps2 = in_force.array.sigma_mps2(0);
  EXPECT_NEAR(felt_mps2 * felt_mps2 / 12.0, 1.9 * sigma_mps2 * sigma_mps2, 1e-12);
  EXPECT_NEAR(hidden_turn_rad(in_force, all, all, 2.9, 2.0), 2.0 * turn_rad, 1e-12) << "noise of twice the sigma";
  EXPECT_EQ(hidden_turn_rad(in_force, all, all, 0.0, 1.0), 0.0) << "a row that is a station has no scatter";
}

}  // namespace
}  // namespace motion_bound_test
