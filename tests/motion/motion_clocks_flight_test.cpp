// A monitor that `MotionClocks` feeds: faults are found, nobody healthy is blamed, and what clocks cost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "motion/clocked_motion.hpp"

// Serves: REQ-207

namespace motion_clocks_flight_test {
namespace {

using namespace plumb;
using plumb_test::ChipClocks;
using plumb_test::clocks_of;
using plumb_test::cone_array;
using plumb_test::motion_setup;
using plumb_test::Noise;

constexpr double kOnset_s = 0.7;

/// What a flight of six sensors came to.
struct Outcome {
  SensorSet isolated;
  double isolated_after_s = -1.0;
  double bound_sum_mps2 = 0.0;
  int blocks = 0;
};

struct Flight {
  std::uint64_t seed = 1;
  bool clocks_of_their_own = true;
  bool stated = true;        ///< `with_clocks` is applied
  double bias_mps2 = 0.0;    ///< of sensor 2, from the onset on
  bool dies = false;         ///< sensor 2, likewise
  double clock_off_s = 0.0;  ///< of sensor 2, beyond what is stated
  double offset_bound_s = 20e-6;
};

Outcome fly(const Flight& flight) {
  constexpr int kSensors = 6;
  constexpr std::size_t kVictim = 2;
  Noise noise(flight.seed);
  MotionSetup setup = motion_setup(kSensors, flight.seed);
  setup.gyros = 2;
  setup.max_faults = 1;
  SensorArray array = cone_array(kSensors, 0.01);
  const SensorArray sensors = array;
  const MotionSetup bounds = setup;
  ClockSetup stated = clocks_of(kSensors, kSensors, setup, noise);
  for (MotionClock& clock : stated.clock) clock.offset_bound_s = flight.offset_bound_s;
  plumb_test::RigidMotion motion(sensors, bounds, flight.seed, 40.0, 3.0);
  motion.draw_errors(flight.seed % 2 == 0);
  ChipClocks chips(stated, noise, flight.seed % 2 == 0);
  if (flight.clock_off_s != 0.0) chips.put_off(static_cast<int>(kVictim), flight.clock_off_s);
  const auto clocks = std::make_unique<MotionClocks>();
  const auto monitor = std::make_unique<MotionMonitor>();
  EXPECT_TRUE(clocks->configure(array, setup, stated).has_value());
  const bool told = flight.clocks_of_their_own && flight.stated;
  EXPECT_TRUE(!told || with_clocks(stated, array, setup).has_value());
  EXPECT_TRUE(monitor->configure(array, setup).has_value());
  const auto read = [&](double t) {
    MotionSample s = motion.sample_at(t);
    if (t >= kOnset_s) s.reading_mps2[kVictim] = flight.dies ? 0.0 : s.reading_mps2[kVictim] + flight.bias_mps2;
    return s;
  };
  Outcome out;
  const auto take = [&](const MotionSample& s) {
    const MotionVerdict& v = monitor->step(s);
    if (out.isolated.empty() && !v.isolated.empty()) out.isolated_after_s = s.time_s - kOnset_s;
    out.isolated = out.isolated | v.isolated | v.excluded;
    if (!v.block_ended || v.block.validity != ForceValidity::bounded || s.time_s > kOnset_s) return;
    out.bound_sum_mps2 += v.block.bound_mps2;
    ++out.blocks;
  };
  for (int k = 0; k < 3000; ++k) {
    const double now_s = 0.0005 * k;
    if (!flight.clocks_of_their_own) {
      if (k % 2 == 0) take(read(now_s));
      continue;
    }
    chips.deliver(now_s, *clocks, [&](int, double t) { return read(t); });
    MotionSample s;
    while (clocks->next(now_s, s)) take(s);
  }
  return out;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? -1.0 : values[values.size() / 2];
}

/// Flights of a fault: all name sensor 2 and nobody else.
double median_delay_s(Flight flight, const char* name) {
  std::vector<double> after_s;
  for (flight.seed = 1; flight.seed <= 40; ++flight.seed) {
    const Outcome out = fly(flight);
    EXPECT_EQ(out.isolated, SensorSet::of(2)) << name << ", seed " << flight.seed;
    after_s.push_back(out.isolated_after_s);
  }
  return median(after_s);
}

// Verifies: REQ-207
TEST(MotionClocksFlight, AFaultIsFoundAndNobodyElse) {
  for (const bool own : {false, true}) {
    Flight dead, tenth;
    dead.clocks_of_their_own = tenth.clocks_of_their_own = own;
    dead.dies = true;
    tenth.bias_mps2 = 0.1 * kG0_mps2;
    const double dead_s = median_delay_s(dead, "dead"), tenth_s = median_delay_s(tenth, "0.1 g");
    std::printf("[ measured ] %s: isolated after, median of 40 flights: dead %.0f ms, 0.1 g %.0f ms\n",
                own ? "clocks of their own" : "one clock", 1e3 * dead_s, 1e3 * tenth_s);
    EXPECT_LT(dead_s, 0.1);
    EXPECT_LT(tenth_s, 0.6);
  }
}

TEST(MotionClocksFlight, HealthySensorsAreNotIsolatedAndWhatClocksCost) {
  for (const double offset_bound_s : {-1.0, 5e-6, 20e-6, 50e-6, 100e-6}) {
    Flight flight;
    flight.clocks_of_their_own = offset_bound_s > 0.0;
    if (flight.clocks_of_their_own) flight.offset_bound_s = offset_bound_s;
    double sum = 0.0;
    int blocks = 0;
    for (flight.seed = 1; flight.seed <= 40; ++flight.seed) {
      const Outcome out = fly(flight);
      EXPECT_TRUE(out.isolated.empty()) << offset_bound_s << ", seed " << flight.seed;
      sum += out.bound_sum_mps2;
      blocks += out.blocks;
    }
    ASSERT_GT(blocks, 40 * 15);
    const std::string clocks =
        flight.clocks_of_their_own ? std::to_string(std::lround(1e6 * offset_bound_s)) + " us" : "one clock";
    std::printf("[ measured ] %s: mean bound of blocks of 32 samples %.1f mg\n", clocks.c_str(),
                1e3 * sum / blocks / kG0_mps2);
  }
}

/// The same flights where the limits are not told of the clocks.
// Negative: REQ-207
TEST(MotionClocksFlight, WithoutTheClocksInTheLimitsTheHealthyAreBlamed) {
  int blamed = 0, kept = 0;
  for (std::uint64_t seed = 2; seed <= 40; seed += 2) {
    Flight flight;
    flight.seed = seed;
    flight.offset_bound_s = 900e-6;
    kept += fly(flight).isolated.empty() ? 1 : 0;
    flight.stated = false;
    blamed += fly(flight).isolated.empty() ? 0 : 1;
  }
  std::printf("[ measured ] of 20 healthy flights, clocks within 0.9 ms: isolated in %d where limits are not told\n",
              blamed);
  EXPECT_EQ(kept, 20);
  EXPECT_GT(blamed, 1);
}

TEST(MotionClocksFlight, AClockBeyondItsBoundBlamesItsOwnSensorAtMost) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Flight flight;
    flight.seed = seed;
    flight.clock_off_s = seed % 2 == 0 ? 0.01 : -0.01;
    const SensorSet isolated = fly(flight).isolated;
    EXPECT_TRUE(SensorSet::of(2).contains(isolated)) << "seed " << seed;
    found += isolated.empty() ? 0 : 1;
  }
  EXPECT_GT(found, 10);
}

}  // namespace
}  // namespace motion_clocks_flight_test
