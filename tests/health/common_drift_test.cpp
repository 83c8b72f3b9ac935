// A bias that all sensors share is seen whole by no test: the protection level carries the bound that was stated.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "support/simulated_tool.hpp"

namespace common_drift_test {
namespace {

using namespace plumb;
using plumb_test::Noise;
using plumb_test::random_direction;
using plumb_test::Rig;

struct Beyond {
  int valid = 0, beyond = 0;
  double worst = 0.0;
};

/// Blocks called valid, and those whose error exceeds their protection level, under common drifts of up to 3 mg.
Beyond run(double stated_mps2, double drift_share) {
  Beyond out;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const int n = 4 + static_cast<int>(seed % 5);
    MonitorConfig config;
    config.common_drift_mps2 = stated_mps2;
    Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), config, seed);
    rig.prove();
    Noise noise(seed);
    const double drift = drift_share * 3e-3 * kG0_mps2 * (2.0 * noise.uniform() - 1.0);
    rig.distort = [drift](int, double r, int) { return r + drift; };
    for (int k = 0; k < 12; ++k) {
      const Vec3 u = random_direction(noise);
      const Verdict& v = rig.stay(u);
      if (v.validity != Validity::valid || !v.protection_available) continue;
      ++out.valid;
      const double error = angle_between_rad(v.gravity_mps2, u);
      if (error > v.protection_level_rad) ++out.beyond;
      out.worst = std::fmax(out.worst, error / v.protection_level_rad);
    }
  }
  return out;
}

// Verifies: REQ-123
TEST(CommonDrift, WithinTheStatedBoundNothingValidIsBeyondItsProtectionLevel) {
  const Beyond out = run(3e-3 * kG0_mps2, 1.0);
  RecordProperty("valid_blocks", out.valid);
  EXPECT_GT(out.valid, 100);
  EXPECT_EQ(out.beyond, 0) << "worst " << out.worst;
}

// Negative: REQ-123
TEST(CommonDrift, WithoutTheTermValidBlocksAreBeyondIt) {
  const Beyond out = run(0.0, 1.0);
  RecordProperty("beyond", out.beyond);
  EXPECT_GT(out.beyond, 10) << "of " << out.valid;
  EXPECT_GT(out.worst, 3.0);
}

}  // namespace
}  // namespace common_drift_test
