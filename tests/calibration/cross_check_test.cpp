// What a calibration predicts of other stations, and which sensor stands out where it is left out.
#include "plumb/calibration/cross_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "calibration/bench.hpp"

namespace cross_check_test {
namespace {

using namespace calibration_test;

constexpr double kSigma = kBenchSigma;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(CrossCheck, AStationThatCannotBePredictedIsNotJudged) {
  Bench b;
  auto fit = b.run();
  ASSERT_TRUE(fit.has_value());
  Station empty = b.stations[0];
  empty.count = 0;
  EXPECT_FALSE(predict(*fit, b.gravity, empty).judged);
  Station endless = b.stations[0];
  endless.mean[0] = 1e308;
  endless.mean[1] = 1e308;
  EXPECT_FALSE(predict(*fit, b.gravity, endless).judged);
  for (SensorCoefficients& c : fit->model.sensor) c.bias = {};
  Station nothing = b.stations[0];
  nothing.mean.fill(0.0);
  EXPECT_FALSE(predict(*fit, b.gravity, nothing).judged);
}

TEST(CrossCheck, ASensorThatDidNotDeliverIsNotInTheParity) {
  AxisList axes{};
  const int n = cone(axes, 5);
  Bench b;
  b.sheet = datasheet_of(axes, n, kSigma);
  b.truth = draw_truth(b.sheet, b.noise);
  b.stations = random_stations(b.sheet, b.truth, 48, b.noise, kSigma);
  const auto fit = b.run();
  ASSERT_TRUE(fit.has_value());
  Station four = b.stations[0];
  four.delivered = four.delivered.without(2);
  four.mean[2] = kNan;
  const StationPrediction p = predict(*fit, b.gravity, four);
  EXPECT_TRUE(p.judged);
  EXPECT_LT(p.sigmas, 5.0);
  EXPECT_TRUE(std::isfinite(station_residual(*fit, b.gravity, four).norm_error_mps2));
}

TEST(StationResidual, OfNoSamplesOrNoNumberIsNothing) {
  Bench b;
  const auto fit = b.run();
  ASSERT_TRUE(fit.has_value());
  Station empty = b.stations[0];
  empty.count = 0;
  EXPECT_EQ(station_residual(*fit, b.gravity, empty).norm_error_mps2, 0.0);
  Station none = b.stations[0];
  none.mean[1] = kNan;
  EXPECT_EQ(station_residual(*fit, b.gravity, none).norm_error_mps2, 0.0);
}

TEST(CrossCheck, PlansLargerThanTheStationsEnd) {
  Bench b;
  std::vector<Station> scratch(b.stations.size());
  const auto held = [&](int count, int folds, int rounds) {
    HoldOutPlan plan;
    plan.folds = folds;
    plan.rounds = rounds;
    return hold_out(b.sheet, b.gravity, b.stations.data(), count, plan, {}, scratch.data());
  };
  EXPECT_EQ(held(0, 4, 4).judged, 0);
  EXPECT_EQ(held(2, 4, 4).judged, 0);
  EXPECT_EQ(held(2, 4, 4).not_judged, 2);
  EXPECT_EQ(odd_sensor(b.sheet, b.gravity, nullptr, 48, {}, scratch.data()).sensor, -1);
  EXPECT_EQ(odd_sensor(b.sheet, b.gravity, b.stations.data(), 2, {}, scratch.data()).sensor, -1);
}

/// Nobody stands out where every fit leaves its bounds, where none is left, or where only one can be made.
TEST(OddSensor, WithoutASecondSensorNoneStandsOut) {
  Bench b;
  std::vector<Station> scratch(b.stations.size());
  FitOptions strict;
  strict.max_bias_sigmas = 1e-6;
  EXPECT_EQ(odd_sensor(b.sheet, b.gravity, b.stations.data(), b.count(), strict, scratch.data()).sensor, -1);
  AxisList axes{};
  Bench three;
  three.sheet = datasheet_of(axes, orthogonal_triad(axes), kSigma);
  three.truth = draw_truth(three.sheet, three.noise);
  three.stations = random_stations(three.sheet, three.truth, 48, three.noise, kSigma);
  EXPECT_EQ(odd_sensor(three.sheet, three.gravity, three.stations.data(), 48, {}, scratch.data()).sensor, -1);
  Bench lone;
  for (int k = 0; k < lone.count(); ++k) {
    if (k % 8 != 0) lone.stations[at(k)].delivered = SensorSet::first(3);
  }
  EXPECT_EQ(odd_sensor(lone.sheet, lone.gravity, lone.stations.data(), lone.count(), {}, scratch.data()).sensor, -1);
}

/// Readings whose squares are no numbers predict nothing.
TEST(CrossCheck, AVectorBeyondAllNumbersIsNotPredicted) {
  Bench b;
  const auto fit = b.run();
  ASSERT_TRUE(fit.has_value());
  Station endless = b.stations[0];
  EXPECT_TRUE(predict(*fit, b.gravity, endless).judged);
  for (double& raw : endless.mean) raw *= 1e200;
  EXPECT_FALSE(predict(*fit, b.gravity, endless).judged);
}

/// Five axes along three lines and readings without an error: who is left out changes nothing, and nobody is odd.
TEST(OddSensor, WhereEveryFitIsPerfectNoSensorStandsOut) {
  AxisList axes{};
  for (int i = 0; i < 5; ++i) axes[at(i)][at(i % 3)] = i < 3 ? 1.0 : -1.0;
  Datasheet sheet = datasheet_of(axes, 5, 1.0);
  for (DatasheetSensor& s : sheet.sensor) {
    s.coefficients = {};
    s.coefficients.scale[0] = 1.0;
  }
  std::vector<Station> stations;
  const GravityReference gravity = {10.0, 0.0, GravityModel::value};
  const Vec3 directions[] = {{10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {6, 8, 0}, {8, 0, 6}, {0, 6, 8}};
  for (const Vec3& u : directions) {
    for (const double hand : {1.0, -1.0}) {
      Station s;
      s.delivered = SensorSet::first(5);
      s.temperature_degc = 25.0;
      s.count = 1;
      for (int i = 0; i < 5; ++i) s.mean[at(i)] = hand * dot(axes[at(i)], u);
      for (int again = 0; again < 4; ++again) stations.push_back(s);
    }
  }
  std::vector<Station> scratch(stations.size());
  const OddSensor odd =
      odd_sensor(sheet, gravity, stations.data(), static_cast<int>(stations.size()), {}, scratch.data());
  EXPECT_EQ(odd.sensor, -1);
  EXPECT_EQ(odd.ratio, 1.0);
}

}  // namespace
}  // namespace cross_check_test
