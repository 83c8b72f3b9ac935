#include "plumb/scenario/flight.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <stdexcept>

#include "flight_specs.hpp"

namespace plumb {
namespace scenario {
namespace flight_test {
namespace {

/// What stands at the sensor beside the specific force at the reference point.
double lever_term(const FlightSpec& spec, std::size_t i, const FlightSample& s) {
  const Vec3& r = spec.lever_arm_m[i];
  const Vec3& w = s.true_rate_radps;
  return dot(spec.axis[i], plus(cross(s.true_angular_acceleration_radps2, r), cross(w, cross(w, r))));
}

/// Largest difference between lever-corrected readings and the true specific force.
double worst_remainder(const FlightSpec& spec, int samples) {
  double worst = 0.0;
  for (const FlightSample& s : fly(spec, samples)) {
    for (std::size_t i = 0; i < spec.axis.size(); ++i) {
      const double expected = dot(spec.axis[i], s.specific_force_mps2);
      worst = std::max(worst, std::abs(s.reading_mps2[i] - lever_term(spec, i, s) - expected));
    }
  }
  return worst;
}

// What is left is that the filtered product of two rates is not the product of the filtered ones. With vibration: r |w|
// times the 3 deg/s of the angular vibration, and of that what the filter's delay differs between w and a tone.
RC_GTEST_PROP(FlightLaw, WithoutErrorsTheLeverCorrectedReadingsAreTheSpecificForce, ()) {
  FlightSpec spec = perfect_spec(kKinds[*rc::gen::inRange<std::size_t>(0, 4)], *rc::gen::arbitrary<std::uint64_t>());
  RC_ASSERT(worst_remainder(spec, 2500) < 1e-4);
  spec.vibration = 0.0;
  RC_ASSERT(worst_remainder(spec, 2500) < 5e-6);
}

RC_GTEST_PROP(FlightLaw, AngularAccelerationIntegratesToTheRate, ()) {
  FlightSpec spec = perfect_spec(kKinds[*rc::gen::inRange<std::size_t>(0, 4)], *rc::gen::arbitrary<std::uint64_t>());
  spec.rate_hz = 5e3;  // for the trapezoids: a tone of 250 Hz loses 0.8 % between them
  Flight flight(spec);
  FlightSample last = flight.next();
  Vec3 sum = last.true_rate_radps;
  for (int k = 0; k < 12500; ++k) {
    const FlightSample now = flight.next();
    sum = plus(sum, scaled(plus(last.true_angular_acceleration_radps2, now.true_angular_acceleration_radps2), 1e-4));
    RC_ASSERT(norm(minus(sum, now.true_rate_radps)) < 2e-3);
    last = now;
  }
}

RC_GTEST_PROP(FlightLaw, SameSeedSameBitsOtherSeedOther, ()) {
  FlightSpec spec = spec_of(kKinds[*rc::gen::inRange<std::size_t>(0, 4)], *rc::gen::arbitrary<std::uint64_t>());
  spec.gyros = 2;
  Flight one(spec), again(spec);
  ++spec.seed;
  Flight other(spec);
  for (int k = 0; k < 2500; ++k) {
    const FlightSample a = one.next(), b = again.next(), c = other.next();
    RC_ASSERT(same_bits(a, b));
    RC_ASSERT(!same_bits(a, c));
  }
}

TEST(Flight, AnotherSensorChangesNoneOfTheOthers) {
  const auto seven = fly(spec_of(FlightKind::drone, 5, 7), 2000), eight = fly(spec_of(FlightKind::drone, 5, 8), 2000);
  for (std::size_t k = 0; k < seven.size(); ++k) {
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(seven[k].reading_mps2[i], eight[k].reading_mps2[i]);
    EXPECT_EQ(seven[k].reading_mps2[7], 0.0);
  }
}

/// FNV-1a over the bits of the numbers.
std::uint64_t fingerprint(const std::vector<FlightSample>& samples) {
  std::uint64_t hash = 14695981039346656037U;
  for (const FlightSample& s : samples) {
    std::array<unsigned char, sizeof s> bytes{};
    std::memcpy(bytes.data(), &s, sizeof s);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211U;
  }
  return hash;
}

// Results are recorded by seed: whoever changes these numbers changes what was recorded.
TEST(Flight, EverySeedFliesAsItAlwaysDid) {
  constexpr std::array<std::uint64_t, kFlightKinds> kRecorded = {2913308783737477080U, 16651354122686209768U,
                                                                 13077148308612015368U, 17918965756892914126U};
  constexpr std::array<std::uint64_t, kFlightKinds> kWithoutGyroLag = {2114072712472736064U, 17918570038180875934U,
                                                                       18071835853878958261U, 6863841180791398246U};
  for (std::size_t k = 0; k < kRecorded.size(); ++k) {
    FlightSpec spec = spec_of(kKinds[k], 2024);
    EXPECT_EQ(fingerprint(fly(spec, 4000)), kRecorded[k]) << to_string(kKinds[k]);
    spec.box.gyro_skew_s = spec.box.gyro_bandwidth = 0.0;
    EXPECT_EQ(fingerprint(fly(spec, 4000)), kWithoutGyroLag[k]) << to_string(kKinds[k]);
  }
}

TEST(Flight, TimesGoByTheRate) {
  FlightSpec spec = spec_of(FlightKind::car, 1);
  spec.rate_hz = 800.0;
  const auto samples = fly(spec, 801);
  EXPECT_EQ(samples.front().time_s, 0.0);
  EXPECT_EQ(samples.back().time_s, 1.0);
}

TEST(Flight, ReadingsAreClippedAtFullScale) {
  FlightSpec spec = spec_of(FlightKind::drone, 9);
  spec.full_scale_mps2 = kG0_mps2;
  int above = 0, below = 0;
  for (const FlightSample& s : fly(spec, 5000)) {
    for (const double x : s.reading_mps2) {
      ASSERT_LE(std::abs(x), kG0_mps2);
      above += x == kG0_mps2 ? 1 : 0;
      below += x == -kG0_mps2 ? 1 : 0;
    }
  }
  EXPECT_GT(above, 10);
  EXPECT_GT(below, 10);
}

TEST(Flight, RefusesWhatCannotFly) {
  const FlightSpec good = spec_of(FlightKind::car, 1);
  ASSERT_TRUE(check(good));
  ASSERT_TRUE(Flight::make(good));
  EXPECT_EQ(Flight::make(good)->next().reading_mps2, Flight(good).next().reading_mps2);
  const auto refused = [&](const std::function<void(FlightSpec&)>& spoil) {
    FlightSpec spec = good;
    spoil(spec);
    EXPECT_THROW(Flight{spec}, std::invalid_argument);
    const auto made = Flight::make(spec);
    EXPECT_EQ(made ? "" : made.error(), check(spec) ? "" : check(spec).error());
    return !check(spec).has_value();
  };
  EXPECT_TRUE(refused([](FlightSpec& s) { s.axis.clear(); }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.axis.resize(25, {1.0, 0.0, 0.0}); }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.axis[0] = {1.0, 1.0, 0.0}; }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.lever_arm_m.pop_back(); }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.lever_arm_m[1][2] = std::nan(""); }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.rate_hz = 100.0; }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.bandwidth_hz = 2000.0; }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.full_scale_mps2 = 0.0; }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.noise_mps2 = -1.0; }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.vibration = std::nan(""); }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.gyros = 3; }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.box.skew_s = 0.06; }));
  EXPECT_TRUE(refused([](FlightSpec& s) { s.box.axis_rad = -1e-3; }));
  const auto with = [&](FlightFaultKind kind, SensorSet sensors, double size) {
    return refused([&](FlightSpec& s) { s.faults = {{kind, sensors, size, 0.0, 10.0}}; });
  };
  EXPECT_TRUE(with(FlightFaultKind::bias, SensorSet(), 1.0));
  EXPECT_TRUE(with(FlightFaultKind::bias, SensorSet::of(8), 1.0));
  EXPECT_TRUE(with(FlightFaultKind::bias, SensorSet::of(1), std::nan("")));
  EXPECT_TRUE(with(FlightFaultKind::noise, SensorSet::of(1), -1.0));
  EXPECT_TRUE(with(FlightFaultKind::skew, SensorSet::of(1), -0.051));
  EXPECT_FALSE(check([&] {
                 FlightSpec s = good;
                 s.faults = {{FlightFaultKind::oscillation, SensorSet::of(1), 1.0, 0.0, 0.0}};
                 return s;
               }())
                   .has_value());
  EXPECT_TRUE(refused([](FlightSpec& s) { s.gyro_faults = {{GyroFaultKind::dead, 1, 0.0, 0.0}}; }));
}

}  // namespace
}  // namespace flight_test
}  // namespace scenario
}  // namespace plumb
