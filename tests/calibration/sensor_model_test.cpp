/// Eqs (1)-(3) with numbers worked by hand, and their inverse.
#include "plumb/calibration/sensor_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "calibration/bench.hpp"

namespace sensor_model_test {
namespace {

using namespace calibration_test;

/// Three sensors, numbers chosen so that every term of the cubics counts.
plumb::SensorModel worked_example() {
  plumb::SensorModel m;
  m.size = 3;
  m.sensor[0] = {{2.0, 0.1, 0.01, 0.001}, {0.5, -0.02, 0.003, -0.0004}, 20.0};
  m.sensor[1] = {{-4.0, 0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, 20.0};
  m.sensor[2] = {{1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}, 20.0};
  return m;
}

// Negative: REQ-003
TEST(SensorModel, ScaleAndBiasAreCubicInTemperature) {
  const plumb::SensorModel m = worked_example();
  // t = 10: 2 + 1 + 1 + 1 = 5 and 0.5 - 0.2 + 0.3 - 0.4 = 0.2.
  EXPECT_NEAR(m.scale_at(0, 30.0), 5.0, 1e-14);
  EXPECT_NEAR(m.bias_at(0, 30.0), 0.2, 1e-14);
  // t = -10: 2 - 1 + 1 - 1 = 1 and 0.5 + 0.2 + 0.3 + 0.4 = 1.4.
  EXPECT_NEAR(m.scale_at(0, 10.0), 1.0, 1e-14);
  EXPECT_NEAR(m.bias_at(0, 10.0), 1.4, 1e-14);
  EXPECT_EQ(m.scale_at(0, 20.0), 2.0);
  EXPECT_EQ(m.bias_at(0, 20.0), 0.5);
}

// Negative: REQ-003
TEST(SensorModel, AppliesCrossAxisTermsOfEquationThree) {
  plumb::SensorModel m = worked_example();
  m.misalignment[0 * plumb::kCapacity + 1] = 0.1;
  m.misalignment[1 * plumb::kCapacity + 2] = -0.5;
  m.misalignment[2 * plumb::kCapacity + 2] = 0.25;
  std::array<double, plumb::kCapacity> raw{};
  raw[0] = 11.0;  // 11 / 5 - 0.2 = 2
  raw[1] = -8.0;  // -8 / -4 - 1 = 1
  raw[2] = 4.0;   // 4
  const plumb::SensorSet all = plumb::SensorSet::first(3);
  const plumb::Readings a = m.apply(raw, 30.0, all);
  EXPECT_NEAR(a[0], 2.0 - 0.1 * 1.0, 1e-14);
  EXPECT_NEAR(a[1], 1.0 + 0.5 * 4.0, 1e-14);
  EXPECT_NEAR(a[2], 4.0 - 0.25 * 4.0, 1e-14);
  m.reads = plumb::Reads::specific_force;
  const plumb::Readings mirrored = m.apply(raw, 30.0, all);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(mirrored[at(i)], -a[at(i)]);
}

TEST(SensorModel, ChannelsThatDidNotDeliverEnterNothing) {
  plumb::SensorModel m = worked_example();
  m.misalignment[0 * plumb::kCapacity + 1] = 0.1;
  std::array<double, plumb::kCapacity> raw{};
  raw[0] = 11.0;
  raw[1] = std::numeric_limits<double>::quiet_NaN();
  raw[2] = 4.0;
  const plumb::Readings a = m.apply(raw, 30.0, plumb::SensorSet::first(3).without(1));
  EXPECT_NEAR(a[0], 2.0, 1e-14);
  EXPECT_EQ(a[1], 0.0);
  EXPECT_EQ(a[2], 4.0);
}

// Negative: REQ-036
TEST(SensorModel, WithoutCrossTermsABrokenChannelLeaksNowhere) {
  const plumb::SensorModel m = worked_example();
  std::array<double, plumb::kCapacity> raw{};
  raw[0] = std::numeric_limits<double>::infinity();
  raw[1] = -8.0;
  raw[2] = std::numeric_limits<double>::quiet_NaN();
  const plumb::Readings a = m.apply(raw, 20.0, plumb::SensorSet::first(3));
  EXPECT_FALSE(std::isfinite(a[0]));
  EXPECT_EQ(a[1], 1.0);
  EXPECT_FALSE(std::isfinite(a[2]));
}

TEST(SensorModel, RawFromIsTheInverseOfApply) {
  calibration_test::Noise noise(7);
  for (int trial = 0; trial < 200; ++trial) {
    plumb::SensorModel m;
    m.size = 3 + trial % (plumb::kCapacity - 2);
    m.reads = trial % 2 == 0 ? plumb::Reads::gravity : plumb::Reads::specific_force;
    plumb::Readings asked{};
    for (int i = 0; i < m.size; ++i) {
      m.sensor[at(i)] = {
          {noise.within(1.0) < 0 ? -3.0 : 2.0, 1e-3, 1e-5, 1e-7}, {noise.within(1.0), 1e-2, 1e-4, 1e-6}, 20.0};
      asked[at(i)] = noise.within(10.0);
      for (int k = 0; k < m.size; ++k) m.misalignment[at(i * plumb::kCapacity + k)] = noise.within(0.03);
    }
    const double t = 20.0 + noise.within(60.0);
    const auto raw = m.raw_from(asked, t);
    ASSERT_TRUE(raw.has_value());
    const plumb::Readings back = m.apply(*raw, t, plumb::SensorSet::first(m.size));
    for (int i = 0; i < m.size; ++i) EXPECT_NEAR(back[at(i)], asked[at(i)], 1e-12);
  }
}

TEST(SensorModel, RawFromNeedsRowExchangesAndRefusesASingularCrossMatrix) {
  plumb::SensorModel m;
  m.size = 3;
  // I - M = [[0,1,0],[1,0,0],[0,0,1]]: no pivot on the diagonal, yet regular.
  m.misalignment[0] = 1.0;
  m.misalignment[1] = -1.0;
  m.misalignment[at(plumb::kCapacity)] = -1.0;
  m.misalignment[at(plumb::kCapacity) + 1] = 1.0;
  plumb::Readings a{};
  a[0] = 1.0;
  a[1] = 2.0;
  a[2] = 3.0;
  const auto raw = m.raw_from(a, 25.0);
  ASSERT_TRUE(raw.has_value());
  EXPECT_EQ((*raw)[0], 2.0);
  EXPECT_EQ((*raw)[1], 1.0);
  EXPECT_EQ((*raw)[2], 3.0);
  m.misalignment[1] = 0.0;  // row 0 of I - M is now zero
  const auto none = m.raw_from(a, 25.0);
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, plumb::Errc::not_invertible);
  m.misalignment[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(m.raw_from(a, 25.0).has_value());
}

TEST(Datasheet, YieldsItsModelAndItsArray) {
  const plumb::Datasheet d = calibration_test::paper_tool(0.002, plumb::Reads::specific_force);
  const plumb::SensorModel m = d.model();
  EXPECT_EQ(m.size, 4);
  EXPECT_EQ(m.reads, plumb::Reads::specific_force);
  EXPECT_EQ(m.sensor[3].scale, d.sensor[3].coefficients.scale);
  for (const double cross : m.misalignment) EXPECT_EQ(cross, 0.0);
  const auto array = d.array();
  ASSERT_TRUE(array.has_value());
  EXPECT_EQ(array->size(), 4);
  plumb::Datasheet bad = d;
  bad.sensor[2].row.axis = {1.0, 1.0, 0.0};
  ASSERT_FALSE(bad.array().has_value());
  EXPECT_EQ(bad.array().error().code, plumb::Errc::axis_not_unit);
  bad = d;
  bad.size = plumb::kCapacity + 1;
  ASSERT_FALSE(bad.array().has_value());
  EXPECT_EQ(bad.array().error().code, plumb::Errc::too_many_sensors);
  bad.size = -1;
  EXPECT_FALSE(bad.array().has_value());
}

TEST(Datasheet, OfMoreSensorsThanFitReportsTheFirstAndIsNoArray) {
  Datasheet sheet = paper_tool(kBenchSigma);
  const RowUncertainty four = sheet.uncertainty();
  sheet.size = kCapacity + 5;
  const RowUncertainty all = sheet.uncertainty();
  for (int k = 0; k < RowUncertainty::packed_size(4); ++k) EXPECT_EQ(all.covariance[at(k)], four.covariance[at(k)]);
  EXPECT_EQ(sheet.array().error().code, Errc::too_many_sensors);
}

/// A cubic that passes through zero has no reading there.
TEST(SensorModel, WhereTheScaleVanishesThereIsNoReading) {
  SensorModel model;
  model.size = 1;
  model.sensor[0].scale = {1.0, -0.125, 0.0, 0.0};
  model.sensor[0].reference_degc = 20.0;
  EXPECT_TRUE(std::isnan(model.apply({1.0}, 28.0, SensorSet::first(1))[0]));
  EXPECT_EQ(model.apply({1.0}, 20.0, SensorSet::first(1))[0], 1.0);
}

}  // namespace
}  // namespace sensor_model_test
