// What is an attitude of its own, and what a station that a fault visits and leaves says.
#include <gtest/gtest.h>

#include <cmath>

#include "support/simulated_tool.hpp"

namespace stations_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::random_direction;
using plumb_test::Rig;

SensorArray tool_of(int n) { return n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n); }

/// A tool at rest upright whose fourth sensor reads -G/3: the least-squares vector is next to nothing, and its
/// direction noise.
// Negative: REQ-079
TEST(Stations, AVectorNearZeroHasNoDirection) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  Vec3 upright{};
  for (int i = 0; i < 3; ++i) upright = plus(upright, rig.setup.array.axis(i));
  upright = scaled(upright, 1.0 / norm(upright));
  // What the fourth must read for the estimate to vanish.
  const LeastSquares map = least_squares(rig.setup.array, rig.setup.array.all());
  Vec3 of_three{};
  for (int i = 0; i < 3; ++i) {
    const auto a = static_cast<std::size_t>(i);
    of_three = plus(of_three, scaled(map.column[a], kG0_mps2 * dot(rig.setup.array.axis(i), upright)));
  }
  const double lie = -dot(of_three, map.column[3]) / dot(map.column[3], map.column[3]);
  ASSERT_LT(norm(plus(of_three, scaled(map.column[3], lie))), 1e-9);
  Noise noise(5);
  rig.distort = [&](int i, double r, int) { return i == 3 ? lie + rig.setup.array.sigma_mps2(3) * noise.normal() : r; };
  for (int block = 0; block < 60; ++block) {
    const Verdict& v = rig.stay(upright);
    ASSERT_LE(v.stations_on_record, 1) << block;
    ASSERT_NE(v.state, HealthState::failed) << block;
  }
}

/// One sensor of a tool at rest steps in the middle of every second block: whatever that makes of the direction, the
/// tool has one attitude.
// Negative: REQ-079
TEST(Stations, StepsAtOneAttitudeAreNoAttitudes) {
  for (int n = 4; n <= kCapacity && n <= 8; ++n) {
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      Rig rig(tool_of(n), {}, seed);
      rig.prove();
      Noise luck(seed);
      double step = 0.0;
      int row = 0;
      rig.distort = [&](int i, double r, int) { return i == 1 && row % 64 >= 16 && row % 64 < 32 ? r + step : r; };
      const Vec3 u = random_direction(luck);
      for (int block = 0; block < 40; ++block) {
        step = (luck.uniform() < 0.5 ? -1.0 : 1.0) * (0.3 + 2.7 * luck.uniform()) * kG0_mps2;
        for (int k = 0; k < rig.setup.config.window; ++k, ++row) rig.step(rig.sample(u, kG0_mps2));
        ASSERT_LE(rig.monitor.verdict().stations_on_record, 1) << n << ": " << seed << ": " << block;
      }
      EXPECT_NE(rig.monitor.verdict().state, HealthState::failed) << n << ": " << seed;
      EXPECT_TRUE(SensorSet::of(1).contains(rig.ever_blamed)) << n << ": " << seed;
    }
  }
}

/// Attitudes that do differ are counted as before.
// Verifies: REQ-079
TEST(Stations, AttitudesThatDifferAreCounted) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i < 2 ? r + 0.4 * (i + 1) : r; };
  int most = 0;
  for (int k = 0; k < 5; ++k) {
    const Verdict& v = rig.stay(direction_at(20.0 + 15.0 * k, 100.0 * k));
    if (v.state == HealthState::suspect) most = v.stations_on_record;
  }
  EXPECT_GE(most, 3);
}

/// Off in the second half of each station's first block and honest in the next: settling after a turn, and always the
/// same sensor.
struct Settling {
  int excluded = 0, failed = 0, wrong = 0;
  void play(int n, std::uint64_t seed, int bad_block, int blocks, int stations) {
    Rig rig(tool_of(n), {}, seed);
    rig.prove();
    Noise luck(seed);
    const int liar = static_cast<int>(n * luck.uniform());
    const double off = std::pow(10.0, -1.3 + 1.3 * luck.uniform()) * kG0_mps2;
    bool lies = false;
    rig.distort = [&](int i, double r, int) { return lies && i == liar ? r + off : r; };
    for (int station = 0; station < stations; ++station) {
      const Vec3 u = random_direction(luck);
      for (int block = 0; block < blocks; ++block) {
        for (int k = 0; k < rig.setup.config.window; ++k) {
          lies = block == bad_block && 2 * k >= rig.setup.config.window;
          rig.step(rig.sample(u, kG0_mps2));
        }
      }
    }
    const Verdict& v = rig.monitor.verdict();
    excluded += (v.excluded | v.provisionally_excluded) == SensorSet::of(liar) ? 1 : 0;
    failed += v.state == HealthState::failed ? 1 : 0;
    wrong += SensorSet::of(liar).contains(rig.ever_blamed) ? 0 : 1;
  }
};

// Verifies: REQ-079
// Negative: REQ-076
TEST(Stations, TheOnlyExplanationOfFourStationsIsExcludedWhicheverBlockSaidSo) {
  for (const int n : {4, 5, 6, 8}) {
    if (n > kCapacity) continue;
    for (const int bad_block : {0, 1}) {
      Settling result;
      for (std::uint64_t seed = 1; seed <= 25; ++seed) result.play(n, seed, bad_block, 2, 12);
      EXPECT_EQ(result.excluded, 25) << n << ", block " << bad_block;
      EXPECT_EQ(result.failed, 0) << n;
      EXPECT_EQ(result.wrong, 0) << n;
    }
  }
}

/// All settle, each in its own way: at worst it is doubt, and where the tool rests that ends.
// Negative: REQ-079
TEST(Stations, ATransientThatEndsIsAtWorstSuspect) {
  for (const int n : {4, 5, 6, 8}) {
    if (n > kCapacity) continue;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      Rig rig(tool_of(n), {}, seed);
      rig.prove();
      Noise luck(seed);
      double fraction = 0.0;
      rig.distort = [&](int i, double r, int) { return r + fraction * 0.02 * (1 + i * i % 5) * kG0_mps2; };
      for (int station = 0; station < 20; ++station) {
        const Vec3 u = random_direction(luck);
        for (int k = 0; k < 5 * rig.setup.config.window; ++k) {
          fraction = std::exp(-k / 8.0);
          rig.step(rig.sample(u, kG0_mps2));
        }
        ASSERT_NE(rig.monitor.verdict().state, HealthState::failed) << n << ": " << seed << ": " << station;
      }
      EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal) << n << ": " << seed;
      EXPECT_TRUE(rig.ever_blamed.empty()) << n << ": " << seed;
    }
  }
}

}  // namespace
}  // namespace stations_test
