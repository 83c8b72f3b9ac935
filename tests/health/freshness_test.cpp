// What is called valid is a claim about the sample at hand: data keep arriving, all in service deliver, and the newest
// readings are those of the block behind the vector.
#include "plumb/health/detail/freshness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>

#include "snapshot_support.hpp"

namespace freshness_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;

constexpr std::uint16_t kClaims =
    Usable::vector | Usable::inclination | Usable::toolface | Usable::stationary | Usable::protection_level;

/// Nothing that a host could steer by.
bool claims_nothing(const Verdict& v) {
  return v.validity != Validity::valid && v.validity != Validity::degraded && v.alert && !v.protection_available &&
         (v.usable & kClaims) == 0;
}

/// The same tool, sampled every `period_s`, trusted, at `direction_at(60, 40)`, a block just ended.
class Slow {
 public:
  explicit Slow(double period_s, MonitorConfig config = {})
      : rig(plumb_test::tetrahedron(), config), period_(period_s) {
    for (int round = 0; round < 5 && rig.monitor.verdict().state != HealthState::nominal; ++round) {
      for (const Vec3& u : {direction_at(20, 10), direction_at(80, 130), direction_at(60, 250), direction_at(60, 40)})
        stay(u, rig.setup.config.window);
    }
    EXPECT_EQ(rig.monitor.verdict().validity, Validity::valid);
    EXPECT_TRUE(rig.monitor.verdict().tick);
  }
  Sample sample(const Vec3& u) {
    Sample s = rig.sample(u, kG0_mps2);
    s.time_s = time_s += period_;
    return s;
  }
  const Verdict& stay(const Vec3& u, int samples) {
    for (int k = 0; k < samples; ++k) rig.step(sample(u));
    return rig.monitor.verdict();
  }

  Rig rig;
  double time_s = 0.0;

 private:
  double period_;
};

const Vec3 kHere = direction_at(60, 40);

/// 59 s of a bus that delivers nothing, or nothing but what is no number, while the tool turns.
// Verifies: REQ-128
// Negative: REQ-128
TEST(Freshness, WithoutDataNothingIsClaimed) {
  for (const bool silent : {true, false}) {
    Slow tool(0.01);
    for (int k = 0; k < 5900; ++k) {
      Sample s = tool.sample(direction_at(60 + k, 40));
      if (silent) s.delivered = SensorSet{};
      for (double& raw : s.raw) raw = std::numeric_limits<double>::quiet_NaN();
      const Verdict& v = tool.rig.step(s);
      if (k + 1 >= tool.rig.setup.config.missing_confirm) {
        ASSERT_TRUE(claims_nothing(v)) << k;
      }
    }
    EXPECT_EQ(tool.rig.monitor.verdict().state, HealthState::nominal) << "a silent bus is nobody's fault";
    tool.stay(kHere, tool.rig.setup.config.window);
    EXPECT_EQ(tool.rig.monitor.verdict().validity, Validity::valid) << "as soon as a block is complete again";
  }
}

// Negative: REQ-128
TEST(Freshness, BehindAGapNothingIsClaimedBeforeABlockIsComplete) {
  Slow tool(0.01);
  tool.time_s += 55.0;
  for (int k = 0; k < 31; ++k) EXPECT_TRUE(claims_nothing(tool.rig.step(tool.sample(direction_at(150, 40))))) << k;
  EXPECT_FALSE(claims_nothing(tool.rig.step(tool.sample(direction_at(150, 40)))));
  for (int k = 0; k < 100; ++k) {
    tool.time_s += 5.1;
    EXPECT_TRUE(claims_nothing(tool.rig.step(tool.sample(direction_at(60 + k, 40))))) << k;
  }
}

/// Whatever the rate, the first sample of another attitude ends it: the block would take 32 of them.
// Verifies: REQ-128
TEST(Freshness, ATurnIsSeenAtItsFirstSample) {
  for (const double period_s : {0.01, 0.1, 1.0}) {
    for (const double turn_deg : {90.0, 5.0, 0.5}) {
      Slow tool(period_s);
      EXPECT_EQ(tool.stay(kHere, 1).validity, Validity::valid);
      const Verdict& v = tool.rig.step(tool.sample(direction_at(60 + turn_deg, 40)));
      EXPECT_TRUE(claims_nothing(v)) << period_s << ": " << turn_deg;
      EXPECT_EQ(v.validity, Validity::held);
      EXPECT_EQ(tool.stay(kHere, 1).validity, Validity::valid) << "it was a knock";
    }
  }
}

/// At any rate a tool at rest stays valid from block to block.
// Verifies: REQ-128
TEST(Freshness, AtRestASlowLogStaysValid) {
  for (const double period_s : {0.001, 0.01, 0.1, 1.0, 4.0}) {
    Slow tool(period_s);
    for (int k = 0; k < 320; ++k) EXPECT_EQ(tool.stay(kHere, 1).validity, Validity::valid) << period_s << ": " << k;
  }
}

// Verifies: REQ-128
TEST(Freshness, OneRowWithoutOneChannelIsBorneAndSeveralAreNot) {
  for (int run = 1; run <= 5; ++run) {
    Slow tool(0.01);
    for (int k = 1; k <= run; ++k) {
      Sample s = tool.sample(kHere);
      s.delivered = s.delivered.without(1);
      // Lost in the third row, and then out of service.
      EXPECT_EQ(tool.rig.step(s).validity == Validity::valid, k < 3) << run << ": " << k;
    }
    EXPECT_EQ(tool.stay(kHere, 1).validity == Validity::valid, run < 3) << run;
  }
  Slow alternating(0.01);
  for (int k = 0; k < 20; ++k) {
    Sample s = alternating.sample(kHere);
    s.delivered = s.delivered.without(k % 4);
    EXPECT_EQ(alternating.rig.step(s).validity == Validity::valid, k < 2) << "no row has all of them: " << k;
  }
}

/// A block holds the turn before it, and its readings may depart by what some sensor feels of such a turn. Where that
/// sensor is silent, the others may feel less of a turn that is larger: they are held to their noise alone.
// Negative: REQ-128
TEST(Freshness, ATurnThatTheSilentSensorAloneWouldShowIsNotHidden) {
  for (int silent = 0; silent < 4; ++silent) {
    MonitorConfig config;
    config.alert_limit_rad = rad_from_deg(3.0);  // the turn before is in the bound
    Slow tool(0.01, config);
    const Vec3 h = tool.rig.setup.array.axis(silent);
    const Vec3 side = cross(h, std::fabs(h[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
    const auto tilted = [&h, &side](double deg) {
      const double angle = rad_from_deg(deg);
      return plus(scaled(side, std::cos(angle) / norm(side)), scaled(h, std::sin(angle)));
    };
    tool.stay(tilted(-1.0), 2 * tool.rig.setup.config.window);
    ASSERT_EQ(tool.stay(tilted(0.0), tool.rig.setup.config.window).validity, Validity::valid) << silent;
    Sample s = tool.sample(tilted(1.5));
    s.delivered = s.delivered.without(silent);
    EXPECT_EQ(tool.rig.step(s).validity, Validity::held) << silent;
  }
}

/// The block in which a turn begins scatters by it. Beside a sensor that hangs that may pass for noise of the sensors,
/// but the rows behind it are held to the noise that was known before.
// Verifies: REQ-128
// Negative: REQ-128
TEST(Freshness, ATurnThatBeginsIsNoNoiseOfTheRows) {
  double worst_deg = 0.0;
  for (int seed = 1; seed <= 40; ++seed) {
    Rig rig(plumb_test::tetrahedron(2e-4 * kG0_mps2), {}, static_cast<std::uint64_t>(seed));
    rig.prove();
    const int hangs = seed % 4;
    const Vec3 axis = rig.setup.array.axis(hangs);
    const Vec3 level = cross(axis, direction_at(70.0, 9.0 * seed));
    const Vec3 start = scaled(level, 1.0 / norm(level));  // the sensor feels nothing there, and the turn most
    bool hung = false;
    rig.distort = [&](int i, double y, int) { return i == hangs && hung ? 0.0 : y; };
    rig.stay(start, 3);
    for (int k = 0; k < seed % 32; ++k) rig.step(rig.sample(start, kG0_mps2));
    hung = true;
    for (int k = 1; k <= 2 * rig.setup.config.window; ++k) {
      const double angle_rad = rad_from_deg(0.3) / 32.0 * k;
      const Vec3 here = plus(scaled(start, std::cos(angle_rad)), scaled(axis, std::sin(angle_rad)));
      const Verdict& v = rig.step(rig.sample(here, kG0_mps2));
      if (v.validity != Validity::valid || v.alert) continue;
      worst_deg = std::fmax(worst_deg, deg_from_rad(angle_between_rad(v.gravity_mps2, here)));
    }
  }
  std::printf("[ measured ] valid beside a sensor that hangs as a turn of 0.3 deg a block begins: up to %.3f deg off\n",
              worst_deg);
  EXPECT_GT(worst_deg, 0.0);
  EXPECT_LE(worst_deg, 0.35);
}

/// Of a row with too few channels to tell a direction from, nothing is claimed: those that are there may not feel it.
// Verifies: REQ-128
// Negative: REQ-128
TEST(Freshness, ARowThatShowsNoDirectionIsNoSampleToClaimAnythingOf) {
  for (std::uint32_t there = 0; there < 16; ++there) {
    const SensorSet delivered(there);
    Slow tool(0.01);
    Sample s = tool.sample(kHere);
    s.delivered = delivered;
    EXPECT_EQ(tool.rig.step(s).validity, delivered.size() >= 3 ? Validity::valid : Validity::held) << there;
    EXPECT_EQ(tool.stay(kHere, 1).validity, Validity::valid) << there;
  }
}

// Verifies: REQ-128
TEST(Freshness, AgeLimitsAreTheHosts) {
  MonitorConfig config;
  config.max_age_s = 0.105;
  Slow in_seconds(0.01, config);
  for (int k = 1; k < 31; ++k) EXPECT_EQ(in_seconds.stay(kHere, 1).validity == Validity::valid, k <= 10) << k;
  config = MonitorConfig{};
  config.max_age_samples = 5;
  Slow in_samples(0.01, config);
  for (int k = 1; k < 31; ++k) EXPECT_EQ(in_samples.stay(kHere, 1).validity == Validity::valid, k <= 5) << k;
}

/// Two in three rows bring nothing, never three in a row: the block does not fill, and its age in samples ends it.
// Negative: REQ-128
TEST(Freshness, AStutteringBusDoesNotKeepAnOldVectorValid) {
  MonitorConfig config;
  config.max_age_s = 1e9;
  Slow tool(0.01, config);
  for (int k = 0; k < 300; ++k) {
    Sample s = tool.sample(kHere);
    if (k % 3 != 0) s.delivered = SensorSet{};
    EXPECT_EQ(claims_nothing(tool.rig.step(s)), k % 3 != 0 || k >= 2 * config.window) << k;
  }
}

/// A sample that is refused takes back what was claimed, and the monitor's own snapshot of then is its own.
// Verifies: REQ-128
TEST(Freshness, ARefusedSampleTakesBackWhatWasClaimed) {
  Slow tool(0.01);
  const Sample twice = tool.sample(kHere);
  EXPECT_EQ(tool.rig.step(twice).validity, Validity::valid);
  EXPECT_TRUE(claims_nothing(tool.rig.step(twice)));
  Sample silent = twice;
  silent.delivered = SensorSet{};
  silent.time_s += 70.0;
  tool.rig.step(silent);
  const plumb_test::Bytes bytes = plumb_test::snapshot_of(tool.rig.monitor);
  const auto next = std::make_unique<HealthMonitor>();
  EXPECT_TRUE(next->restore(tool.rig.setup, bytes.data(), bytes.size()).has_value());
  EXPECT_TRUE(claims_nothing(next->verdict()));
}

/// Cleared storage that a host takes for a verdict.
// Negative: REQ-128
TEST(Freshness, AVerdictOfZerosIsInvalid) {
  Verdict cleared;
  std::memset(static_cast<void*>(&cleared), 0, sizeof cleared);
  EXPECT_EQ(cleared.validity, Validity::invalid);
  EXPECT_EQ(cleared.usable, 0U);
}

/// kDepartureSigmas: 1e-5 per block at most, and so no more than 0.1 such blocks in 1e4 on average.
// Verifies: REQ-128
TEST(Freshness, NoiseAloneHardlyEverEndsIt) {
  for (const int n : {4, 8}) {
    Rig rig(plumb_test::cone_array(n));
    rig.prove();
    rig.stay(kHere);
    int held = 0;
    for (int block = 0; block < 5000; ++block) {
      int samples = 0;
      for (int k = 0; k < rig.setup.config.window; ++k)
        samples += rig.step(rig.sample(kHere, kG0_mps2)).validity == Validity::held ? 1 : 0;
      held += samples > 0 ? 1 : 0;
    }
    EXPECT_LE(held, 2) << n;
  }
}

}  // namespace
}  // namespace freshness_test
