#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "flight_specs.hpp"

namespace plumb {
namespace scenario {
namespace flight_test {
namespace {

constexpr int kOnset = 1500;
constexpr std::size_t kFaulty = 2;

/// A healthy flight and one with a fault of sensors 2 and 5 from 1.5 s on, which differ in nothing else.
struct Pair {
  std::vector<FlightSample> healthy, faulty;
  std::vector<FlightSensorErrors> errors;
};

Pair fly_with(FlightFaultKind kind, double size, FlightSpec spec = spec_of(FlightKind::drone, 12)) {
  Pair out;
  spec.full_scale_mps2 = 100.0 * kG0_mps2;
  out.healthy = fly(spec, 4000);
  FlightFault fault;
  fault.kind = kind;
  fault.sensors = SensorSet::of(2).with(5);
  fault.size = size;
  fault.onset_s = 1.5;
  spec.faults = {fault};
  out.faulty = fly(spec, 4000);
  out.errors = Flight(spec).errors();
  for (std::size_t k = 0; k < 4000; ++k) {
    if (k < kOnset) {
      EXPECT_TRUE(same_bits(out.healthy[k], out.faulty[k])) << k;
      continue;
    }
    FlightSample mended = out.faulty[k];
    for (const std::size_t i : {std::size_t{2}, std::size_t{5}})
      mended.reading_mps2[i] = out.healthy[k].reading_mps2[i];
    EXPECT_TRUE(same_bits(out.healthy[k], mended)) << k;
  }
  return out;
}

/// `expected(k, healthy reading)` from the onset on.
template <class Expected>
void expect_reading(const Pair& pair, double within, const Expected& expected) {
  for (std::size_t k = kOnset; k < pair.faulty.size(); ++k) {
    for (const std::size_t i : {kFaulty, std::size_t{5}}) {
      ASSERT_NEAR(pair.faulty[k].reading_mps2[i], expected(k, i, pair.healthy[k].reading_mps2[i]), within) << k;
    }
  }
}

FlightSpec quiet() {
  FlightSpec spec = spec_of(FlightKind::drone, 12);
  spec.noise_mps2 = 0.0;
  return spec;
}

TEST(FlightFault, BiasIsAdded) {
  const Pair pair = fly_with(FlightFaultKind::bias, -0.7);
  expect_reading(pair, 1e-12, [](std::size_t, std::size_t, double y) { return y - 0.7; });
}

TEST(FlightFault, ADeadSensorKeepsItsBiasAndItsNoise) {
  const Pair still = fly_with(FlightFaultKind::dead, 0.0, quiet());
  expect_reading(still, 0.0, [&](std::size_t, std::size_t i, double) { return still.errors[i].bias_mps2; });
  const Pair pair = fly_with(FlightFaultKind::dead, 0.0);
  double square = 0.0;
  for (std::size_t k = kOnset; k < 4000; ++k)
    square += std::pow(pair.faulty[k].reading_mps2[kFaulty] - pair.errors[kFaulty].bias_mps2, 2.0);
  EXPECT_NEAR(std::sqrt(square / 2500.0), 0.02, 0.002);
}

TEST(FlightFault, AStuckSensorStandsAtItsLastValue) {
  const Pair pair = fly_with(FlightFaultKind::stuck, 0.0);
  expect_reading(pair, 0.0,
                 [&](std::size_t, std::size_t i, double) { return pair.healthy[kOnset - 1].reading_mps2[i]; });
}

TEST(FlightFault, NoiseIsWhiteAndOfItsSize) {
  const Pair pair = fly_with(FlightFaultKind::noise, 2.0);
  double square = 0.0, next = 0.0, both = 0.0, last = 0.0;
  for (std::size_t k = kOnset; k < 4000; ++k) {
    const double x = pair.faulty[k].reading_mps2[2] - pair.healthy[k].reading_mps2[2];
    const double other = pair.faulty[k].reading_mps2[5] - pair.healthy[k].reading_mps2[5];
    square += x * x;
    next += x * last;
    both += x * other;
    last = x;
  }
  EXPECT_NEAR(square / 2500.0, 4.0, 5.0 * 4.0 * std::sqrt(2.0 / 2500.0));
  EXPECT_NEAR(next / 2500.0, 0.0, 5.0 * 4.0 / 50.0);
  EXPECT_NEAR(both / 2500.0, 0.0, 5.0 * 4.0 / 50.0);
}

TEST(FlightFault, ScaleMultipliesTheReading) {
  const Pair pair = fly_with(FlightFaultKind::scale, 0.05, quiet());
  expect_reading(pair, 1e-11, [](std::size_t, std::size_t, double y) { return 1.05 * y; });
}

TEST(FlightFault, SkewReadsAnotherInstant) {
  for (const int rows : {-10, 7}) {
    const Pair pair = fly_with(FlightFaultKind::skew, rows * 1e-3, quiet());
    for (std::size_t k = kOnset; k < 3990; ++k) {
      const auto then = static_cast<std::size_t>(static_cast<int>(k) + rows);
      ASSERT_NEAR(pair.faulty[k].reading_mps2[kFaulty], pair.healthy[then].reading_mps2[kFaulty], 1e-7);
    }
  }
}

TEST(FlightFault, DriftGrowsWithTime) {
  const Pair pair = fly_with(FlightFaultKind::drift, 0.3);
  expect_reading(pair, 1e-12, [](std::size_t k, std::size_t, double y) {
    return y + 0.3 * (static_cast<double>(k) - kOnset) * 1e-3;
  });
}

TEST(FlightFault, OscillationIsASineFromItsOnset) {
  const Pair pair = fly_with(FlightFaultKind::oscillation, 1.5);
  expect_reading(pair, 1e-10, [](std::size_t k, std::size_t, double y) {
    return y + 1.5 * std::sin(2.0 * kPi * 10.0 * (static_cast<double>(k) - kOnset) * 1e-3);
  });
}

TEST(FlightFault, ASaturatedSensorStandsAtFullScale) {
  for (const double sign : {-1.0, 1.0}) {
    const Pair pair = fly_with(FlightFaultKind::saturated, sign);
    expect_reading(pair, 0.0, [&](std::size_t, std::size_t, double) { return sign * 100.0 * kG0_mps2; });
  }
}

TEST(FlightFault, FaultsOfOneSensorActInTheirOrder) {
  FlightSpec spec = quiet();
  const FlightFault dead = {FlightFaultKind::dead, SensorSet::of(0), 0.0, 0.0, 10.0};
  const FlightFault bias = {FlightFaultKind::bias, SensorSet::of(0), 2.0, 0.5, 10.0};
  spec.faults = {dead, bias};
  const double own = Flight(spec).errors()[0].bias_mps2;
  const auto samples = fly(spec, 1000);
  EXPECT_EQ(samples[499].reading_mps2[0], own);
  EXPECT_EQ(samples[500].reading_mps2[0], own + 2.0);
  spec.faults = {bias, dead};
  EXPECT_EQ(fly(spec, 1000)[500].reading_mps2[0], own);
}

/// Gyro 1 of two with a fault from 1.5 s on; nothing else may differ.
void expect_gyro(GyroFaultKind kind, double size,
                 const std::function<Vec3(const Vec3&, const Vec3&, const Vec3&)>& expected) {
  FlightSpec spec = quiet();
  spec.gyros = 2;
  spec.gyro_noise_radps = 0.0;
  const auto healthy = fly(spec, 3000);
  spec.gyro_faults = {{kind, 1, size, 1.5}};
  const auto faulty = fly(spec, 3000);
  const Vec3 bias = Flight(spec).gyro_errors()[1].bias_radps;
  for (std::size_t k = 0; k < 3000; ++k) {
    FlightSample mended = faulty[k];
    if (k >= kOnset) mended.rate_radps[1] = healthy[k].rate_radps[1];
    ASSERT_TRUE(same_bits(healthy[k], mended)) << k;
    if (k < kOnset) continue;
    const Vec3 x = expected(healthy[k].rate_radps[1], healthy[kOnset - 1].rate_radps[1], bias);
    ASSERT_LT(norm(minus(faulty[k].rate_radps[1], x)), 1e-14) << k;
  }
}

TEST(FlightFault, EachFaultOfAGyroDoesWhatItSays) {
  expect_gyro(GyroFaultKind::dead, 0.0, [](const Vec3&, const Vec3&, const Vec3& bias) { return bias; });
  expect_gyro(GyroFaultKind::stuck, 0.0, [](const Vec3&, const Vec3& last, const Vec3&) { return last; });
  expect_gyro(GyroFaultKind::scale, -0.2, [](const Vec3& w, const Vec3&, const Vec3&) { return scaled(w, 0.8); });
  expect_gyro(GyroFaultKind::bias, 0.1, [](const Vec3& w, const Vec3&, const Vec3&) {
    return plus(w, {0.1, 0.1, 0.1});
  });
}

}  // namespace
}  // namespace flight_test
}  // namespace scenario
}  // namespace plumb
