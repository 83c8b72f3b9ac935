// An isolation whose storage memory has damaged, byte by byte: what holds as long as nobody has compared it yet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "detection/still_block.hpp"
#include "support/simulated_tool.hpp"

namespace isolation_damage_test {
namespace {

using namespace plumb;
using plumb_test::block_at;

constexpr double kSigma = 2e-4 * kG0_mps2;

/// Every byte of what it remembers set to zero in turn: it answers, excludes nobody of a sound block, and counts no
/// more sets than there are.
// Negative: REQ-166
TEST(IsolationDamage, WithAnyByteLostASoundBlockIsolatesNoSensor) {
  const SensorArray array = plumb_test::cone_array(6, kSigma);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  const BlockEvidence block = block_at(array, plumb_test::direction_at(40, 70));
  const BlockTests tests(array, gravity, limits, block);
  Isolation sound;
  sound.pose(array, array.all());
  ASSERT_GE(sound.confirmed_grade(), 1);
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

/// Two sensors of six are wrong. Whichever byte memory has lowered to one: no answer excludes more sensors than the
/// grade that is stated with it, though more were isolated before.
// Negative: REQ-166
TEST(IsolationDamage, WithAnyByteLoweredNoMoreAreIsolatedThanTheGradeSays) {
  const SensorArray array = plumb_test::cone_array(6, kSigma);
  const GravityReference gravity{kG0_mps2, 1e-4, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(6, 1e-5, 1e-6);
  std::vector<BlockEvidence> blocks;
  for (int k = 0; k < 4; ++k) {
    blocks.push_back(block_at(array, plumb_test::direction_at(20 + 20 * k, 70 * k)));
    blocks.back().mean_mps2[1] += 0.5;
    blocks.back().mean_mps2[4] -= 0.7;
  }
  const auto most_isolated = [&](Isolation& isolation) {
    int most = 0;
    for (const BlockEvidence& block : blocks) {
      const BlockTests tests(array, gravity, limits, block);
      most = std::max(most, isolation.vote(tests, array.all()).strict.size());
    }
    return most;
  };
  Isolation sound;
  sound.pose(array, array.all());
  Isolation unhurt = sound;
  ASSERT_EQ(most_isolated(unhurt), 2);
  int lowered = 0;
  for (std::size_t byte = 0; byte < sizeof(Isolation); ++byte) {
    Isolation damaged = sound;
    unsigned char* const at = reinterpret_cast<unsigned char*>(&damaged) + byte;
    if (*at <= 1) continue;
    *at = 1;
    lowered += damaged.confirmed_grade() < sound.confirmed_grade() ? 1 : 0;
    const int grade = damaged.confirmed_grade();
    EXPECT_LE(most_isolated(damaged), grade) << byte;
  }
  EXPECT_GT(lowered, 0);
}

}  // namespace
}  // namespace isolation_damage_test
