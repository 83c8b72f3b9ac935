// The judge of the attacks: what it counts where the truth is another than the monitor is shown, and who copies whom.
#include "player.hpp"
#include "plumb/detection/estimate_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "adversary.hpp"

namespace player_test {
namespace {

using namespace plumb;
using namespace plumb_bench;

/// A tool of six that is trusted and at rest.
Player trusted(MonitorConfig config = {}) {
  Player player(exact_named_tool(6), config, 3);
  player.settle();
  EXPECT_EQ(player.verdict().state, HealthState::nominal);
  player.direction = {0.6, 0.0, 0.8};
  player.block(2);
  EXPECT_EQ(player.verdict().validity, Validity::valid);
  player.attack();
  return player;
}

TEST(AttackPlayer, AHealthyToolIsValidAndNothingIsFound) {
  Player player = trusted();
  for (int k = 0; k < 10; ++k) {
    player.direction = player.noise.direction();
    player.block(2);
  }
  const Tally t = player.finish();
  EXPECT_EQ(t.unsafe(), 0U);
  EXPECT_EQ(t[Count::blocks], 20U);
  EXPECT_GE(t[Count::valid_blocks], 18U);
  EXPECT_EQ(t[Count::failed], 0U);
  EXPECT_EQ(t.to_nominal[kNominalBins - 1], 0U);
}

/// The world says one direction, the samples show another: wherever the vector is called valid it is wrong.
TEST(AttackPlayer, AVectorOfAnotherAttitudeIsStaleAndThenBeyondItsBound) {
  Player player = trusted();
  const Vec3 shown = player.direction;
  const Vec3 truth = {0.0, 0.6, 0.8};
  for (int k = 0; k < player.window(); ++k) {
    player.direction = shown;
    const Sample sample = player.next();
    player.direction = truth;
    player.offer(sample);
  }
  Tally t = player.finish();
  EXPECT_EQ(t[Count::stale], 1U);
  EXPECT_EQ(t[Count::beyond_level], 1U) << "its block is complete, and at another attitude";
  EXPECT_EQ(t[Count::hazardous], 1U);
}

TEST(AttackPlayer, ASmallErrorIsBeyondTheLevelAndNotHazardous) {
  Player player = trusted();
  const Vec3 shown = player.direction;
  for (int k = 0; k < 2 * player.window(); ++k) {
    player.direction = shown;
    const Sample sample = player.next();
    player.direction = {shown[0] * std::cos(0.005), shown[0] * std::sin(0.005), shown[2]};  // 0.17 deg
    player.offer(sample);
  }
  const Tally t = player.finish();
  EXPECT_EQ(t[Count::beyond_level], 1U);
  EXPECT_EQ(t[Count::hazardous], 0U);
}

TEST(AttackPlayer, AnExcludedSensorCountsAsWrongIfItIsHealthy) {
  for (const bool faulty : {false, true}) {
    Player player = trusted();
    player.shift_mps2[2] = 0.3 * kG0_mps2;
    if (faulty) player.faulty = SensorSet::of(2);
    for (int k = 0; k < 8; ++k) {
      player.direction = player.noise.direction();
      player.block(2);
    }
    EXPECT_EQ(player.verdict().excluded, SensorSet::of(2));
    const Tally t = player.finish();
    EXPECT_EQ(t[Count::wrong_exclusion], faulty ? 0U : 1U);
    EXPECT_EQ(t[Count::wrong_aside], faulty ? 0U : 1U);
    EXPECT_EQ(t[Count::false_doubt], faulty ? 0U : 1U);
    EXPECT_EQ(t[Count::faulty], faulty ? 1U : 0U);
    EXPECT_EQ(t[Count::all_out], faulty ? 1U : 0U);
    EXPECT_EQ(player.findings().empty(), faulty);
  }
}

/// More faults than the grade bears: counted, but as what nobody promised, unless all is asked for.
TEST(AttackPlayer, BeyondTheGradeNothingIsPromised) {
  for (const bool count_all : {false, true}) {
    Player player = trusted();
    player.count_all = count_all;
    player.faulty = SensorSet::first(5);
    const Vec3 shown = {-0.6 * kG0_mps2, 0.0, 0.8 * kG0_mps2};
    const SensorArray& array = player.tool().array();
    player.lie = [&array, shown](int i, double) { return dot(array.axis(i), shown); };
    player.block(4);  // five of six agree on it
    const Tally t = player.finish();
    EXPECT_EQ(t[Count::unpromised], count_all ? 0U : 1U);
    EXPECT_EQ(t.unsafe() > 0, count_all);
  }
}

TEST(AttackPlayer, ASnapshotTakenUpGoesOnTheSame) {
  Player player = trusted();
  player.power_cycle();
  player.block();
  EXPECT_EQ(player.verdict().validity, Validity::valid);
  EXPECT_EQ(player.finish()[Count::broken], 0U);
}

TEST(AttackAdversary, TriesItsFaultsOnCopiesOnly) {
  Player player = trusted();
  player.faulty = SensorSet::of(1);
  const std::uint32_t before = player.monitor().counters().samples;
  for (const Aim aim : {Aim::error, Aim::accuse, Aim::fail}) {
    Adversary adversary(player, aim, 17);
    for (int k = 0; k < 3; ++k) adversary.block();
  }
  EXPECT_EQ(player.monitor().counters().samples, before + 9U * static_cast<unsigned>(player.window()));
  EXPECT_EQ(player.finish()[Count::blocks], 9U);
}

/// It knows what it does: who wants doubt gets it, who wants error while valid is not found out.
TEST(AttackAdversary, GetsNearerToWhatItWants) {
  const auto blocks_in_doubt = [](Aim aim) {
    Player player = trusted();
    player.faulty = SensorSet::of(1);
    Adversary adversary(player, aim, 17);
    int doubt = 0;
    for (int k = 0; k < 12; ++k) {
      player.direction = player.noise.direction();
      adversary.block();
      doubt += player.verdict().state == HealthState::nominal ? 0 : 1;
    }
    return doubt;
  };
  EXPECT_EQ(blocks_in_doubt(Aim::error), 0);
  EXPECT_GE(blocks_in_doubt(Aim::fail), 8);
}

/// What a fit is off by, in the frame that its tool is judged in, is what its covariance says: to the first order alone
/// that frame was off by up to 0.014 deg, fourteen sigmas.
TEST(AttackPlayer, FittedToolsAreJudgedInTheFrameOfTheirCalibratedAxes) {
  plumb_test::TrialNoise noise(5);
  for (int n = 4; n <= 8; ++n) {
    for (const AttackTool& tool : pool(n)) {
      const plumb_test::TrialTool& t = tool.law.tool;
      BlockEvidence block;
      block.usable = t.array.all();
      block.samples = 1e9;
      for (int k = 0; k < 100; ++k) {
        const Vec3 u = noise.direction();
        for (int i = 0; i < n; ++i)
          block.mean_mps2[plumb_test::slot(i)] =
              dot(t.row[plumb_test::slot(i)], scaled(u, kG0_mps2)) + t.offset_mps2[plumb_test::slot(i)];
        const SetTest test = test_set(t.array, t.gravity, t.limits, block, t.array.all());
        const double sigma_rad = calibration_tilt_sigma_rad(t.array, test, t.array.all());
        EXPECT_LE(angle_between_rad(test.x_mps2, tool.seen(u)), 4.0 * sigma_rad + 1e-9) << n << " sensors";
      }
    }
  }
}

}  // namespace
}  // namespace player_test
