// A tool that turns or shakes slowly has a vector, whose bound holds what it moves by until the next; nobody is
// suspected by such a block and nobody cleared.
#include "plumb/health/detail/slow_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "support/simulated_tool.hpp"

namespace slow_motion_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::Rig;

constexpr double kPeriod_s = 0.01;
constexpr std::uint16_t kClaims = Usable::vector | Usable::inclination | Usable::protection_level;

/// In the plane of the meridian at `toolface`, as it turns.
struct Turn {
  double inclination_deg = 30.0;
  Vec3 now() const { return direction_at(inclination_deg, 40.0); }
  Vec3 on(double rate_degps) {
    inclination_deg += rate_degps * kPeriod_s;
    return now();
  }
};

Rig trusted(int n, std::uint64_t seed) {
  Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), {}, seed);
  rig.prove();
  return rig;
}

/// A block of 32 samples that turns by `turn`: its vector is half of that from its last sample, and the end of the next
/// block as much again and once more.
// Verifies: REQ-068
TEST(SlowMotion, TheBoundReachesToTheEndOfTheNextBlock) {
  const double turn = rad_from_deg(0.1);
  SlowMotion motion;
  for (int k = 0; k < 5; ++k) {
    motion.add_swing(true, turn / std::sqrt(12.0) * kG0_mps2);
    motion.add_turn({std::sin(k * turn), 0.0, std::cos(k * turn)}, 1e-5, rad_from_deg(1.0));
    EXPECT_TRUE(motion.slow());
    EXPECT_GE(motion.bound_rad(kG0_mps2), 1.5 * turn);
    EXPECT_LE(motion.bound_rad(kG0_mps2), 2.0 * turn);
  }
}

// Verifies: REQ-068
TEST(SlowMotion, AtRestThereIsNoneAndBehindMotionItFades) {
  SlowMotion motion;
  for (int k = 0; k < 5; ++k) {
    motion.add_swing(false, 1e-3);
    motion.add_turn({0.0, 0.001 * k, 1.0}, 1e-2, 0.1);
    EXPECT_EQ(motion.bound_rad(kG0_mps2), 0.0);
    EXPECT_FALSE(motion.lately());
  }
  motion.add_swing(true, 1e-2);
  motion.add_turn({0.0, 0.004, 1.0}, 1e-2, 0.1);
  double before = motion.bound_rad(kG0_mps2);
  int blocks = 0;
  for (; motion.lately(); ++blocks) {
    ASSERT_LT(blocks, 100);
    motion.add_swing(false, 0.0);
    motion.add_turn({0.0, 0.004, 1.0}, 1e-2, 0.1);
    EXPECT_LT(motion.bound_rad(kG0_mps2), before);
    EXPECT_FALSE(motion.slow());
    before = motion.bound_rad(kG0_mps2);
  }
  EXPECT_EQ(before, 0.0);
  EXPECT_GE(blocks, 5) << "a sway of 1 Hz rests at its turning points";
}

/// A vector far from the one before is another attitude, and behind a gap nothing is known of a turn.
// Verifies: REQ-068
TEST(SlowMotion, AnotherAttitudeIsNoRate) {
  for (const bool gap : {true, false}) {
    SlowMotion motion;
    motion.add_swing(true, 1e-3);
    motion.add_turn({0.0, 0.0, 1.0}, 1e-2, 0.02);
    const double before = motion.bound_rad(kG0_mps2);
    if (gap) motion.lapse();
    motion.add_swing(true, 1e-3);
    motion.add_turn(gap ? Vec3{0.0, 0.01, 1.0} : Vec3{0.0, 1.0, 1.0}, 1e-2, 0.02);
    EXPECT_EQ(motion.bound_rad(kG0_mps2), before);
  }
}

/// Behind motion no vector before tells whether the tool still turns: what the noise of one block may hide is allowed
/// for.
// Verifies: REQ-068
// Negative: REQ-068
TEST(SlowMotion, TheFirstBlockBehindMotionAllowsForTheTurnThatItsNoiseHides) {
  for (const int n : {4, 5, 6, 8}) {
    int judged = 0;
    for (int seed = 1; seed <= 40; ++seed) {
      Rig rig = trusted(n, static_cast<std::uint64_t>(seed));
      Turn turn;
      rig.stay(turn.now(), 3);
      // 3 deg a block, until somewhere within a block, then 0.07 deg a block.
      for (int k = 0; k < 96 + seed % 32; ++k) rig.step(rig.sample(turn.on(9.4), kG0_mps2));
      for (int k = 0; k < 160; ++k) {
        const Vec3 here = turn.on(0.22);
        const Verdict& v = rig.step(rig.sample(here, kG0_mps2));
        // The block in which it slowed down, and the one before, hold more.
        if (k < 64 || v.validity != Validity::valid || v.alert) continue;
        ++judged;
        ASSERT_LE(angle_between_rad(v.gravity_mps2, here), v.protection_level_calibrated_axes_rad) << n << " " << seed;
      }
    }
    EXPECT_GE(judged, 40 * 64) << n;
  }
}

/// What was learned as noise, beside a tool that swayed, may have been the sway: it is not taken off when the tool
/// moves.
// Verifies: REQ-068
// Negative: REQ-068
TEST(SlowMotion, LearnedNoiseHidesNoMovement) {
  int judged = 0;
  for (int seed = 1; seed <= 40; ++seed) {
    Rig rig = trusted(8, static_cast<std::uint64_t>(seed));
    const double sigma_mps2 = rig.setup.array.sigma_mps2(0);
    const int liar = seed % 8;
    Noise own(static_cast<std::uint64_t>(seed) + 5);
    bool scatters = true;
    rig.distort = [&](int i, double y, int) { return i == liar && scatters ? y + 6.0 * sigma_mps2 * own.normal() : y; };
    Turn turn;
    const double rms_deg = deg_from_rad(2.0 * sigma_mps2 / kG0_mps2);
    for (int k = 0; k < 64 * 32; ++k) {
      const double phase_rad = 2.0 * kPi * k / 16.0;
      const Vec3 here = direction_at(turn.inclination_deg + rms_deg * std::sqrt(2.0) * std::sin(phase_rad),
                                     40.0 + 2.0 * rms_deg * std::sqrt(2.0) * std::cos(phase_rad));
      rig.step(rig.sample(here, kG0_mps2));
    }
    EXPECT_GT(rig.monitor.verdict().noise_factor, 1.2);
    scatters = false;
    rig.stay(turn.now(), 2);
    for (int k = 0; k < 12 * 32; ++k) {
      const Vec3 here = turn.on(0.11);
      const Verdict& v = rig.step(rig.sample(here, kG0_mps2));
      if (k < 96 || v.validity != Validity::valid || v.alert) continue;
      ++judged;
      ASSERT_LE(angle_between_rad(v.gravity_mps2, here), v.protection_level_calibrated_axes_rad) << seed << " " << k;
    }
  }
  EXPECT_GE(judged, 40 * 200);
}

// Verifies: REQ-068
TEST(SlowMotion, ATurningToolIsValidWithinItsLevelAtEverySample) {
  for (const int n : {4, 6, 8}) {
    for (const double rate_degps : {0.1, 0.3, 1.0}) {
      Rig rig = trusted(n, 3);
      Turn turn;
      rig.stay(turn.now(), 3);
      int valid = 0, all = 0;
      for (int k = 0; k < 100 * rig.setup.config.window; ++k) {
        const Vec3 here = turn.on(rate_degps);
        const Verdict& v = rig.step(rig.sample(here, kG0_mps2));
        if (k < 3 * rig.setup.config.window) continue;
        ++all;
        EXPECT_EQ(v.qualifiers & Qualifier::moving, 0);
        if (v.validity != Validity::valid) continue;
        ++valid;
        ASSERT_TRUE(v.protection_available);
        ASSERT_LE(angle_between_rad(v.gravity_mps2, here), v.protection_level_calibrated_axes_rad)
            << n << " " << rate_degps;
      }
      EXPECT_GE(100 * valid, 98 * all) << n << " " << rate_degps;
      EXPECT_TRUE(rig.ever_blamed.empty()) << n;
      const Verdict& v = rig.monitor.verdict();
      EXPECT_FALSE(v.alert) << n << " " << rate_degps;
      if (rate_degps >= 0.3) {
        EXPECT_EQ(v.usable & Usable::stationary, 0) << "it turns";
      }
      EXPECT_EQ(v.usable & kClaims, kClaims);
    }
  }
}

/// Where the bound of the motion is beyond the alert limit, the tool moves, as any other that does.
// Negative: REQ-068
TEST(SlowMotion, BeyondTheAlertLimitTheToolMoves) {
  for (const double rate_degps : {3.0, 10.0}) {
    Rig rig = trusted(6, 5);
    Turn turn;
    rig.stay(turn.now(), 3);
    for (int k = 0; k < 20 * rig.setup.config.window; ++k) {
      const Verdict& v = rig.step(rig.sample(turn.on(rate_degps), kG0_mps2));
      if (k < 2 * rig.setup.config.window) continue;
      EXPECT_EQ(v.validity, Validity::held);
      EXPECT_TRUE(v.alert);
      EXPECT_NE(v.qualifiers & Qualifier::moving, 0);
    }
  }
}

// Verifies: REQ-068
TEST(SlowMotion, AShakenToolIsValid) {
  for (const int n : {4, 6, 8}) {
    Rig rig = trusted(n, 7);
    int valid = 0;
    for (int k = 0; k < 200; ++k) {
      const Vec3 u = direction_at(20 + k / 10, 3 * (k / 10));
      const Verdict& v = rig.shake(u, 2.0 * rig.setup.array.sigma_mps2(0));
      if (v.validity != Validity::valid) continue;
      ++valid;
      EXPECT_LE(angle_between_rad(v.gravity_mps2, u), v.protection_level_calibrated_axes_rad);
    }
    EXPECT_GE(valid, 190) << n;
    EXPECT_TRUE(rig.ever_blamed.empty()) << n;
  }
}

/// A tool that turns for the first time after power-on earns no trust by it, though block after block agrees.
// Negative: REQ-068
TEST(SlowMotion, NoSensorIsValidatedInMotion) {
  Rig rig(plumb_test::cone_array(6), {}, 9);
  Turn turn;
  for (int k = 0; k < 300 * rig.setup.config.window; ++k) rig.step(rig.sample(turn.on(0.5), kG0_mps2));
  EXPECT_GT(turn.inclination_deg, 70.0);
  EXPECT_NE(rig.monitor.verdict().qualifiers & Qualifier::not_yet_validated, 0);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect);
}

/// A liar is doubted at once, and named when the tool rests: in motion nobody is excluded, for good or for a while.
// Verifies: REQ-068
// Negative: REQ-068
TEST(SlowMotion, AFaultySensorIsSuspectedInMotionAndIsolatedAtRest) {
  for (const int n : {4, 6, 8}) {
    Rig rig = trusted(n, 11);
    Turn turn;
    rig.stay(turn.now(), 2);
    for (int k = 0; k < 8 * rig.setup.config.window; ++k) rig.step(rig.sample(turn.on(0.5), kG0_mps2));
    ASSERT_EQ(rig.monitor.verdict().validity, Validity::valid);
    rig.distort = [](int i, double r, int) { return i == 1 ? r + 0.5 : r; };
    for (int k = 0; k < 100 * rig.setup.config.window; ++k) {
      const Verdict& v = rig.step(rig.sample(turn.on(0.5), kG0_mps2));
      if (k >= rig.setup.config.window) {
        EXPECT_NE(v.validity, Validity::valid);
      }
    }
    EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect) << n;
    EXPECT_TRUE(rig.ever_blamed.empty()) << n;
    Noise noise(13);
    for (int k = 0; k < 10; ++k) rig.stay(plumb_test::random_direction(noise));
    EXPECT_EQ(rig.ever_blamed, SensorSet::of(1)) << n;
  }
}

/// A tool that turned slowly and now turns fast: the readings show it before the block does.
// Verifies: REQ-068
TEST(SlowMotion, ATurnThatGrowsIsHeldAtItsFirstLargeReading) {
  Rig rig = trusted(6, 15);
  Turn turn;
  rig.stay(turn.now(), 2);
  for (int k = 0; k < 10 * rig.setup.config.window; ++k) rig.step(rig.sample(turn.on(0.3), kG0_mps2));
  ASSERT_EQ(rig.monitor.verdict().validity, Validity::valid);
  ASSERT_TRUE(rig.monitor.verdict().tick);
  for (int k = 0; k < 31; ++k) {
    const Vec3 here = turn.on(30.0);
    const Verdict& v = rig.step(rig.sample(here, kG0_mps2));
    const double hidden_rad = 13.0 * rig.setup.array.sigma_mps2(0) * std::sqrt(2.0) / kG0_mps2;
    if (v.validity == Validity::valid) {
      EXPECT_LE(angle_between_rad(v.gravity_mps2, here), v.protection_level_calibrated_axes_rad + hidden_rad);
    }
  }
  EXPECT_EQ(rig.monitor.verdict().validity, Validity::held);
}

/// The bound reaches to the end of the next block and no farther: rows that lack a sensor put that off.
// Negative: REQ-068
TEST(SlowMotion, ARowThatIsMissingEndsTheClaimWithTheBlock) {
  Rig rig = trusted(6, 17);
  Turn turn;
  rig.stay(turn.now(), 2);
  const int window = rig.setup.config.window;
  for (int k = 0; k < 10 * window; ++k) rig.step(rig.sample(turn.on(0.3), kG0_mps2));
  ASSERT_EQ(rig.monitor.verdict().validity, Validity::valid);
  for (int k = 0; k < window; ++k) {
    Sample s = rig.sample(turn.on(0.3), kG0_mps2);
    if (k == 5 || k == 9) s.delivered = s.delivered.without(2);
    rig.step(s);
  }
  for (int k = 0; k < 1; ++k) {
    EXPECT_EQ(rig.step(rig.sample(turn.on(0.3), kG0_mps2)).validity, Validity::held);
  }
  EXPECT_EQ(rig.step(rig.sample(turn.on(0.3), kG0_mps2)).validity, Validity::valid) << "the next block is complete";
}

/// Whether the channels move as one, or one by itself.
// Negative: REQ-068
TEST(SlowMotion, AChannelThatMovesByItselfIsNoMotionOfTheTool) {
  const double factor = scatter_factor(6, 32, 1e-6);
  for (const bool alone : {false, true}) {
    for (const int sensors : {6, 3}) {
      const SensorArray array = plumb_test::cone_array(6);
      Noise noise(19);
      BlockAccumulator block;
      for (int k = 0; k < 32; ++k) {
        const Vec3 x = scaled(direction_at(30 + 0.02 * k, 40), kG0_mps2);
        Readings y{};
        for (int i = 0; i < 6; ++i)
          y[static_cast<std::size_t>(i)] = dot(array.axis(i), x) + array.sigma_mps2(i) * noise.normal();
        if (alone) y[1] += 0.02 * array.sigma_mps2(1) * k * k;
        block.add(y, array.all(), 1.0);
      }
      const SensorSet used = SensorSet::first(sensors);
      const BlockNoise expected = noise_of(array);
      BlockJudgement judged = judge_block(array, block, used, factor, kG0_mps2);
      ASSERT_FALSE(judged.quiet);
      EXPECT_EQ(moves_together(array, block, used, factor, kG0_mps2, expected, judged), !alone && sensors > 3);
    }
  }
}

/// The turn quickens, and one sensor pulls the vector back to where it would have been: the others show it, row by row.
// Negative: REQ-068
TEST(SlowMotion, AFaultySensorThatPullsTheVectorBackIsNotFollowed) {
  for (int n = 4; n <= kCapacity; ++n) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      Rig rig = trusted(n, seed);
      const LeastSquares map = least_squares(rig.setup.array, rig.setup.array.all());
      Turn truth, shown;
      rig.stay(truth.now(), 2);
      double pull_mps2 = 0.0;
      rig.distort = [&pull_mps2](int i, double r, int) { return i == 1 ? r + pull_mps2 : r; };
      for (int k = 0; k < 32 * 12; ++k) {
        truth.on(k < 32 * 6 ? 0.94 : 3.75);
        shown.on(0.94);
        const Vec3& column = map.column[1];
        const Vec3 back = scaled(minus(shown.now(), truth.now()), kG0_mps2);
        pull_mps2 = dot(column, back) / dot(column, column);
        const Verdict& v = rig.step(rig.sample(truth.now(), kG0_mps2));
        if (v.alert) continue;
        // What six sigmas of one row hide of it, of four sensors the most.
        EXPECT_LE(angle_between_rad(v.gravity_mps2, truth.now()),
                  v.protection_level_calibrated_axes_rad + rad_from_deg(0.25))
            << n;
        EXPECT_LE(angle_between_rad(v.gravity_mps2, truth.now()), rig.setup.config.alert_limit_rad) << n;
      }
    }
  }
}

}  // namespace
}  // namespace slow_motion_test
