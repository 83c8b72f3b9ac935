// Requirements on the reference that compare two models.
#include <gtest/gtest.h>

#include "plumb/gravity/gravity.hpp"

namespace requirements_gravity_test {
namespace {

using namespace plumb;

// Negative: REQ-021
TEST(RequirementPaperGravity, FallsWithDepthWhereTheNormalModelRises) {
  NormalGravityInput in;
  in.latitude_deg = 45.0;
  const double surface = normal_gravity(in)->g_mps2;
  in.depth_m = 5000.0;
  const double rise = normal_gravity(in)->g_mps2 - surface;
  const double fall = paper_gravity(45.0, 5000.0)->g_mps2 - paper_gravity(45.0, 0.0)->g_mps2;
  EXPECT_GT(rise, 0.0);
  EXPECT_LT(fall, 0.0);
  EXPECT_NEAR((fall - rise) / kG0_mps2, -1.218e-3, 2e-6) << "domain table: eq (9) against Prey at 5 km";
}

}  // namespace
}  // namespace requirements_gravity_test
