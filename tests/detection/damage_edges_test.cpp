// Edges of the detection room where memory is damaged or an uncertainty is none: every question still has an answer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "../../src/detection/largest_eigenvalue.hpp"
#include "plumb/detection/alarm_form.hpp"
#include "plumb/detection/channel_monitor.hpp"
#include "plumb/detection/combination_mae.hpp"
#include "plumb/detection/isolation.hpp"
#include "plumb/detection/thresholds.hpp"
#include "support/member.hpp"
#include "support/simulated_tool.hpp"

namespace {

using namespace plumb;
using plumb_test::member;

constexpr double kSigma = 2e-4 * kG0_mps2;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

BlockEvidence block_at(const SensorArray& array, const Vec3& direction) {
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  for (int i = 0; i < array.size(); ++i)
    block.mean_mps2[static_cast<std::size_t>(i)] = dot(array.axis(i), direction) * kG0_mps2;
  return block;
}

RowUncertainty of_bias(int sensor, double variance) {
  RowUncertainty u;
  const auto k = static_cast<std::size_t>(4 * sensor + 3);
  u.covariance[k * (k + 1) / 2 + k] = variance;
  return u;
}

TEST(DamageEdge, AMatrixThatIsNoneHasNoBound) {
  EXPECT_EQ(detection_detail::largest_eigenvalue({2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 1.0}), 3.0);
  EXPECT_EQ(detection_detail::largest_eigenvalue({2.0, 0.0, 0.0, 0.0, kNan, 0.0, 0.0, 0.0, 1.0}),
            std::numeric_limits<double>::infinity());
}

/// A covariance below zero is none: noise alone decides.
// Negative: REQ-057
TEST(DamageEdge, AnUncertaintyThatIsNoCovarianceLeavesNoiseAlone) {
  SensorArray array = plumb_test::tetrahedron(kSigma);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  BlockEvidence block = block_at(array, plumb_test::direction_at(40, 70));
  block.mean_mps2[1] += 0.01;
  const SetTest noise = test_set(array, gravity, limits, block, array.all());
  array.set_uncertainty(of_bias(0, -1.0));
  const SetTest test = test_set(array, gravity, limits, block, array.all());
  EXPECT_NEAR(in_quadrature(array, gravity, block, array.all(), test).parity, noise.parity, 1e-9);
}

/// What is left open of a sensor outside the set turns nothing of its vector.
TEST(DamageEdge, ASensorOutsideTheSetTurnsNothing) {
  SensorArray array = plumb_test::tetrahedron(kSigma);
  array.set_uncertainty(of_bias(3, 1e-6));
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  const BlockEvidence block = block_at(array, plumb_test::direction_at(40, 70));
  const SensorSet rest = array.all().without(3);
  const SetTest test = test_set(array, gravity, limits, block, rest);
  ASSERT_TRUE(test.tested);
  EXPECT_EQ(calibration_tilt_sigma_rad(array, test, rest), 0.0);
  const SetTest all = test_set(array, gravity, limits, block, array.all());
  EXPECT_GT(calibration_tilt_sigma_rad(array, all, array.all()), 0.0);
}

/// Where an alarm is rarer than a rejection its limit is the wider one, and a fault that all together must show is
/// harder to see than one that fewer must.
TEST(DamageEdge, AnAlarmThatIsRarerThanARejectionSetsTheThreshold) {
  const SensorArray array = plumb_test::cone_array(6, kSigma);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  TestSettings usual, rare;
  rare.false_alarm_rate = 1e-300;
  rare.rejection_rate = usual.rejection_rate = 0.5;
  usual.false_alarm_rate = 0.5;
  const Thresholds a = thresholds_of(array, gravity, usual), b = thresholds_of(array, gravity, rare);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_GT(b.sensor[i].detectable_mps2, a.sensor[i].detectable_mps2);
}

// Negative: REQ-166
TEST(DamageEdge, AWindowWhoseIndicesWouldLeadOutOfItDoesNotFit) {
  const auto sound = std::make_unique<CombinationMae>();
  sound->configure(4, 8);
  EXPECT_TRUE(sound->fits(4, 8));
  EXPECT_FALSE(sound->fits(3, 8));
  EXPECT_FALSE(sound->fits(4, 7));
  const auto damaged = std::make_unique<CombinationMae>(*sound);
  for (const int head : {-1, 8}) {
    member<8, int>(*damaged) = head;
    EXPECT_FALSE(damaged->fits(4, 8)) << head;
  }
  *damaged = *sound;
  member<6, std::uint16_t>(*damaged) = 60000;
  EXPECT_FALSE(damaged->fits(60000, 8));
  *damaged = *sound;
  member<7, std::uint16_t>(*damaged) = 60000;
  EXPECT_FALSE(damaged->fits(4, 60000));
}

TEST(DamageEdge, AWindowIsNeverEmptyAndNeverTooLong) {
  const auto mae = std::make_unique<CombinationMae>();
  mae->configure(4, 0);
  EXPECT_EQ(mae->window(), 1);
  mae->configure(4, kWindowCapacity + 1);
  EXPECT_EQ(mae->window(), kWindowCapacity);
}

/// Hours without the end of a block: the count stands still before it could run over.
TEST(DamageEdge, ABlockThatNeverEndsIsCountedUpToItsBound) {
  ChannelMonitor channels;
  std::array<double, kCapacity> full_scale{};
  channels.configure(3, full_scale, 8);
  Sample sample;
  sample.delivered = SensorSet::first(3);
  for (int k = 0; k < 1000003; ++k) {
    sample.raw[0] = k % 7;
    ASSERT_EQ(channels.gate(sample).usable, sample.delivered);
  }
  EXPECT_TRUE(channels.lost().empty());
}

/// Every byte of what it remembers set to zero in turn: it answers, convicts nobody of a sound block, and counts no
/// more sets than there are.
// Negative: REQ-166
TEST(DamageEdge, AnIsolationWithAByteLostEndsItsQuestions) {
  const SensorArray array = plumb_test::cone_array(6, kSigma);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  const BlockEvidence block = block_at(array, plumb_test::direction_at(40, 70));
  const BlockTests tests(array, gravity, limits, block);
  Isolation sound;
  sound.pose(array, array.all());
  ASSERT_GE(sound.strict_grade(), 1);
  const int all = sound.live();
  ASSERT_GT(all, 0);
  for (std::size_t byte = 0; byte < sizeof(Isolation); ++byte) {
    Isolation damaged = sound;
    std::memset(reinterpret_cast<unsigned char*>(&damaged) + byte, 0, 1);
    EXPECT_LE(damaged.live(), 70) << byte;
    const IsolationAnswer answer = damaged.vote(tests, array.all());
    EXPECT_TRUE(answer.strict.empty()) << byte;
    EXPECT_TRUE(answer.parity.empty()) << byte;
  }
}

}  // namespace
