#include "plumb/detection/set_test.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "plumb/detection/alarm_form.hpp"
#include "plumb/detection/estimate_error.hpp"
#include "plumb/numeric/tails.hpp"
#include "support/simulated_tool.hpp"

namespace set_test_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

constexpr double kSigma = 2e-4 * kG0_mps2;
const GravityReference kGravity{kG0_mps2, 0.0, GravityModel::value};

BlockEvidence exact_block(const SensorArray& array, const Vec3& direction, double g_mps2 = kG0_mps2,
                          double samples = 32) {
  BlockEvidence block;
  block.usable = array.all();
  block.samples = samples;
  for (int i = 0; i < array.size(); ++i)
    block.mean_mps2[static_cast<std::size_t>(i)] = dot(array.axis(i), direction) * g_mps2;
  return block;
}

// Verifies: REQ-052
TEST(SetTest, ParityOfTheTetrahedronIsHalfTheFault) {
  const double sigma = 0.002;
  const SensorArray array = plumb_test::tetrahedron(sigma);
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  BlockEvidence block = exact_block(array, plumb_test::direction_at(35, 70));
  block.mean_mps2[1] += 0.1;
  const SetTest t = test_set(array, kGravity, limits, block, array.all());
  ASSERT_TRUE(t.tested);
  EXPECT_EQ(t.parity_rows, 1);
  EXPECT_NEAR(t.parity, 0.5 * 0.1 / sigma * std::sqrt(32.0), 1e-6);
  EXPECT_NEAR(t.least_leverage, 0.25, 1e-12);
}

// Negative: REQ-052
TEST(SetTest, MirrorOfTheoremT1PassesATripleExactly) {
  const SensorArray array = plumb_test::tetrahedron();
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  const Vec3 u = plumb_test::direction_at(40, 25);
  BlockEvidence block = exact_block(array, u);
  // Fault f* = -2 g.w/|w|^2 of sensor 1 in the triple 1, 2, 4: the vector is mirrored, its length kept.
  const int k = array.triple_index(0, 1, 3);
  const Mat3 map = triple_map(array, k);
  const Vec3 w = {map[0], map[3], map[6]};
  const double mirror = -2.0 * kG0_mps2 * dot(u, w) / dot(w, w);
  ASSERT_GT(std::fabs(mirror), 1.0);
  block.mean_mps2[0] += mirror;
  const SetTest t = test_set(array, kGravity, limits, block, array.triple(k).set());
  EXPECT_NEAR(t.norm_error_mps2, 0.0, 1e-12);
  EXPECT_TRUE(t.consistent(limits)) << "one attitude cannot tell a mirror from the truth";
  EXPECT_GT(angle_between_rad(t.x_mps2, u), 0.1);
  EXPECT_FALSE(test_set(array, kGravity, limits, block, array.all()).parity_consistent(limits)) << "parity can";
}

// Verifies: REQ-070
TEST(SetTest, UntestedSetsAreConsistent) {
  const SensorArray array = plumb_test::tetrahedron();
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  BlockEvidence block = exact_block(array, {0, 0, 1});
  block.usable = block.usable.without(2);
  const SetTest t = test_set(array, kGravity, limits, block, array.all());
  EXPECT_FALSE(t.tested);
  EXPECT_TRUE(t.consistent(limits));
  EXPECT_TRUE(t.parity_consistent(limits));
  EXPECT_FALSE(test_set(array, kGravity, limits, block, SensorSet::first(2)).tested);
}

/// Leaving out what calibration does not add changes no bit.
// Verifies: REQ-052
TEST(SetTest, APerfectlyKnownArrayIsTestedAsWithZerosWrittenOut) {
  Noise noise(5);
  SensorArray array = plumb_test::cone_array(6);
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  const RowUncertainty zeros;
  ASSERT_TRUE(array.perfectly_known());
  for (int k = 0; k < 200; ++k) {
    BlockEvidence block = exact_block(array, plumb_test::random_direction(noise));
    for (std::size_t a = 0; a < 6; ++a) block.mean_mps2[a] += 0.01 * noise.normal();
    for (std::uint32_t bits = 1; bits <= array.all().bits; ++bits) {
      const SetTest t = test_set(array, kGravity, limits, block, SensorSet(bits));
      const SetTest written = test_set(array, zeros, kGravity, limits, block, SensorSet(bits));
      ASSERT_EQ(t.tested, written.tested);
      ASSERT_EQ(t.parity_systematic, written.parity_systematic);
      ASSERT_EQ(t.norm_systematic, written.norm_systematic);
      ASSERT_EQ(t.systematic, written.systematic);
      ASSERT_EQ(t.x_mps2, written.x_mps2);
      ASSERT_EQ(t.covariance, written.covariance);
      ASSERT_EQ(calibration_covariance(array, t, SensorSet(bits)), Mat3{});
    }
  }
  RowUncertainty little;
  little.misfit_mps2[5] = 1e-12;
  array.set_uncertainty(little);
  EXPECT_FALSE(array.perfectly_known());
  array.set_uncertainty(zeros);
  EXPECT_TRUE(array.perfectly_known());
}

/// docs/theory.md, section 3.3: a misfit is drawn anew at every attitude. The limits keep the rate, whatever its size;
/// with the factor of what is drawn once for a tool they would not.
// Verifies: REQ-056
TEST(SetTest, AMisfitOfAnySizeKeepsTheRateOfAlarms) {
  constexpr int kAttitudes = 200000;
  constexpr double kRate = 1e-5, kSamples = 32.0;
  for (const double misfits : {0.3, 3.0, 100.0}) {  // in standard deviations of a block mean
    SensorArray array = plumb_test::tetrahedron(kSigma);
    RowUncertainty left;
    const double misfit_mps2 = misfits * kSigma / std::sqrt(kSamples);
    left.misfit_mps2.fill(misfit_mps2);
    array.set_uncertainty(left);
    const TestLimits limits = TestLimits::from_rates(4, kRate, 0.1 * kRate);
    Noise noise(81);
    int alarms = 0, by_factor = 0;
    for (int k = 0; k < kAttitudes; ++k) {
      BlockEvidence block = exact_block(array, plumb_test::random_direction(noise));
      for (std::size_t a = 0; a < 4; ++a)
        block.mean_mps2[a] += kSigma / std::sqrt(kSamples) * noise.normal() + misfit_mps2 * noise.normal();
      const SetTest t = test_set(array, kGravity, limits, block, array.all());
      if (t.parity > t.parity_alarm_limit(limits)) ++alarms;
      if (t.parity > limits.parity_alarm[1] + limits.parity_calibration * misfits) ++by_factor;
    }
    EXPECT_LE(alarms, 6) << misfits;  // 2 at the rate: 7 or more in 1 of 200
    if (misfits > 50.0) {
      EXPECT_GT(by_factor, 6) << "what the factor of 99 of 100 tools would alarm";
    }
  }
}

TEST(LargestMisfit, IsThatOfTheSetAndOfNoOther) {
  SensorArray array = plumb_test::tetrahedron(kSigma);
  RowUncertainty left;
  left.misfit_mps2[0] = 3.0 * kSigma;
  left.misfit_mps2[1] = 1.0 * kSigma;
  EXPECT_DOUBLE_EQ(noise_growth(largest_misfit(array, left, array.all(), 1.0)), std::sqrt(10.0) - 1.0);
  EXPECT_DOUBLE_EQ(noise_growth(largest_misfit(array, left, array.all().without(0), 15.0)), 3.0);
  EXPECT_EQ(noise_growth(largest_misfit(array, left, SensorSet::of(2).with(3), 1e6)), 0.0);
  for (const double none : {-kSigma, std::nan("")}) {
    left.misfit_mps2[2] = none;
    EXPECT_TRUE(std::isnan(largest_misfit(array, left, array.all(), 32.0))) << none;
  }
}

/// docs/theory.md, section 3.5: an error of the gravity reference within three of its sigmas kills nothing.
// Verifies: REQ-022
RC_GTEST_PROP(SetTestLaw, GravityErrorWithinItsBoundRejectsNoSet, ()) {
  const int n = *rc::gen::inRange(3, kCapacity + 1);
  const SensorArray array = plumb_test::cone_array(n);
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  GravityReference gravity = kGravity;
  gravity.sigma_mps2 = 1e-3;
  const double off = (noise.uniform() * 2.0 - 1.0) * 2.999e-3;
  const BlockEvidence block = exact_block(array, plumb_test::random_direction(noise), kG0_mps2 + off, 1e6);
  const TestLimits limits = TestLimits::from_rates(n, 1e-5, 1e-6);
  for (SensorSet s = SensorSet::first(3); array.all().contains(s); s = next_of_same_size(s)) {
    RC_ASSERT(test_set(array, gravity, limits, block, s).consistent(limits));
  }
  RC_ASSERT(test_set(array, gravity, limits, block, array.all()).consistent(limits));
}

/// ... and an error of the calibration within k_c of its covariance kills nothing either.
// Verifies: REQ-056
RC_GTEST_PROP(SetTestLaw, CalibrationErrorWithinItsBoundRejectsNoSet, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  SensorArray array = plumb_test::cone_array(n);
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  RowUncertainty u;
  const double s_axis = 1e-4, s_offset = 1e-3;
  for (int a = 0; a < 4 * n; ++a) {
    const double s = a % 4 == 3 ? s_offset : s_axis;
    u.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = s * s;
  }
  array.set_uncertainty(u);
  const TestLimits limits = TestLimits::from_rates(n, 1e-5, 1e-6);
  const Vec3 direction = plumb_test::random_direction(noise);
  BlockEvidence block = exact_block(array, direction, kG0_mps2, 1e9);  // no noise left: only the bound protects
  // A parameter error vector of Mahalanobis length 0.95 k_c in a random direction.
  std::vector<double> error(static_cast<std::size_t>(4 * n));
  double length = 0.0;
  for (double& e : error) {
    e = noise.normal();
    length += e * e;
  }
  const double scale = 0.95 * limits.calibration / std::sqrt(length);
  for (int i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double z = c < 3 ? direction[c] * kG0_mps2 : 1.0;
      block.mean_mps2[static_cast<std::size_t>(i)] +=
          error[4 * static_cast<std::size_t>(i) + c] * scale * (c < 3 ? s_axis : s_offset) * z;
    }
  }
  for (int size = 3; size <= n; ++size) {
    for (SensorSet s = SensorSet::first(size); array.all().contains(s); s = next_of_same_size(s)) {
      RC_ASSERT(test_set(array, kGravity, limits, block, s).consistent(limits));
      RC_ASSERT(test_set(array, kGravity, limits, block, s).parity_consistent(limits));
    }
  }
}

// Verifies: REQ-052
TEST(SetTest, HealthyFullSetExceedsItsAlarmLimitAtTheRequestedRate) {
  // 200 000 blocks at 1e-3: expected 200 +- 4.5 sigma.
  const double sigma = 0.01;
  const SensorArray array = plumb_test::cone_array(6, sigma);
  const TestLimits limits = TestLimits::from_rates(6, 1e-3, 1e-6);
  Noise noise(20181);
  int parity = 0, norm_count = 0;
  for (int k = 0; k < 200000; ++k) {
    BlockEvidence block = exact_block(array, plumb_test::random_direction(noise), kG0_mps2, 1);
    for (int i = 0; i < 6; ++i) block.mean_mps2[static_cast<std::size_t>(i)] += sigma * noise.normal();
    const SetTest t = test_set(array, kGravity, limits, block, array.all());
    parity += t.parity > t.parity_alarm_limit(limits) ? 1 : 0;
    norm_count += std::fabs(t.norm) > t.norm_alarm_limit(limits) ? 1 : 0;
  }
  EXPECT_NEAR(parity, 200, 64);
  EXPECT_NEAR(norm_count, 200, 64);
}

// Negative: REQ-052
TEST(SetTest, ASetThatTheArrayDoesNotHaveIsNotTested) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  BlockEvidence block;
  block.usable = SensorSet::first(5);
  block.samples = 32.0;
  for (int i = 0; i < 4; ++i) block.mean_mps2[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2;
  EXPECT_TRUE(test_set(array, gravity, limits, block, SensorSet::first(4)).tested);
  EXPECT_FALSE(test_set(array, gravity, limits, block, SensorSet::first(5)).tested);
  EXPECT_FALSE(test_set(array, gravity, limits, block, SensorSet::first(2)).tested);
  block.samples = 0.0;
  EXPECT_FALSE(test_set(array, gravity, limits, block, SensorSet::first(4)).tested);
}

/// Free fall: no reading, no direction, and no tilt that could be told.
// Negative: REQ-052
TEST(SetTest, InFreeFallTheTiltIsOpen) {
  SensorArray array = plumb_test::tetrahedron(kSigma);
  RowUncertainty u;
  for (int a = 0; a < 16; ++a) u.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = 1e-8;
  array.set_uncertainty(u);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  const SetTest t = test_set(array, gravity, limits, block, array.all());
  ASSERT_TRUE(t.tested);
  EXPECT_EQ(calibration_tilt_sigma_rad(array, t, array.all()), kPi);
  const SetTest q = in_quadrature(array, gravity, block, array.all(), t);
  EXPECT_EQ(q.parity, 0.0);
  EXPECT_TRUE(std::isfinite(q.norm));
  // Nothing is open about a vector whose sensors err along it alone.
  block.mean_mps2 = {};
  for (int i = 0; i < 4; ++i) block.mean_mps2[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2;
  const SetTest seen = test_set(array, gravity, limits, block, array.all());
  EXPECT_EQ(tilt_sigma_rad(seen.x_mps2, {}), 0.0);
}

/// What is left open of a sensor outside the set turns nothing of its vector.
// Serves: REQ-052
TEST(SetTest, AnUncertainSensorOutsideTheSetTiltsNothing) {
  SensorArray array = plumb_test::tetrahedron(kSigma);
  RowUncertainty u;
  u.covariance[15 * 16 / 2 + 15] = 1e-6;  // the bias of the last one
  array.set_uncertainty(u);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  const BlockEvidence block = exact_block(array, plumb_test::direction_at(40, 70));
  const SensorSet rest = array.all().without(3);
  const SetTest test = test_set(array, gravity, limits, block, rest);
  ASSERT_TRUE(test.tested);
  EXPECT_EQ(calibration_tilt_sigma_rad(array, test, rest), 0.0);
  const SetTest all = test_set(array, gravity, limits, block, array.all());
  EXPECT_GT(calibration_tilt_sigma_rad(array, all, array.all()), 0.0);
}

}  // namespace
}  // namespace set_test_test
