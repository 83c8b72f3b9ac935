// What of a data sheet flies: whatever it states, errors stay within its bounds, and a log says what was felt.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "plumb/session/flight_sheet.hpp"

namespace flight_sheet_test {
namespace {

using namespace plumb;

/// A draw from whole numbers, so that a counterexample shrinks to a readable one.
double drawn(int least, int most, double unit) { return unit * *rc::gen::inRange(least, most + 1); }

Datasheet sheet_of(Reads reads, double scale, double bias_mps2, double resolution_raw) {
  Datasheet out;
  out.size = 4;
  out.reads = reads;
  for (int i = 0; i < out.size; ++i) {
    DatasheetSensor& sensor = out.sensor[static_cast<std::size_t>(i)];
    sensor.coefficients.scale[0] = scale;
    sensor.coefficients.bias[0] = bias_mps2;
    sensor.resolution_raw = resolution_raw;
    sensor.full_scale_raw = 200.0 * std::fabs(scale) * (1 + i);
  }
  return out;
}

RC_GTEST_PROP(FlightSheetLaw, ErrorsStayWithinTheBounds, ()) {
  const MotionErrors least = {drawn(0, 100, 1e-4), drawn(0, 1000, 1e-6), drawn(0, 100, 1e-6),
                              drawn(0, 100, 1e-3), drawn(0, 100, 1e-3),  drawn(0, 100, 1e-2)};
  const GyroErrors gyro = {drawn(0, 100, 1e-3), drawn(0, 100, 1e-3), drawn(0, 100, 1e-3), 0.0, drawn(0, 1000, 1e-6)};
  const double bandwidth_hz = drawn(10, 1000, 1.0);
  const scenario::FlightErrorBox box = session::flight_errors_within(least, gyro, bandwidth_hz);
  constexpr double kRounding = 1.0 + 1e-12;
  // sqrt(2) / (2 pi f): by so much a filter of bandwidth f delays.
  const double delay_s = std::sqrt(2.0) / (2.0 * 3.141592653589793 * bandwidth_hz);
  RC_ASSERT(std::hypot(box.axis_rad, box.axis_rad) <= least.axis_rad * kRounding);
  RC_ASSERT(box.skew_s + box.bandwidth * delay_s <= least.lag_s * kRounding);
  RC_ASSERT(box.gyro_skew_s + box.gyro_bandwidth * delay_s <= gyro.lag_s * kRounding);
  RC_ASSERT(std::sqrt(3.0) * box.gyro_bias_radps <= gyro.bias_radps * kRounding);
  RC_ASSERT(2.0 * box.gyro_axis_rad <= gyro.axis_rad * kRounding);
  RC_ASSERT(2.0 * box.rectification <= least.rectification * kRounding);
  RC_ASSERT(box.scale == least.scale && box.bias_mps2 == least.bias_mps2 && box.lever_m == least.lever_m);
  RC_ASSERT(box.gyro_scale == gyro.scale);
}

RC_GTEST_PROP(FlightSheetLaw, ALogSaysWhatWasFelt, ()) {
  const Reads reads = *rc::gen::element(Reads::gravity, Reads::specific_force);
  const double scale = drawn(1, 1000, 0.01) * (*rc::gen::arbitrary<bool>() ? 1.0 : -1.0);
  const double resolution_raw = drawn(0, 10, 0.001);
  const Datasheet sheet = sheet_of(reads, scale, drawn(-100, 100, 0.01), resolution_raw);
  const SensorModel model = sheet.model();
  scenario::FlightSample flown;
  flown.time_s = 0.25;
  for (double& one : flown.reading_mps2) one = drawn(-15000, 15000, 0.01);
  const Sample sample = session::flight_sample(sheet, model, 25.0, flown);
  RC_ASSERT(sample.time_s == flown.time_s && sample.delivered == SensorSet::first(sheet.size));
  const Readings down = model.without_misalignment(sample.raw, 25.0, sample.delivered);
  const double code_mps2 = resolution_raw / std::fabs(scale);
  for (std::size_t i = 0; i < static_cast<std::size_t>(sheet.size); ++i)
    RC_ASSERT(std::fabs(down[i] + flown.reading_mps2[i]) <= 0.5 * code_mps2 + 1e-9);
}

TEST(FlightSheet, TheSmallestFullScaleCounts) {
  Datasheet sheet = sheet_of(Reads::gravity, 0.5, 3.0, 0.0);
  EXPECT_DOUBLE_EQ(session::flight_full_scale_mps2(sheet, 7.0), 197.0);
  sheet.sensor[0].full_scale_raw = 0.0;  // not stated
  EXPECT_DOUBLE_EQ(session::flight_full_scale_mps2(sheet, 7.0), 397.0);
  for (DatasheetSensor& sensor : sheet.sensor) sensor.full_scale_raw = 0.0;
  EXPECT_EQ(session::flight_full_scale_mps2(sheet, 7.0), 7.0);
}

}  // namespace
}  // namespace flight_sheet_test
