#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "flight_specs.hpp"

namespace plumb {
namespace scenario {
namespace flight_test {
namespace {

struct Reached {
  double least_force = 1e9, most_force = 0.0;  ///< of the smooth motion [m/s^2]
  double most_rate = 0.0;                      ///< [rad/s]
  double rms = 0.0;                            ///< vibration of the vector, from the third second on [m/s^2]
  double most_vibration = 0.0;
};

/// Behind a filter that hardly takes anything.
Reached reached(FlightKind kind, std::uint64_t seed, int samples) {
  FlightSpec spec = perfect_spec(kind, seed, 1);
  spec.bandwidth_hz = 1000.0;
  Flight flight(spec);
  spec.vibration = 0.0;
  Flight smooth(spec);
  Reached out;
  int count = 0;
  for (int k = 0; k < samples; ++k) {
    const FlightSample a = flight.next(), b = smooth.next();
    const double force = norm(b.specific_force_mps2);
    const Vec3 vibration = minus(a.specific_force_mps2, b.specific_force_mps2);
    out.least_force = std::min(out.least_force, force);
    out.most_force = std::max(out.most_force, force);
    out.most_rate = std::max(out.most_rate, norm(a.true_rate_radps));
    out.most_vibration = std::max(out.most_vibration, norm(vibration));
    if (k < 2000) continue;
    out.rms += dot(vibration, vibration);
    ++count;
  }
  out.rms = std::sqrt(out.rms / std::max(count, 1));
  return out;
}

/// The least and the most of a figure over the flights.
struct Span {
  double low = 1e9, high = 0.0;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

struct Spans {
  Span force, rate, rms, vibration;
};
Spans spans(FlightKind kind, int samples) {
  Spans out;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Reached one = reached(kind, seed, samples);
    out.force.add(one.least_force / kG0_mps2);
    out.force.add(one.most_force / kG0_mps2);
    out.rate.add(deg_from_rad(one.most_rate));
    out.rms.add(one.rms / kG0_mps2);
    out.vibration.add(one.most_vibration / kG0_mps2);
  }
  return out;
}

TEST(FlightMotion, DronesReachTheirRanges) {
  const Spans all = spans(FlightKind::drone, 15000);
  EXPECT_GE(all.force.low, 0.3);
  EXPECT_LE(all.force.low, 0.35);
  EXPECT_GE(all.force.high, 2.4);
  EXPECT_LE(all.force.high, 2.5);
  EXPECT_GE(all.rate.high, 260.0);
  EXPECT_LE(all.rate.high, 300.0);
  EXPECT_GE(all.rms.low, 0.5);
  EXPECT_LE(all.rms.low, 0.8);
  EXPECT_GE(all.rms.high, 3.5);
  EXPECT_LE(all.rms.high, 5.0);
}

TEST(FlightMotion, DrillStringsReachTheirRanges) {
  const Spans all = spans(FlightKind::drilling, 15000);
  EXPECT_GE(all.force.low, 0.8);
  EXPECT_LE(all.force.high, 1.2);
  EXPECT_GE(all.rate.high, 165.0 * 6.0);  // 1 rpm = 6 deg/s
  EXPECT_LE(all.rate.high, 181.0 * 6.0);
  EXPECT_GE(all.rms.low, 0.5);
  EXPECT_LE(all.rms.high, 4.0);         // shocks included
  EXPECT_GE(all.vibration.high, 25.0);  // a shock of 30 g
  EXPECT_LE(all.vibration.high, 42.0);  // on top of the rest
}

TEST(FlightMotion, CarsReachTheirRanges) {
  const Spans all = spans(FlightKind::car, 15000);
  EXPECT_GE(all.force.low, 0.99);
  EXPECT_GE(all.force.high, 1.38);  // 1 g horizontally
  EXPECT_LE(all.force.high, 1.43);
  EXPECT_GE(all.rate.high, 30.0);
  EXPECT_LE(all.rate.high, 40.0);
  EXPECT_GE(all.vibration.high, 1.8);  // a bump
  EXPECT_LE(all.rms.high, 0.6);
}

TEST(FlightMotion, LaunchersReachTheirRanges) {
  const Spans all = spans(FlightKind::launch, 25000);
  EXPECT_LE(all.force.low, 0.3);
  EXPECT_GE(all.force.high, 7.7);
  EXPECT_LE(all.force.high, 8.01);
  EXPECT_GE(all.rate.high, 150.0);
  EXPECT_LE(all.rate.high, 180.0);
  EXPECT_GE(all.rms.low, 0.5);
  EXPECT_GE(all.rms.high, 2.5);
  EXPECT_LE(all.rms.high, 5.0);
}

TEST(FlightMotion, BeginsWithModerateMotion) {
  for (const FlightKind kind : kKinds) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Reached one = reached(kind, seed, 990);
      EXPECT_LT(deg_from_rad(one.most_rate), 240.0) << "40 rpm of a drill string";
      EXPECT_NEAR(one.least_force, kG0_mps2, 0.01) << to_string(kind);
      EXPECT_NEAR(one.most_force, kG0_mps2, 0.01) << to_string(kind);
      EXPECT_LT(one.most_vibration, 0.3 * 4.0 * 5.0 * kG0_mps2);
    }
  }
}

// Nothing but gravity acts across the axis of a smooth drill string: d(f)/dt = -w x f there.
TEST(FlightMotion, GravityTurnsAgainstTheDrillString) {
  FlightSpec spec = perfect_spec(FlightKind::drilling, 2, 1);
  spec.vibration = 0.0;
  const auto samples = fly(spec, 15000);
  for (std::size_t k = 1; k + 1 < samples.size(); ++k) {
    const Vec3 slope = scaled(minus(samples[k + 1].specific_force_mps2, samples[k - 1].specific_force_mps2), 500.0);
    const Vec3 expected = scaled(cross(samples[k].true_rate_radps, samples[k].specific_force_mps2), -1.0);
    ASSERT_NEAR(slope[0], expected[0], 0.05);
    ASSERT_NEAR(slope[1], expected[1], 0.05);
  }
}

}  // namespace
}  // namespace flight_test
}  // namespace scenario
}  // namespace plumb
