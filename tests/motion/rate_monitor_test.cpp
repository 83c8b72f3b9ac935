// Redundant gyro axes: who is isolated in motion and at rest, when nobody is, and the bound of the rate.
#include "plumb/motion/rate_monitor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <limits>
#include <type_traits>

#include "motion/gyro_array.hpp"

// Serves: REQ-213

namespace rate_monitor_test {
namespace {

using namespace plumb;
using plumb_test::cone_array;
using plumb_test::GyroArray;
using plumb_test::rate_setup;

static_assert(std::is_trivially_copyable_v<RateMonitor>);

constexpr double kNoise_radps = 0.002;

/// Axes of a cone in general position, each a unit of its own.
GyroArray of_cone(int n, std::uint64_t seed) { return {cone_array(n, kNoise_radps), rate_setup(), seed}; }

// Verifies: REQ-213
RC_GTEST_PROP(RateMonitorLaw, HealthyAxesRaiseNoAlarmAndKeepTheirBound, ()) {
  GyroArray gyros = of_cone(*rc::gen::inRange(4, 9), *rc::gen::arbitrary<std::uint32_t>());
  gyros.turn(0, 700);
  RC_ASSERT(!gyros.monitor.verdict().alarm);
  RC_ASSERT(gyros.ever_isolated.empty() && gyros.ever_excluded.empty());
  if (gyros.array.size() > 4) RC_ASSERT(gyros.bounded == gyros.judged - 2);
  RC_ASSERT(gyros.worst_ratio < 1.0);
}

// Whatever one axis reads, no healthy one is blamed, and the rate keeps its bound.
// Verifies: REQ-213
RC_GTEST_PROP(RateMonitorLaw, OneAxisBlamesNoOther, ()) {
  const int n = *rc::gen::inRange(4, 9);
  GyroArray gyros = of_cone(n, *rc::gen::arbitrary<std::uint32_t>());
  const auto faulty = static_cast<std::size_t>(*rc::gen::inRange(0, n));
  const int kind = *rc::gen::inRange(0, 6);
  const double size = 0.01 * *rc::gen::inRange(-500, 501);
  gyros.distort = [=, held = 0.0](RateSample& s) mutable {
    double& y = s.rate_radps[faulty];
    if (s.time_s < 0.3) {
      held = y;
      return;
    }
    if (kind == 0) y = 0.0;
    if (kind == 1) y = held;
    if (kind == 2) y += size;
    if (kind == 3) y *= 1.0 + size;
    if (kind == 4) y = size * std::sin(40.0 * s.time_s);
    if (kind == 5) y = std::numeric_limits<double>::quiet_NaN();
  };
  gyros.turn(0, 1000);
  const SensorSet healthy = gyros.array.all().without(static_cast<int>(faulty));
  RC_ASSERT((gyros.ever_isolated & healthy).empty());
  RC_ASSERT((gyros.ever_excluded & healthy).empty());
  RC_ASSERT(gyros.worst_ratio < 1.0);
}

TEST(RateMonitor, IsolatesAsManyAsTheAxesAllow) {
  const struct {
    int axes;
    SensorSet faulty;
  } cases[] = {{5, SensorSet::of(1)},
               {6, SensorSet::of(0).with(4)},
               {7, SensorSet::of(2).with(3).with(6)},
               {8, SensorSet::of(0).with(3).with(5)}};
  for (const auto& one : cases) {
    GyroArray gyros = of_cone(one.axes, 11);
    gyros.distort = [&](RateSample& s) {
      double size = 1.0;
      for (int i = 0; i < one.axes; ++i) {
        if (one.faulty.has(i) && s.time_s >= 0.3) s.rate_radps[static_cast<std::size_t>(i)] += size *= -1.7;
      }
    };
    gyros.turn(0, 4000);
    EXPECT_TRUE(gyros.ever_excluded == one.faulty) << one.axes;
    EXPECT_LT(gyros.worst_ratio, 1.0);
  }
}

TEST(RateMonitor, FourAxesDetectAndBlameNobody) {
  GyroArray gyros = of_cone(4, 5);
  gyros.distort = [](RateSample& s) { s.rate_radps[2] += s.time_s > 0.3 ? 1.0 : 0.0; };
  gyros.turn(0, 1000);
  EXPECT_TRUE(gyros.monitor.verdict().alarm);
  EXPECT_TRUE(gyros.ever_isolated.empty());
}

TEST(RateMonitor, AtRestAnAxisIsHeldAgainstZero) {
  GyroArray gyros = of_cone(4, 5);  // by parity four axes name nobody
  gyros.at_rest = true;
  gyros.turn(0, 64);
  EXPECT_FALSE(gyros.monitor.verdict().alarm);
  gyros.distort = [](RateSample& s) { s.rate_radps[2] += 0.05; };
  gyros.turn(64, 320);
  EXPECT_TRUE(gyros.monitor.verdict().off_at_rest == SensorSet::of(2));
  EXPECT_TRUE(gyros.monitor.verdict().isolated == SensorSet::of(2));
  EXPECT_FALSE(gyros.monitor.verdict().turned_at_rest);
  gyros.at_rest = false;
  gyros.turn(320, 500);
  EXPECT_FALSE(gyros.monitor.verdict().sample.used.has(2));
  gyros.distort = [](RateSample&) {};
  gyros.at_rest = true;
  gyros.turn(500, 600);
  EXPECT_TRUE(gyros.monitor.verdict().off_at_rest.empty()) << "it reads zero again";
}

TEST(RateMonitor, ASmallerOffsetThanItsBoundsAllowIsNoFault) {
  GyroArray gyros = of_cone(4, 5);
  gyros.at_rest = true;
  gyros.error[2] = {0.0, 0.0, 0.0049, 0.0, 0.0};
  gyros.turn(0, 640);
  EXPECT_FALSE(gyros.monitor.verdict().alarm);
}

// Negative: REQ-213
TEST(RateMonitor, WhereTheToolTurnedNobodyIsBlamed) {
  GyroArray gyros = of_cone(6, 5);
  gyros.at_rest = true;
  gyros.creep_radps = {0.3, -0.2, 0.4};
  gyros.turn(0, 128);
  EXPECT_TRUE(gyros.monitor.verdict().turned_at_rest);
  EXPECT_TRUE(gyros.monitor.verdict().off_at_rest.empty());
  EXPECT_TRUE(gyros.ever_isolated.empty());
}

/// Two triads at rest, each axis a unit, that turn slowly about z: both z axes read it, and no other one does.
TEST(RateMonitor, ATurnThatFewAxesFeelBlamesNoneOfThem) {
  for (const double creep_radps : {0.006, 0.01, 0.3}) {
    GyroArray gyros(plumb_test::in_chips(plumb_test::parallel_triads(2, kNoise_radps), 3, 0), rate_setup(), 5);
    gyros.at_rest = true;
    gyros.creep_radps = {0.0, 0.0, creep_radps};
    gyros.error[2].bias_radps = 0.0049;  // beyond its limit with the creep, where the other one is not
    gyros.error[5].bias_radps = -0.0049;
    gyros.turn(0, 640);
    EXPECT_TRUE(gyros.monitor.verdict().turned_at_rest) << creep_radps;
    EXPECT_TRUE(gyros.ever_isolated.empty()) << creep_radps;
  }
}

// However slowly and about whichever axis a tool turns that is said to rest, no healthy axis is blamed.
// Verifies: REQ-213
RC_GTEST_PROP(RateMonitorLaw, ATurnAtRestBlamesNobody, ()) {
  GyroArray gyros = of_cone(*rc::gen::inRange(4, 9), *rc::gen::arbitrary<std::uint32_t>());
  gyros.at_rest = true;
  const double size = std::pow(10.0, 0.1 * *rc::gen::inRange(-40, 1));
  for (double& w : gyros.creep_radps) w = size * 0.1 * *rc::gen::inRange(-10, 11);
  gyros.turn(0, 400);
  RC_ASSERT(gyros.ever_isolated.empty());
  RC_ASSERT(gyros.monitor.verdict().off_at_rest.empty());
}

TEST(RateMonitor, GSensitivityIsAllowedForByTheForceThatIsKnown) {
  const struct {
    double felt_mps2, known_mps2;
  } cases[] = {{80.0, 80.0}, {80.0, -1.0}, {2000.0, 2000.0}};  // the last is beyond `force_bound_mps2`
  for (const auto& one : cases) {
    GyroArray gyros = of_cone(6, 7);
    gyros.distort = [&](RateSample& s) {
      s.rate_radps[1] += 0.8e-4 * one.felt_mps2;
      s.force_mps2 = one.known_mps2;
    };
    gyros.turn(0, 2000);
    EXPECT_FALSE(gyros.monitor.verdict().alarm);
  }
}

TEST(RateMonitor, RefusesWhatIsNoSetup) {
  const SensorArray array = cone_array(6, kNoise_radps);
  RateMonitor monitor;
  const auto refused = [&](auto change) {
    RateSetup setup = rate_setup();
    change(setup);
    const Expected<void> sound = monitor.configure(array, setup);
    return sound.has_value() ? -1 : sound.error().index;
  };
  EXPECT_EQ(refused([](RateSetup&) {}), -1);
  EXPECT_EQ(refused([](RateSetup& s) { s.at_rest_radps = -1.0; }), 120);
  EXPECT_EQ(refused([](RateSetup& s) { s.force_bound_mps2 = std::numeric_limits<double>::quiet_NaN(); }), 121);
  EXPECT_EQ(refused([](RateSetup& s) { s.errors[4].g_sensitivity_s_per_m = 2.0; }), 4);
  EXPECT_EQ(refused([](RateSetup& s) { s.rate_bound_radps = 0.0; }), 107);
  EXPECT_EQ(refused([](RateSetup& s) { s.errors[3].scale = 0.9; }), 3);
}

// `step` is total, and a copy goes on bit by bit as the original does.
RC_GTEST_PROP(RateMonitorLaw, AnyBitsAreTakenAndReplayedAlike, ()) {
  GyroArray gyros = of_cone(5, 3);
  gyros.turn(0, 100);
  RateMonitor copy = gyros.monitor;
  for (int k = 0; k < 40; ++k) {
    RateSample s;
    std::array<std::uint64_t, sizeof(RateSample) / 8> bits{};
    for (std::uint64_t& word : bits) word = *rc::gen::arbitrary<std::uint64_t>();
    std::memcpy(s.rate_radps.data(), bits.data(), sizeof s.rate_radps);
    std::memcpy(&s.force_mps2, &bits.back(), sizeof s.force_mps2);
    s.time_s = 0.1 + 0.001 * k;
    s.delivered = SensorSet(static_cast<std::uint32_t>(bits[0]));
    s.clipped = SensorSet(static_cast<std::uint32_t>(bits[1]));
    s.at_rest = (bits[2] & 1U) != 0;
    gyros.monitor.step(s);
    copy.step(s);
    RC_ASSERT(gyros.monitor.verdict().isolated == copy.verdict().isolated);
    RC_ASSERT(
        std::memcmp(&gyros.monitor.verdict().sample.rate_radps, &copy.verdict().sample.rate_radps, sizeof(Vec3)) == 0);
  }
}

}  // namespace
}  // namespace rate_monitor_test
