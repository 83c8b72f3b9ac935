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
#include "plumb/detection/stationarity.hpp"
#include "plumb/detection/thresholds.hpp"
#include "support/member.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-166

namespace detection_damage_edges_test {
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
  rare.false_alarm_rate = 1e-12;
  rare.rejection_rate = usual.rejection_rate = 1e-2;
  usual.false_alarm_rate = 1e-2;
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

/// The readings are moved by as many places as sensors are missing: of an array that says that it has fewer than none,
/// or more than fit, none is moved, and each triple is taken alone.
// Negative: REQ-166
TEST(DamageEdge, AnArrayOfAnImpossibleSizeMovesNoReading) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const Readings y = block_at(array, plumb_test::direction_at(40, 70)).mean_mps2;
  const auto sound = std::make_unique<CombinationMae>();
  sound->configure(4, 8);
  sound->add(array, y, array.all(), nullptr, kG0_mps2);
  for (const int size : {-1, kCapacity + 1}) {
    SensorArray damaged = array;
    member<4, int>(damaged) = size;
    const auto mae = std::make_unique<CombinationMae>();
    mae->configure(4, 8);
    mae->add(damaged, y, array.all(), nullptr, kG0_mps2);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(mae->triple_sum(k), sound->triple_sum(k)) << size << " " << k;
  }
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

/// Two sensors of six are wrong. A grade that memory has lowered convicts no more than it says.
// Negative: REQ-166
TEST(DamageEdge, ALoweredGradeConvictsNoMoreThanItSays) {
  const SensorArray array = plumb_test::cone_array(6, kSigma);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  Isolation sound;
  sound.pose(array, array.all());
  ASSERT_GE(sound.strict_grade(), 2);
  Isolation damaged = sound;
  member<7, std::int8_t>(damaged) = 1;
  SensorSet convicted;
  for (int k = 0; k < 8; ++k) {
    BlockEvidence block = block_at(array, plumb_test::direction_at(20 + 20 * k, 70 * k));
    block.mean_mps2[1] += 0.5;
    block.mean_mps2[4] -= 0.7;
    const BlockTests tests(array, gravity, limits, block);
    convicted = convicted | sound.vote(tests, array.all()).strict;
    EXPECT_TRUE(damaged.vote(tests, array.all()).strict.empty()) << k;
  }
  EXPECT_EQ(convicted, SensorSet(0b10010U));
}

/// One sensor is far off, another by a little more and more: those that agree in fours need not agree in fives, and
/// where they do not, nobody is set aside.
// Negative: REQ-070
TEST(IsolationDoubt, WhoAgreesInPartsButNotTogetherAccusesNobody) {
  const SensorArray array = plumb_test::cone_array(6, kSigma);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  Isolation isolation;
  int one = 0, two = 0, nobody = 0;
  for (int k = 0; k < 400; ++k) {
    BlockEvidence block = block_at(array, plumb_test::direction_at(60, 30));
    block.mean_mps2[5] += 1.0;
    block.mean_mps2[0] += 1e-4 * k;
    isolation.clear();
    isolation.pose(array, array.all());
    const BlockTests tests(array, gravity, limits, block);
    const SensorSet accused = isolation.vote(tests, array.all()).parity;
    one += accused == SensorSet::of(5) ? 1 : 0;
    two += accused == SensorSet::of(5).with(0) ? 1 : 0;
    nobody += accused.empty() ? 1 : 0;
  }
  EXPECT_GT(one, 0);
  EXPECT_GT(two, 0);
  EXPECT_GT(nobody, 0);
  EXPECT_EQ(one + two + nobody, 400);
}

/// A sensor so quiet that the others hardly check it, off by so much that they deny what it makes of the length, though
/// all agree within their limit: none of the healthy ones pays for it.
// Negative: REQ-070
TEST(IsolationDoubt, WhoIsHardlyCheckedConvictsNobodyElse) {
  SensorArray array = plumb_test::cone_array(5, kSigma);
  std::array<SensorRow, 5> rows{};
  for (int i = 0; i < 5; ++i) rows[static_cast<std::size_t>(i)] = array.row(i);
  rows[4].sigma_mps2 = 0.01 * kSigma;
  ASSERT_TRUE(array.set_rows(rows.data()).has_value());
  const GravityReference gravity{kG0_mps2, 0.0, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(5, 1e-5, 1e-6);
  const auto with_bias = [&](double bias_mps2) {
    BlockEvidence block = block_at(array, array.axis(4));
    block.mean_mps2[4] += bias_mps2;
    return block;
  };
  const double slope = test_set(array, gravity, limits, with_bias(1.0), array.all()).parity;
  Isolation isolation;
  int denied = 0;
  for (int k = 0; k < 160; ++k) {
    isolation.clear();
    isolation.pose(array, array.all());
    const BlockEvidence block = with_bias((4.0 + 0.01 * k) / slope);
    const BlockTests tests(array, gravity, limits, block);
    const SetTest& all = tests.of(array.all());
    ASSERT_LT(all.least_leverage, 0.002);
    denied += all.parity_alive(limits) && !tests.vouches_for_norm(array.all(), all) ? 1 : 0;
    const IsolationAnswer answer = isolation.vote(tests, array.all());
    EXPECT_TRUE(SensorSet::of(4).contains(answer.strict | answer.parity)) << k;
  }
  EXPECT_GT(denied, 0);
}

/// Means of one sample each: the one with the next tag ends the station before it, and is a block by itself.
TEST(StationEdge, OfBlocksOfOneSampleANewTagEndsTheStation) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  StationFinder::Settings settings;
  settings.block = 1;
  settings.min_blocks = 2;
  StationFinder finder(array, kG0_mps2, settings);
  Station finished;
  int found = 0;
  for (int k = 0; k < 12; ++k) {
    Sample sample;
    sample.time_s = 0.01 * k;
    sample.delivered = array.all();
    sample.station = static_cast<std::uint32_t>(1 + k / 6);
    sample.temperature_degc = 25.0;
    const BlockEvidence block = block_at(array, plumb_test::direction_at(40, k < 6 ? 20 : 120));
    sample.raw = block.mean_mps2;
    const bool written = finder.add(sample, block.mean_mps2, array.all(), finished);
    found += written ? 1 : 0;
    EXPECT_EQ(written, k == 6) << k;
  }
  EXPECT_EQ(found, 1);
  EXPECT_EQ(finished.tag, 1U);
}

}  // namespace
}  // namespace detection_damage_edges_test
