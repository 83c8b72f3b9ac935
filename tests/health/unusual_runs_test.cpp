// Lives that are seldom led: channels that stutter, that stand at their range while others fail, several faults under
// an assertion, settings at the ends of their ranges. Whoever is healthy stays, and what is published is finite.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "health/first_calibration_support.hpp"
#include "health/recalibration_support.hpp"

namespace unusual_runs_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::random_direction;
using plumb_test::Rig;
using plumb_test::Tool;
using plumb_test::UncalibratedTool;

void expect_sound(const Verdict& v) {
  for (const double g : v.gravity_mps2) ASSERT_TRUE(std::isfinite(g));
  ASSERT_TRUE(std::isfinite(v.protection_level_calibrated_axes_rad));
  ASSERT_EQ(v.in_service | v.provisionally_excluded | v.excluded | v.absent, v.configured);
}

/// One sensor at fault from the third attitude on, another that delivers one sample of three in some blocks.
// Negative: REQ-074
TEST(UnusualRun, AStutteringChannelHidesNoFaultAndIsNotExcludedForOne) {
  int told = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const int n = 4 + static_cast<int>(seed % 5);
    MonitorConfig config;
    config.assumed_faults = seed % 3 == 0 ? 1 : -1;
    Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), config, seed);
    rig.prove();
    Noise luck(seed + 40);
    const int broken = static_cast<int>(seed) % n, stutters = (broken + 1 + static_cast<int>(seed / 5)) % n;
    int block = 0;
    rig.distort = [&](int i, double r, int) { return i == broken && block > 4 ? r + 0.3 : r; };
    for (int station = 0; station < 14; ++station) {
      const Vec3 u = random_direction(luck);
      for (int b = 0; b < 3; ++b, ++block) {
        const bool stuttering = luck.uniform() < 0.4;
        for (int k = 0; k < config.window; ++k) {
          Sample s = rig.sample(u, kG0_mps2);
          if (stuttering && k % 3 != 0) s.delivered = s.delivered.without(stutters);
          expect_sound(rig.step(s));
        }
      }
    }
    EXPECT_TRUE(SensorSet::of(broken).with(stutters).contains(rig.ever_blamed)) << seed;
    told += rig.ever_blamed.has(broken) ? 1 : 0;
  }
  EXPECT_GE(told, 20) << "of 24 lives";
}

/// A channel that shakes at its full scale, one that fails into it, and a tool that reaches it by itself.
// Negative: REQ-148
TEST(UnusualRun, AtFullScaleOnlyASensorThatTheOthersContradictIsReported) {
  bool clipped = false;
  int told = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const int n = 4 + static_cast<int>(seed % 4);
    Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), {}, seed);
    constexpr double kRange_mps2 = 10.4;
    rig.setup.full_scale_raw.fill(kRange_mps2);
    rig.restart();
    rig.prove();
    Noise luck(seed + 90);
    const int broken = static_cast<int>(seed) % n;
    const double fault = seed % 2 == 0 ? 20.0 : 1.0, noise = seed % 3 == 0 ? 30.0 : 0.0;
    rig.distort = [&](int i, double r, int) {
      const double shown = i == broken ? r + fault + noise * luck.normal() : r;
      return std::clamp(shown, -kRange_mps2, kRange_mps2);
    };
    for (int station = 0; station < 12; ++station) {
      const Vec3 u = random_direction(luck);
      const double g = station % 4 == 3 ? 1.08 * kG0_mps2 : kG0_mps2;
      for (int k = 0; k < 2 * 32; ++k) {
        const Verdict& v = rig.step(rig.sample(u, g));
        expect_sound(v);
        clipped = clipped || v.sensor_cause[static_cast<std::size_t>(broken)] == Cause::clipped;
      }
    }
    EXPECT_TRUE(SensorSet::of(broken).contains(rig.ever_blamed)) << seed;
    told += rig.ever_blamed.empty() ? 0 : 1;
  }
  EXPECT_GE(told, 16) << "of 24 lives";
  EXPECT_TRUE(clipped);
}

/// Up to two faults are asserted, and three come one after the other.
// Verifies: REQ-073
TEST(UnusualRun, AnAssumptionIsUsedUpByTheFaultsThatItCovers) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    MonitorConfig config;
    config.assumed_faults = seed % 2 == 0 ? 3 : 2;
    Rig rig(plumb_test::cone_array(7), config, seed);
    rig.prove();
    Noise luck(seed);
    int faults = 0;
    rig.distort = [&](int i, double r, int) { return i < faults ? r + 0.3 + 0.1 * i : r; };
    for (; faults <= 3; ++faults) {
      for (int k = 0; k < 6; ++k) expect_sound(rig.stay(random_direction(luck)));
      if (faults <= 2) {
        EXPECT_EQ(rig.ever_blamed, SensorSet::first(faults)) << seed << ", " << faults;
      }
    }
  }
}

/// No fault is ever expected, or so many that no set covers them.
// Verifies: REQ-121
TEST(UnusualRun, TheProtectionLevelCoversAtLeastOneFaultOrIsUnavailable) {
  const auto available = [](double prior, double risk) {
    MonitorConfig config;
    config.fault_prior = prior;
    config.integrity_risk = risk;
    Rig rig(plumb_test::cone_array(8), config);
    rig.prove();
    return rig.stay(direction_at(30, 40), 2).protection_available;
  };
  EXPECT_TRUE(available(0.0, 1e-6));
  EXPECT_TRUE(available(1e-4, 1e-6));
  EXPECT_FALSE(available(0.1, 1e-12));
}

/// The first calibration under the settings that do not concern it: the span that was stated is kept, and the average
/// form waits for a calibration.
// Verifies: REQ-136
TEST(UnusualRun, AFirstCalibrationKeepsTheSpanThatWasStated) {
  for (const bool stated : {false, true}) {
    MonitorConfig config;
    config.alarm_form = AlarmForm::average_tool;
    if (stated) {
      config.temperature_min_degc = -20.0;
      config.temperature_max_degc = 120.0;
    }
    UncalibratedTool tool(4, 3, 1.0, config);
    tool.start();
    tool.follow(60);
    ASSERT_TRUE(tool.calibrated());
    tool.temperature_degc = 80.0;
    tool.wander(8);
    EXPECT_EQ(tool.monitor.verdict().validity == Validity::valid, stated);
  }
}

/// A sensor that never spoke is left out of it, and takes nothing of it.
// Verifies: REQ-136
TEST(UnusualRun, AFirstCalibrationOfTheSensorsThatDeliver) {
  UncalibratedTool tool(6, 5);
  tool.silent = SensorSet::of(2);
  tool.start();
  tool.follow(80);
  ASSERT_TRUE(tool.calibrated());
  EXPECT_EQ(tool.monitor.calibrated(), SensorSet::first(6).without(2));
  EXPECT_EQ(tool.monitor.array().axis(2), tool.setup.array.axis(2));
}

/// A scale far beyond what the datasheet leaves open is never adopted.
// Negative: REQ-137
TEST(UnusualRun, ASensorOfAnotherScaleThanItsDatasheetIsNotTakenForIt) {
  for (const double scale : {1.0, 1.15}) {
    UncalibratedTool tool(5, 6);
    tool.truth(1).w = scaled(tool.truth(1).w, scale);
    tool.start();
    tool.roam(60);
    EXPECT_EQ(tool.calibrated(), scale == 1.0);
  }
}

/// Attitudes at which one sensor was silent are no part of the record by which gravity is judged.
// Verifies: REQ-062
TEST(UnusualRun, ALengthThatIsOffIsStudiedWhereAllDeliver) {
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  Noise luck(4);
  for (int station = 0; station < 20; ++station) {
    const Vec3 u = random_direction(luck);
    for (int k = 0; k < 32; ++k) {
      Sample s = rig.sample(u, 1.005 * kG0_mps2);
      if (station % 2 == 0 && k % 3 != 0) s.delivered = s.delivered.without(2);
      rig.step(s);
    }
    EXPECT_LE(rig.monitor.verdict().norm_mismatch.attitudes, 1 + station / 2 + 1) << station;
  }
  EXPECT_TRUE(rig.ever_blamed.empty());
}

}  // namespace
}  // namespace unusual_runs_test
