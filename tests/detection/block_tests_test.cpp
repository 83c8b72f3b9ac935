#include "plumb/detection/detail/block_tests.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>

#include "array/array_test_support.hpp"
#include "plumb/detection/estimate_error.hpp"
#include "plumb/detection/mae_test.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-162

namespace block_tests_test {
namespace {

using namespace plumb;

constexpr double kSigma = 2e-4 * kG0_mps2;

/// An array with uncertainty, and a block with a fault and a channel that may be silent.
struct Asked {
  SensorArray array = test::any_array();
  GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  TestLimits limits = TestLimits::from_rates(array.size(), 1e-3, 1e-6);
  BlockEvidence block;

  Asked() {
    RowUncertainty left;
    for (int a = 0; a < 4 * array.size(); ++a) {
      const double sigma = a % 4 == 3 ? 1e-3 : 1e-4;
      left.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = sigma * sigma;
    }
    array.set_uncertainty(left);
    const Vec3 u = test::any_unit();
    for (int i = 0; i < array.size(); ++i)
      block.mean_mps2[static_cast<std::size_t>(i)] = dot(array.axis(i), u) * kG0_mps2 + test::any_in(-0.05, 0.05);
    block.usable = SensorSet(*rc::gen::inRange<std::uint32_t>(0, 1U << static_cast<unsigned>(array.size())));
    block.samples = test::any_in(1.0, 64.0);
    block.spread_mps2_sq = test::any_in(0.0, 1e-4);
  }
};

bool same_figures(const SetTest& a, const SetTest& b) {
  return a.tested == b.tested && a.x_mps2 == b.x_mps2 && a.covariance == b.covariance && a.samples == b.samples &&
         a.parity == b.parity && a.norm == b.norm && a.norm_error_mps2 == b.norm_error_mps2 &&
         a.norm_sigma_mps2 == b.norm_sigma_mps2 && a.parity_systematic == b.parity_systematic &&
         a.norm_systematic == b.norm_systematic && a.systematic == b.systematic &&
         a.least_leverage == b.least_leverage && a.parity_rows == b.parity_rows;
}

/// Whatever was asked before, and however often: what is remembered is what a fresh test says.
RC_GTEST_PROP(BlockTestsLaw, RememberingChangesNothing, ()) {
  const Asked asked;
  const BlockTests tests(asked.array, asked.gravity, asked.limits, asked.block);
  const std::uint32_t all = asked.array.all().bits;
  for (int k = 0; k < 200; ++k) {
    const SensorSet set(*rc::gen::inRange<std::uint32_t>(0, all + 2));
    const SetTest fresh = test_set(asked.array, asked.gravity, asked.limits, asked.block, set);
    RC_ASSERT(same_figures(tests.of(set), fresh));
  }
}

/// What the direction loses to calibration is that of the whole covariance matrix.
RC_GTEST_PROP(BlockTestsLaw, TheTiltOfACalibrationIsThatOfItsCovariance, ()) {
  const Asked asked;
  const SetTest t = test_set(asked.array, asked.gravity, asked.limits, asked.block, asked.block.usable);
  const double whole = tilt_sigma_rad(t.x_mps2, calibration_covariance(asked.array, t, asked.block.usable));
  const double part = calibration_tilt_sigma_rad(asked.array, t, asked.block.usable);
  if (!t.tested) {
    RC_ASSERT(part == 0.0);
    return;
  }
  RC_ASSERT(std::fabs(whole - part) <= 1e-9 * whole + 1e-15);
}

/// The cheap limit of a triple is the noise part of its whole limit, but for rounding (nearly flat triples).
RC_GTEST_PROP(BlockTestsLaw, TheLeastLimitOfATripleIsItsNoise, ()) {
  Asked asked;
  asked.block.usable = asked.array.all();
  for (int k = 0; k < asked.array.triple_count(); ++k) {
    const Triple& triple = asked.array.triple(k);
    if (!triple.votes) continue;
    const SetTest t = test_set(asked.array, asked.gravity, asked.limits, asked.block, triple.set());
    const MaeLimit whole = computed_mae_limit(t, asked.block, 32, 2.0);
    const MaeLimit least = least_mae_limit(asked.array, triple, asked.block, 32, 2.0);
    RC_ASSERT(std::fabs(least.noise_mps2 - whole.noise_mps2) <= 1e-6 * whole.noise_mps2);
    RC_ASSERT(least.systematic_mps2 == 0.0);
    RC_ASSERT(whole.systematic_mps2 > 0.0);
  }
}

/// A rejected bus reads zero on all lines: a limit is still a number, and nothing is within it.
TEST(BlockTests, TheLeastLimitOfThreeThatReadZeroIsBelowEveryError) {
  const SensorArray array = plumb::test::tetrahedron();
  BlockEvidence block;
  block.samples = 32.0;
  block.usable = array.all();
  for (int k = 0; k < array.triple_count(); ++k) {
    const MaeLimit least = least_mae_limit(array, array.triple(k), block, 32, 2.0);
    EXPECT_GT(least.limit_mps2(), 0.0);
    EXPECT_LT(least.clear_mps2(1.0), 1e-300);
    EXPECT_GT(least.ratio(kG0_mps2), 1.0);
  }
}

/// Two pairs: without one of the single axes the others are a plane, so nothing corroborates it.
// Negative: REQ-060
TEST(BlockTests, ALengthThatNoSensorChecksIsNotCorroborated) {
  AxisList axes{};
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = axes[3] = {0.0, 0.0, 1.0};
  const SensorArray array = plumb_test::make_array(axes, 4, kSigma);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  block.mean_mps2[2] = block.mean_mps2[3] = kG0_mps2;
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  const BlockTests tests(array, gravity, limits, block);
  EXPECT_FALSE(tests.corroborates_norm(array.all(), SetTest{}));
  EXPECT_FALSE(tests.corroborates_norm(array.all(), tests.of(array.all())));
  const SensorArray cone = plumb_test::cone_array(6, kSigma);
  for (int i = 0; i < 6; ++i) block.mean_mps2[static_cast<std::size_t>(i)] = cone.axis(i)[2] * kG0_mps2;
  block.usable = cone.all();
  const TestLimits limits_of_six = TestLimits::from_rates(6, 1e-5, 1e-6);
  const BlockTests six(cone, gravity, limits_of_six, block);
  SetTest badly_checked = six.of(cone.all());
  badly_checked.least_leverage = 0.0;
  for (double& c : badly_checked.covariance) c *= 10.0;
  EXPECT_TRUE(six.corroborates_norm(cone.all(), badly_checked)) << "the others say the same";
  badly_checked.norm_error_mps2 += 1.0;
  EXPECT_FALSE(six.corroborates_norm(cone.all(), badly_checked)) << "the others deny it";
}

}  // namespace
}  // namespace block_tests_test
