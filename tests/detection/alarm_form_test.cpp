#include "plumb/detection/alarm_form.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "support/simulated_tool.hpp"

namespace alarm_form_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

constexpr double kSigma = 2e-4 * kG0_mps2;

/// Independent offsets of `s_mps2` in every sensor: what a calibration may have left.
RowUncertainty offsets(int n, double s_mps2) {
  RowUncertainty u;
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(4 * i + 3);
    u.covariance[k * (k + 1) / 2 + k] = s_mps2 * s_mps2;
  }
  return u;
}

BlockEvidence block_at(const SensorArray& array, const Vec3& direction, double samples) {
  BlockEvidence block;
  block.usable = array.all();
  block.samples = samples;
  for (int i = 0; i < array.size(); ++i)
    block.mean_mps2[static_cast<std::size_t>(i)] = dot(array.axis(i), direction) * kG0_mps2;
  return block;
}

// Verifies: REQ-057
TEST(AlarmForm, QuadratureOfTheTetrahedronByHand) {
  SensorArray array = plumb_test::tetrahedron(kSigma);
  const double left = 3e-4;  // [m/s^2]
  array.set_uncertainty(offsets(4, left));
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  BlockEvidence block = block_at(array, plumb_test::direction_at(40, 70), 32.0);
  block.mean_mps2[1] += 0.01;
  block.spread_mps2_sq = 1e-4;
  const SetTest t = test_set(array, gravity, limits, block, array.all());
  const SetTest q = in_quadrature(array, gravity, block, array.all(), t);
  // The parity row is (1, 1, 1, -1)/2: half the fault over the root of sigma^2/32 + left^2.
  EXPECT_NEAR(q.parity, 0.005 / std::sqrt(kSigma * kSigma / 32.0 + left * left), 1e-9);
  EXPECT_EQ(q.parity_systematic, 0.0);
  // H'H = 4/3 I: the length has 3/4 of the variance of a sensor, and gravity has its own.
  const double sigma = std::sqrt(0.75 * (kSigma * kSigma / 32.0 + left * left) + 1e-6);
  EXPECT_NEAR(q.norm, t.norm_error_mps2 / sigma, 1e-9);
  EXPECT_NEAR(q.norm_systematic, 1e-4 / (2.0 * kG0_mps2) / sigma, 1e-12) << "motion has one sign and stays a bound";
  const SetTest pushed = in_quadrature(array, gravity, block, array.all(), t, 0.05);
  EXPECT_NEAR(pushed.norm_systematic, (1e-4 / (2.0 * kG0_mps2) + 0.05) / sigma, 1e-9) << "and so does what is steady";
  EXPECT_EQ(pushed.norm, q.norm);
}

// Verifies: REQ-057
RC_GTEST_PROP(AlarmFormLaw, WithoutAnythingSystematicBothFormsAreOne, ()) {
  const int n = *rc::gen::inRange(3, kCapacity + 1);
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  const SensorArray array = plumb_test::cone_array(n, kSigma);
  const GravityReference gravity{kG0_mps2, 0.0, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(n, 1e-5, 1e-6);
  BlockEvidence block = block_at(array, plumb_test::random_direction(noise), 32.0);
  for (int i = 0; i < n; ++i) block.mean_mps2[static_cast<std::size_t>(i)] += kSigma * noise.normal();
  const SetTest t = test_set(array, gravity, limits, block, array.all());
  const SetTest q = in_quadrature(array, gravity, block, array.all(), t);
  RC_ASSERT(std::fabs(q.parity - t.parity) <= 1e-8 * (1.0 + t.parity));
  RC_ASSERT(std::fabs(q.norm - t.norm) <= 1e-8 * (1.0 + std::fabs(t.norm)));
}

/// What only the quadrature form sees: a fault above the variances' root, below their sum.
// Negative: REQ-057
TEST(AlarmForm, TheAverageFormAlarmsWhereTheFormForEveryToolStillWaits) {
  for (const AlarmForm form : {AlarmForm::every_tool, AlarmForm::average_tool}) {
    MonitorConfig config;
    config.alarm_form = form;
    plumb_test::Rig rig(plumb_test::tetrahedron(kSigma), config);
    const double left = 1e-3;
    rig.setup.array.set_uncertainty(offsets(4, left));
    rig.restart();
    rig.prove();
    const double quadrature = 2.0 * 4.417 * std::sqrt(kSigma * kSigma / 32.0 + left * left);  // parity halves it
    rig.distort = [&](int i, double r, int) { return i == 2 ? r + 1.15 * quadrature : r; };
    const Verdict& v = rig.stay(plumb_test::direction_at(100, 340));
    const bool alarmed = v.cause == Cause::parity;
    EXPECT_EQ(alarmed, form == AlarmForm::average_tool);
  }
}

// Negative: REQ-057
TEST(AlarmForm, AnUntestedSetStaysUntested) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const GravityReference gravity{kG0_mps2, 0.0, GravityModel::value};
  const SetTest none;
  const SetTest q = in_quadrature(array, gravity, BlockEvidence{}, array.all(), none);
  EXPECT_FALSE(q.tested);
  EXPECT_EQ(q.parity, 0.0);
}

/// Three of five: those that are not asked about do not enter.
// Verifies: REQ-057
TEST(AlarmForm, AReadingOutsideTheSetChangesNothing) {
  SensorArray array = plumb_test::cone_array(6, kSigma);
  RowUncertainty u;
  for (int a = 0; a < 24; ++a) u.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = 1e-8;
  array.set_uncertainty(u);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  Noise noise(4);
  for (int i = 0; i < 6; ++i) {
    block.mean_mps2[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2 + 1e-3 * noise.normal();
  }
  const SensorSet five = array.all().without(2);
  const SetTest before = test_set(array, gravity, limits, block, five);
  const SetTest q = in_quadrature(array, gravity, block, five, before);
  block.mean_mps2[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(in_quadrature(array, gravity, block, five, before).parity, q.parity);
  EXPECT_GT(before.parity, q.parity);
}

/// A covariance below zero is none: noise alone decides.
// Negative: REQ-057
TEST(AlarmForm, AVarianceBelowZeroCountsAsNone) {
  SensorArray array = plumb_test::tetrahedron(kSigma);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  BlockEvidence block = block_at(array, plumb_test::direction_at(40, 70), 32.0);
  block.mean_mps2[1] += 0.01;
  const SetTest noise = test_set(array, gravity, limits, block, array.all());
  RowUncertainty below_zero;
  below_zero.covariance[3 * 4 / 2 + 3] = -1.0;
  array.set_uncertainty(below_zero);
  const SetTest test = test_set(array, gravity, limits, block, array.all());
  EXPECT_NEAR(in_quadrature(array, gravity, block, array.all(), test).parity, noise.parity, 1e-9);
}

}  // namespace
}  // namespace alarm_form_test
