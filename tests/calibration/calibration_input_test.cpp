// What `calibrate` takes: every number that may be wrong, options that leave no room, stations that do not count.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "calibration/bench.hpp"
#include "calibration/fit_scene.hpp"

namespace calibration_input_test {
namespace {

using namespace calibration_test;

constexpr double kSigma = kBenchSigma;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// Every number that a datasheet has, wrong on its own: refused, and the sensor is said where there is one.
// Negative: REQ-034
TEST(CalibrationInput, ADatasheetWithOneWrongNumberIsRefused) {
  const std::vector<std::function<void(Bench&)>> wrong = {
      [](Bench& b) { b.gravity.g_mps2 = 0.0; },
      [](Bench& b) { b.gravity.g_mps2 = -9.8; },
      [](Bench& b) { b.gravity.g_mps2 = kInf; },
      [](Bench& b) { b.sheet.sensor[1].prior.bias_mps2 = -1.0; },
      [](Bench& b) { b.sheet.sensor[1].prior.axis_rad = -1.0; },
      [](Bench& b) { b.sheet.sensor[1].prior.axis_rad = kNan; },
      [](Bench& b) { b.sheet.sensor[1].prior.bias_mps2 = kInf; },
      [](Bench& b) { b.sheet.sensor[1].row.sigma_mps2 = kInf; },
      [](Bench& b) { b.sheet.sensor[1].row.sigma_mps2 = 0.0; },
      [](Bench& b) {
        b.sheet.sensor[1].row.axis = {0.0, 0.0, 1.1};
      },
      [](Bench& b) { b.sheet.sensor[1].row.id = {}; },
      [](Bench& b) { b.sheet.sensor[1].coefficients.scale[0] = kInf; },
      [](Bench& b) { b.sheet.size = 2; },
      [](Bench& b) { b.sheet.size = kCapacity + 1; },
  };
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    Bench b;
    wrong[k](b);
    EXPECT_NE(b.refusal(), Errc::ok) << k;
  }
}

/// A name that fills its room to the last character is cut there, and no fault.
TEST(CalibrationInput, ANameWithoutAnEndIsCut) {
  Bench b;
  b.sheet.sensor[2].row.id.fill('x');
  const auto c = b.run();
  ASSERT_TRUE(c.has_value());
  EXPECT_STREQ(c->array.row(2).id.data(), std::string(15, 'x').c_str());
}

TEST(CalibrationInput, AFitThatNeverSettlesEndsAllTheSame) {
  Bench b(1, 12);
  b.options.stop_relative = -1.0;
  b.options.max_iterations = std::numeric_limits<int>::max();
  EXPECT_EQ(b.refusal(), Errc::diverged);
}

TEST(CalibrationInput, WithoutFreedomNothingIsJudgedByTheResiduals) {
  Bench b(1, 3);
  b.options.require_full_rank = false;
  b.options.estimate_misfit = false;
  const auto c = b.run();
  EXPECT_LE(b.report.degrees_of_freedom, 0);
  EXPECT_EQ(b.report.p_value, 1.0);
  EXPECT_TRUE(c.has_value()) << describe(c.error().code);
  for (int k = 0; k < b.report.parameters; ++k) EXPECT_TRUE(std::isfinite(b.report.sigma[at(k)])) << k;
}

TEST(CalibrationInput, ABoundOfZeroAllowsNoDeviation) {
  Bench scale;
  scale.options.max_scale_change = 0.0;
  EXPECT_EQ(scale.refusal(), Errc::implausible);
  Bench axis;
  axis.options.max_axis_change_rad = 0.0;
  EXPECT_EQ(axis.refusal(), Errc::implausible);
}

TEST(CalibrationInput, AScatterBeyondAllBoundsIsNoFigure) {
  Bench b;
  for (Station& s : b.stations) {
    s.count = 4;
    s.scatter.fill(1e200);
  }
  b.run();
  for (const double noise : b.report.sample_noise_mps2) EXPECT_EQ(noise, 0.0);
}

/// The first sensor is the noisiest: those after it do not take its place.
TEST(CalibrationInput, TheNoisiestSampleNamesTheSensor) {
  Bench b;
  Noise loud(3);
  for (Station& s : b.stations) {
    s.count = 16;
    const double per_mps2 = 3.0 / kG0_mps2;
    s.scatter.fill(8.0 * kSigma * per_mps2);
    s.scatter[0] = 20.0 * kSigma * per_mps2;
    for (int i = 0; i < 4; ++i) s.mean[at(i)] += 10.0 * kSigma * per_mps2 * loud.normal();
  }
  const auto c = b.run();
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, Errc::poor_fit);
  EXPECT_EQ(c.error().index, 0);
}

/// A station without samples beside a sensor that is loud: it is passed over.
TEST(CalibrationInput, AStationWithoutSamplesCountsNowhere) {
  Bench b;
  Noise loud(3);
  for (Station& s : b.stations) s.mean[1] += 40.0 * kSigma * 3.0 / kG0_mps2 * loud.normal();
  b.options.max_sensor_excess = 1e9;
  b.options.max_norm_rms_mps2 = 1.0;
  b.options.reject_outliers = false;
  b.run();
  const FitReport without = b.report;
  ASSERT_EQ(without.high_variance_sensor, 1);
  b.stations.push_back(b.stations[0]);
  b.stations.back().count = 0;
  b.stations.back().roll_group = 4;
  b.run();
  EXPECT_EQ(b.report.stations, without.stations);
  EXPECT_EQ(b.report.high_variance_sensor, 1);
  EXPECT_NEAR(b.report.loud_misfit_mps2, without.loud_misfit_mps2, 1e-9);
  EXPECT_EQ(b.report.roll_groups, 0);
}

/// Channels swapped, and a station that one of them does not deliver: that one tells nothing of twins.
TEST(CalibrationInput, TwinsAreLookedForWhereBothDeliver) {
  Bench b;
  for (Station& s : b.stations) s.mean[1] = s.mean[0];
  b.stations[3].count = 0;
  b.stations[4].delivered = SensorSet::first(4).without(3);
  EXPECT_EQ(b.refusal(), Errc::implausible);
}

/// A perfect tool whose noise is far above what is open of it: residuals of nothing, with freedom to spare.
TEST(CalibrationInput, ResidualsOfNothingAreNoMisfit) {
  Scene s;
  for (int i = 0; i < 3; ++i) s.sheet.sensor[at(i)].row.sigma_mps2 = 1000.0;
  s.options.require_full_rank = false;
  FitReport report;
  calibrate(s.sheet, {10.0, 0.0, GravityModel::value}, s.stations.data(), 6, s.options, &report);
  EXPECT_EQ(report.chi2, 0.0);
  EXPECT_EQ(report.misfit_mps2, 0.0);
  EXPECT_EQ(report.stop, StopReason::converged);
}

}  // namespace
}  // namespace calibration_input_test
