/// Time, readings and silence: what happens to a sample before any evidence.
#include "plumb/health/detail/intake.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/simulated_tool.hpp"

// Serves: REQ-146

namespace intake_test {
namespace {

using namespace plumb;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(SampleClock, TakesIncreasingTimeAndNamesGaps) {
  SampleClock clock;
  EXPECT_EQ(clock.admit(100.0, 5.0), Arrival::in_order) << "the first sample starts the clock";
  EXPECT_EQ(clock.admit(105.0, 5.0), Arrival::in_order);
  EXPECT_EQ(clock.admit(110.1, 5.0), Arrival::after_gap);
  EXPECT_EQ(clock.admit(110.1, 5.0), Arrival::refused);
  EXPECT_EQ(clock.admit(kNan, 5.0), Arrival::refused);
  EXPECT_EQ(clock.admit(kInf, 5.0), Arrival::refused);
  EXPECT_EQ(clock.last_s(), 110.1);
  EXPECT_EQ(clock.admit(110.2, 5.0), Arrival::in_order);
}

TEST(SampleClock, AGlitchIsRefusedButANewTimeBaseIsNot) {
  SampleClock clock;
  clock.admit(1000.0, 5.0);
  for (int k = 0; k < 40; ++k) EXPECT_EQ(clock.admit(5.0, 5.0), Arrival::refused) << "the same time again is no base";
  for (int k = 0; k < 14; ++k) EXPECT_EQ(clock.admit(6.0 + k, 5.0), Arrival::refused) << k;
  EXPECT_EQ(clock.admit(20.0, 5.0), Arrival::new_time_base);
  EXPECT_EQ(clock.admit(21.0, 5.0), Arrival::in_order);
}

TEST(ReadingsOf, AreClampedAndNeverNonFinite) {
  SensorModel model = plumb_test::identity_model(4);
  model.sensor[3].scale = {0.0, 0.0, 0.0, 0.0};
  Sample sample;
  sample.delivered = SensorSet::first(4);
  sample.raw[0] = 1e308;
  sample.raw[1] = -1e200;
  sample.raw[2] = 9.8;
  sample.raw[3] = 0.0;  // 0 / 0
  sample.temperature_degc = kNan;
  GateResult gate;
  gate.usable = sample.delivered;
  const Readings y = readings_of(model, sample, 30.0, gate);
  EXPECT_EQ(y[0], kReadingClamp_mps2);
  EXPECT_EQ(y[1], -kReadingClamp_mps2);
  EXPECT_EQ(y[2], 9.8);
  EXPECT_EQ(y[3], 0.0);
  EXPECT_EQ(gate.usable, SensorSet::first(3));
  EXPECT_EQ(gate.not_finite, SensorSet::of(3));
}

TEST(ReadingsOf, TheLastTemperatureStandsInForAMissingOne) {
  SensorModel model = plumb_test::identity_model(3);
  for (std::size_t k = 0; k < 3; ++k) model.sensor[k].bias = {0.0, 0.1, 0.0, 0.0};
  Sample sample;
  GateResult gate;
  gate.usable = sample.delivered = SensorSet::first(3);
  sample.temperature_degc = kInf;
  EXPECT_NEAR(readings_of(model, sample, 35.0, gate)[0], -1.0, 1e-12);
  sample.temperature_degc = 45.0;
  EXPECT_NEAR(readings_of(model, sample, 35.0, gate)[0], -2.0, 1e-12);
}

/// What is kept from the sample before saves work and changes no bit, whatever the temperatures do.
TEST(ReadingsOf, WhatIsKeptOfTheModelChangesNothing) {
  plumb_test::Noise noise(11);
  SensorModel model = plumb_test::identity_model(4);
  for (std::size_t k = 0; k < 4; ++k) {
    model.sensor[k].scale = {0.3, 1e-4 * noise.normal(), 1e-6 * noise.normal(), 1e-8 * noise.normal()};
    model.sensor[k].bias = {0.1 * noise.normal(), 1e-3 * noise.normal(), 1e-5 * noise.normal(), 0.0};
  }
  const double temperatures[] = {25.0, 25.0, 0.0, -0.0, 0.0, 80.5, kNan, 80.5, 25.0, kInf, -40.0};
  CoefficientsAt kept;
  for (int k = 0; k < 400; ++k) {
    Sample sample;
    sample.delivered = SensorSet::first(4);
    for (std::size_t a = 0; a < 4; ++a) sample.raw[a] = noise.normal();
    sample.temperature_degc = temperatures[k % 11];
    GateResult gate, fresh;
    gate.usable = fresh.usable = sample.delivered.without(k % 5);
    EXPECT_EQ(readings_of(model, kept, sample, 31.0, gate), readings_of(model, sample, 31.0, fresh)) << k;
    EXPECT_EQ(gate.usable, fresh.usable);
  }
}

TEST(ReadingsOf, AnotherModelIsTakenUpOnceTheOldOneIsForgotten) {
  SensorModel model = plumb_test::identity_model(3);
  Sample sample;
  sample.temperature_degc = 25.0;
  sample.raw = {6.0, 6.0, 6.0};
  GateResult gate;
  gate.usable = sample.delivered = SensorSet::first(3);
  CoefficientsAt kept;
  EXPECT_EQ(readings_of(model, kept, sample, 25.0, gate)[0], 6.0);
  model.sensor[0].scale[0] = 2.0;
  EXPECT_EQ(readings_of(model, kept, sample, 25.0, gate)[0], 6.0) << "kept: nobody said that the model has changed";
  kept.forget();
  EXPECT_EQ(readings_of(model, kept, sample, 25.0, gate)[0], 3.0);
}

TEST(SilenceCounter, FindsChannelsThatAreSilentBlockAfterBlock) {
  SilenceCounter counter;
  const SensorSet others = SensorSet::first(4).without(1);
  EXPECT_TRUE(counter.note(others, 4, 3).empty());
  EXPECT_TRUE(counter.note(others, 4, 3).empty());
  EXPECT_EQ(counter.note(others, 4, 3), SensorSet::of(1));
  EXPECT_EQ(counter.note(others, 4, 3), SensorSet::of(1));
  EXPECT_TRUE(counter.note(SensorSet::first(4), 4, 3).empty()) << "one block with it, and the count starts anew";
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(counter.note({}, 4, 3).empty()) << "all silent at once is a gap of the bus";
}

}  // namespace
}  // namespace intake_test
