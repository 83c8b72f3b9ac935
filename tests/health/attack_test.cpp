// Counter-examples that an assessor found against an earlier monitor; each is a rule now.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "support/simulated_tool.hpp"

namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::Rig;

// Negative: REQ-094
TEST(Attack, AnUnconfiguredMonitorAlerts) {
  auto monitor = std::make_unique<HealthMonitor>();
  EXPECT_TRUE(monitor->verdict().alert);
  EXPECT_TRUE(monitor->step(Sample{}).alert);
  EXPECT_EQ(monitor->verdict().validity, Validity::invalid);
}

// Negative: REQ-074
TEST(Attack, SwayWithinAStationConvictsNobodyHealthy) {
  // Blocks up to 2 deg apart are one station; a mean over them would be shorter than gravity. Colluding faults.
  for (int n = 4; n <= std::min(6, kCapacity); ++n) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), {}, seed);
      rig.prove();
      Noise noise(seed);
      const int m = strict_grade(rig.setup.array, rig.setup.array.all());
      const Vec3 ghost = plumb_test::random_direction(noise);
      rig.distort = [&](int i, double r, int) { return i < m ? dot(rig.setup.array.axis(i), ghost) * kG0_mps2 : r; };
      for (int station = 0; station < 10; ++station) {
        const double inclination = 20.0 + 12.0 * station;
        for (int block = 0; block < 6; ++block) rig.stay(direction_at(inclination + 0.35 * block, 47.0 * station));
        EXPECT_TRUE((rig.monitor.verdict().excluded - SensorSet::first(m)).empty()) << n << " " << seed;
      }
    }
  }
}

// Verifies: REQ-052
TEST(Attack, UnequalCountsDoNotMakeAHealthyToolAlarm) {
  MonitorConfig config;
  config.window = 2;
  Rig rig(plumb_test::cone_array(6), config);
  Noise noise(5);
  int alarms = 0;
  for (int k = 0; k < 600; ++k) {
    Sample s = rig.sample(direction_at(20.0 + k / 10, 3.0 * (k / 10)), kG0_mps2);
    s.count = k % 2 == 0 ? 1U : 1000U;  // the noise of every row is that of one sample
    const Verdict& v = rig.step(s);
    alarms += v.tick && v.margin < 0.0 ? 1 : 0;
  }
  EXPECT_EQ(alarms, 0);
  EXPECT_TRUE(rig.ever_blamed.empty());
}

// Negative: REQ-092
TEST(Attack, LosingAnExcludedChannelDoesNotFail) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 2.0 : r; };
  Noise noise(7);
  for (int k = 0; k < 8; ++k) rig.stay(plumb_test::random_direction(noise));
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::degraded_3_sensor);
  rig.distort = [](int i, double r, int) { return i == 2 ? std::numeric_limits<double>::quiet_NaN() : r; };
  rig.stay(direction_at(40, 40), 4);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::degraded_3_sensor);
  EXPECT_EQ(rig.monitor.verdict().absent, SensorSet::of(2));
}

// Verifies: REQ-141
TEST(Attack, ADropoutPerBlockDoesNotBlindTheTests) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int k) {
    if (i == 0 && k % 32 == 7) return std::numeric_limits<double>::quiet_NaN();
    return i == 1 ? r + 0.5 : r;
  };
  EXPECT_EQ(rig.stay(direction_at(45, 200)).state, HealthState::suspect) << "parity still has all four";
}

// Verifies: REQ-141
// Negative: REQ-120
TEST(Attack, AMostlySilentChannelIsLostAndMeanwhileNothingIsValid) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int k) {
    return i == 0 && k % 3 != 0 ? std::numeric_limits<double>::quiet_NaN() : r;
  };
  EXPECT_EQ(rig.stay(direction_at(45, 200)).validity, Validity::unconfirmed);
  EXPECT_EQ(rig.stay(direction_at(45, 200), 4).absent, SensorSet::of(0));
}

// Negative: REQ-091
TEST(Attack, AChannelEventDoesNotSwallowTheAlarm) {
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  rig.distort = [](int i, double r, int k) {
    if (i == 0 && k % 32 >= 29) return std::numeric_limits<double>::quiet_NaN();  // lost exactly at the tick
    return i == 5 ? r + 0.1 : r;
  };
  int valid = 0;
  for (int k = 0; k < 30; ++k) {
    const Verdict& v = rig.stay(direction_at(45, 200));
    valid += v.validity == Validity::valid && v.in_service.has(5) ? 1 : 0;
  }
  EXPECT_LE(valid, 1);
}

// Negative: REQ-146
TEST(Attack, OneWildTimeStampDoesNotBlockForEver) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  Sample wild = rig.sample(direction_at(100, 340), kG0_mps2);
  wild.time_s = 1e12;
  rig.monitor.step(wild);
  rig.stay(direction_at(100, 340), 3);
  EXPECT_EQ(rig.monitor.verdict().validity, Validity::valid) << "the new time base was accepted as a gap";
}

// Negative: REQ-170
TEST(Attack, SigmasTooFarApartAreRefused) {
  Rig rig(plumb_test::cone_array(4));
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < 4; ++i) rows[static_cast<std::size_t>(i)] = rig.setup.array.row(i);
  rows[0].sigma_mps2 *= 1e3;
  rig.setup.array = *SensorArray::make(rows.data(), 4);
  auto monitor = std::make_unique<HealthMonitor>();
  const auto refused = monitor->configure(rig.setup);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, Errc::out_of_range);
  EXPECT_EQ(refused.error().index, 0);
}

// Verifies: REQ-097
TEST(Attack, GravityOffByWhatItsSigmaAllowsDoesNotLockTrustOut) {
  for (int n : {4, 6}) {
    Rig rig(n == 4 ? plumb_test::tetrahedron(1e-4 * kG0_mps2) : plumb_test::cone_array(n, 1e-4 * kG0_mps2));
    const double off = 1.0 + 2.8 * rig.setup.gravity.sigma_mps2 / kG0_mps2;
    Noise noise(9);
    for (int k = 0; k < 40; ++k) rig.stay(plumb_test::random_direction(noise), 1, kG0_mps2 * off);
    EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal) << n;
  }
}

// Negative: REQ-064
TEST(Attack, OneHotSampleTaintsItsBlock) {
  MonitorConfig config;
  config.temperature_max_degc = 100.0;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  for (int k = 0; k < 32; ++k) {
    Sample s = rig.sample(direction_at(45, 20), kG0_mps2);
    s.temperature_degc = k < 31 ? 160.0 : 25.0;
    s.raw[2] += 1.0;
    rig.step(s);
  }
  EXPECT_EQ(rig.monitor.verdict().cause, Cause::temperature);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal);
}

/// Three of seven hang together at a mirror image of gravity, anew at every station, and the tool shakes now and then:
/// the calm three are no witness that the other four are noisy.
// Negative: REQ-059
TEST(Attack, SensorsThatHangTogetherDoNotPassAShakenBlockForAQuietOne) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Rig rig(plumb_test::cone_array(7), {}, seed);
    rig.prove();
    const SensorSet liars(0b0011100);
    const Vec3 across = cross(rig.setup.array.axis(0), rig.setup.array.axis(1));
    Noise noise(seed);
    Vec3 shown{};
    rig.distort = [&](int i, double r, int) {
      return liars.has(i) ? dot(rig.setup.array.axis(i), shown) + rig.setup.array.sigma_mps2(i) * noise.normal() : r;
    };
    for (int station = 0; station < 30; ++station) {
      const Vec3 u = plumb_test::random_direction(noise);
      const Vec3 g = scaled(u, kG0_mps2);
      shown = minus(g, scaled(across, 2.0 * dot(g, across) / dot(across, across)));
      if (station % 3 == 0) {
        rig.shake(u, 0.2 * kG0_mps2);
      } else {
        rig.stay(u);
      }
      ASSERT_TRUE(liars.contains(rig.ever_blamed)) << "seed " << seed << ", station " << station;
    }
  }
}

/// Three of six hang, the tool is pushed along the one line that two of the other three do not feel: the sixth alone
/// scatters, as if it were noisy. What it reads on average convicts nobody.
// Negative: REQ-074
TEST(Attack, SensorsThatHangDoNotPassAPushedOneForANoisyOne) {
  for (int n = 5; n <= std::min(8, kCapacity); ++n) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      Rig rig(plumb_test::cone_array(n), {}, seed);
      rig.prove();
      const int m = strict_grade(rig.setup.array, rig.setup.array.all());
      const SensorSet liars = SensorSet::first(m);
      Noise noise(seed);
      double push = 0.0;
      rig.distort = [&](int i, double r, int k) {
        if (liars.has(i)) return -r;
        return i == n - 1 && k % 8 == 3 ? r + push : r;
      };
      for (int station = 0; station < 30; ++station) {
        push = (station % 2 == 0 ? 0.4 : -0.4) * kG0_mps2 * noise.uniform();
        rig.stay(plumb_test::random_direction(noise));
        ASSERT_TRUE(liars.contains(rig.monitor.verdict().excluded)) << n << " " << seed << ", station " << station;
      }
    }
  }
}

}  // namespace
