// Readings that leave open who is wrong: they accuse nobody, least of all somebody healthy.
#include <gtest/gtest.h>

#include "detection/still_block.hpp"
#include "support/simulated_tool.hpp"

namespace isolation_doubt_test {
namespace {

using namespace plumb;
using plumb_test::block_at;

constexpr double kSigma = 2e-4 * kG0_mps2;

/// One sensor is far off, another by a little more and more: those that agree in fours need not agree in fives, and
/// where they do not, nobody is provisionally excluded.
// Negative: REQ-070
TEST(IsolationDoubt, SensorsThatAgreeInPartsButNotTogetherSuspectNoSensor) {
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
    const SensorSet suspected = isolation.vote(tests, array.all()).parity;
    one += suspected == SensorSet::of(5) ? 1 : 0;
    two += suspected == SensorSet::of(5).with(0) ? 1 : 0;
    nobody += suspected.empty() ? 1 : 0;
  }
  EXPECT_GT(one, 0);
  EXPECT_GT(two, 0);
  EXPECT_GT(nobody, 0);
  EXPECT_EQ(one + two + nobody, 400);
}

/// A sensor so quiet that the others hardly check it, off by so much that they deny what it makes of the length, though
/// all agree within their limit: none of the healthy ones pays for it.
// Negative: REQ-070
TEST(IsolationDoubt, AWeaklyCheckedSensorIsolatesNoOther) {
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
    denied += all.parity_consistent(limits) && !tests.corroborates_norm(array.all(), all) ? 1 : 0;
    const IsolationAnswer answer = isolation.vote(tests, array.all());
    EXPECT_TRUE(SensorSet::of(4).contains(answer.strict | answer.parity)) << k;
  }
  EXPECT_GT(denied, 0);
}

}  // namespace
}  // namespace isolation_doubt_test
