// What the fit over temperature takes: options, priors and stations that are none, and too few of them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "calibration/temperature_support.hpp"

namespace temperature_input_test {
namespace {

using namespace temperature_test;
using plumb::Errc;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Bench {
  explicit Bench(std::uint64_t seed = 81) : noise(seed) {}
  plumb::Datasheet sheet = paper_sheet();
  Noise noise;
  Truth truth = temperature_test::draw_truth(sheet, noise);
  std::vector<plumb::Station> on(int levels) { return on_levels(truth, levels_of(levels), noise); }
};

/// On three levels.
struct Scene : Bench {
  Scene() : Bench(91) {}
  std::vector<plumb::Station> stations = on(3);
  std::vector<plumb::Station> scratch = stations;
  std::unique_ptr<plumb::TemperatureWork> work = std::make_unique<plumb::TemperatureWork>();
  int count() const { return static_cast<int>(stations.size()); }
};

TEST(TemperatureInput, OptionsAndPriorsThatAreNoneAreRefused) {
  Bench b;
  const auto stations = b.on(4);
  plumb::TemperatureOptions options = options_of(plumb::kAutomaticOrder);
  for (const int order : {-1, plumb::kMaxTemperatureOrder + 1}) {
    options.max_order = order;
    EXPECT_EQ(fit_of(b.sheet, stations, options).made.error().code, Errc::out_of_range) << order;
  }
  const std::vector<std::function<void(plumb::Prior&)>> wrong = {
      [](plumb::Prior& p) { p.bias_mps2 = 0.0; },      [](plumb::Prior& p) { p.scale = 0.0; },
      [](plumb::Prior& p) { p.axis_rad = 0.0; },       [](plumb::Prior& p) { p.scale_t[0] = 0.0; },
      [](plumb::Prior& p) { p.scale_t[0] = kInf; },    [](plumb::Prior& p) { p.bias_t_mps2[0] = 0.0; },
      [](plumb::Prior& p) { p.bias_t_mps2[0] = kInf; }};
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    plumb::Datasheet sheet = b.sheet;
    wrong[k](sheet.sensor[1].prior);
    const Fit f = fit_of(sheet, stations, options_of(1));
    ASSERT_FALSE(f.made.has_value()) << k;
    EXPECT_EQ(f.made.error().code, Errc::out_of_range) << k;
    EXPECT_EQ(f.made.error().index, 4) << k;
  }
}

TEST(TemperatureInput, AnAutomaticOrderOfAtMostZeroIsTheFitWithoutTemperature) {
  Bench b;
  plumb::TemperatureOptions options = options_of(plumb::kAutomaticOrder);
  options.max_order = 0;
  options.fit.max_norm_rms_mps2 = 1.0;
  const Fit f = fit_of(b.sheet, b.on(1), options);
  ASSERT_TRUE(f.made.has_value());
  EXPECT_EQ(f.report.order, 0);
  EXPECT_EQ(f.report.missing, 0);
}

// Negative: REQ-034
TEST(TemperatureInput, WithoutStationsOrAnEndThereIsNoFit) {
  Bench b;
  Fit f;
  plumb::Station scratch;
  const auto nothing = plumb::calibrate_over_temperature(b.sheet, calibration_test::standard_gravity(), nullptr, 7,
                                                         options_of(1), &scratch, *f.work);
  ASSERT_FALSE(nothing.has_value());
  EXPECT_EQ(nothing.error().code, Errc::too_few_stations);
  plumb::TemperatureOptions short_of_time = options_of(1);
  short_of_time.fit.max_iterations = 1;
  EXPECT_EQ(fit_of(b.sheet, b.on(3), short_of_time).made.error().code, Errc::diverged);
  plumb::TemperatureOptions endless = options_of(1);
  endless.fit.stop_relative = -1.0;
  endless.fit.max_iterations = std::numeric_limits<int>::max();
  EXPECT_EQ(fit_of(b.sheet, b.on(2), endless).made.error().code, Errc::diverged);
}

// Negative: REQ-034
TEST(TemperatureInput, NumbersThatAreNoneAreRefused) {
  for (const double poison : {kNan, kInf, 1e308, -1e308, 1e155}) {
    Bench b;
    auto stations = b.on(3);
    stations[7].mean[2] = poison;
    plumb::TemperatureOptions options = options_of(1);
    options.fit.reject_outliers = false;
    const Fit f = fit_of(b.sheet, stations, options);
    ASSERT_FALSE(f.made.has_value()) << poison;
    EXPECT_NE(f.made.error().code, Errc::ok) << poison;
  }
}

TEST(TemperatureInput, WithoutFreedomNothingIsJudgedByTheResiduals) {
  Bench b;
  const auto all = b.on(2);
  const std::vector<plumb::Station> stations = {all.at(0), all.at(1), all.at(12), all.at(13)};
  plumb::TemperatureOptions options = options_of(1);
  options.fit.require_full_rank = false;
  options.fit.estimate_misfit = false;
  const Fit f = fit_of(b.sheet, stations, options);
  EXPECT_LE(f.figures.degrees_of_freedom, 0);
  EXPECT_EQ(f.figures.p_value, 1.0);
}

/// More stray stations than a report lists: all are counted, the first are named.
TEST(TemperatureInput, OutliersBeyondTheListAreCounted) {
  Bench b;
  std::vector<plumb::Station> stations;
  for (int round = 0; round < 3; ++round) {
    const auto more = b.on(4);
    stations.insert(stations.end(), more.begin(), more.end());
  }
  const int strays = plumb::kMaxOutliers + 2;
  for (int k = 0; k < strays; ++k) stations[at(7 * k)].mean[at(k % 4)] += 0.05;
  const Fit f = fit_of(b.sheet, stations, options_of(3));
  EXPECT_EQ(f.figures.outliers, strays);
  EXPECT_EQ(f.figures.outlier[plumb::kMaxOutliers - 1].station, 7 * (plumb::kMaxOutliers - 1));
}

/// Of a calibration of fewer sensors those that it has.
TEST(TemperatureInput, ADatasheetTakesTheTermsThatThereAre) {
  Bench b;
  const Fit f = fit_of(b.sheet, b.on(3), options_of(1));
  ASSERT_TRUE(f.made.has_value());
  plumb::Calibration three = *f.made;
  three.model.size = 3;
  const plumb::Datasheet out = plumb::with_temperature_of(b.sheet, three);
  EXPECT_NE(out.sensor[2].coefficients.scale[1], b.sheet.sensor[2].coefficients.scale[1]);
  EXPECT_EQ(out.sensor[3].coefficients.scale[1], b.sheet.sensor[3].coefficients.scale[1]);
}

/// A scale that is right in the middle of the span and bends beyond its bound at the ends.
// Negative: REQ-034
TEST(TemperatureInput, AScaleThatBendsBeyondItsBoundIsRefused) {
  Scene s;
  for (plumb::SensorCoefficients& c : s.truth.model.sensor) c.scale[1] = c.scale[2] = c.scale[3] = 0.0;
  s.truth.model.sensor[1].reference_degc = 85.0;
  s.truth.model.sensor[1].scale[1] = s.truth.model.sensor[1].scale[0] * 4e-4;
  const auto stations = on_levels(s.truth, levels_of(3), s.noise);
  plumb::TemperatureOptions options = options_of(1);
  options.fit.max_scale_change = 0.0235;
  const Fit f = fit_of(s.sheet, stations, options);
  ASSERT_FALSE(f.made.has_value());
  EXPECT_EQ(f.made.error().code, Errc::implausible) << plumb::describe(f.made.error().code);
  EXPECT_EQ(f.made.error().index, 1);
}

// Negative: REQ-034
TEST(TemperatureInput, GravityThatIsNoNumberHasNoFit) {
  Scene s;
  const auto made =
      plumb::calibrate_over_temperature(s.sheet, {std::nan(""), 0.0, plumb::GravityModel::value}, s.stations.data(),
                                        s.count(), options_of(1), s.scratch.data(), *s.work);
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, Errc::diverged);
}

/// Two channels that hold one sensor's readings, a constant apart.
// Negative: REQ-034
TEST(TemperatureInput, TwinsAreReportedOverTemperatureToo) {
  Scene s;
  for (plumb::Station& station : s.stations) station.mean[2] = station.mean[0] + 1e-4;
  plumb::TemperatureOptions options = options_of(1);
  options.fit.reject_outliers = false;
  options.fit.max_iterations = 1000;
  const Fit f = fit_of(s.sheet, s.stations, options);
  ASSERT_FALSE(f.made.has_value());
  EXPECT_EQ(f.made.error().code, Errc::implausible) << plumb::describe(f.made.error().code);
  EXPECT_EQ(f.made.error().index, 2);
}

/// Stations without samples among strays, and too few of all to look for strays.
TEST(TemperatureInput, StationsWithoutSamplesAreNoOutliers) {
  Scene s;
  s.stations = s.on(4);
  for (const int k : {5, 17, 30}) s.stations[at(k)].mean[at(k % 4)] += 0.05;
  s.stations[8].count = s.stations[21].count = 0;
  const Fit f = fit_of(s.sheet, s.stations, options_of(1));
  EXPECT_EQ(f.figures.outliers, 3);
  EXPECT_EQ(f.figures.stations, s.count() - 5);
}

TEST(TemperatureInput, WithFewStationsNoneIsAnOutlierAndNoMisfitIsEstimated) {
  for (const int few : {3, 4, 8, 9, 10}) {
    Scene s;
    std::vector<plumb::Station> stations;
    for (int k = 0; k < few; ++k) stations.push_back(s.stations[at((k % 2 == 0 ? 0 : 24) + k)]);
    stations[1].mean[1] += 0.05;
    plumb::TemperatureOptions options = options_of(1);
    options.fit.require_full_rank = false;
    const Fit f = fit_of(s.sheet, stations, options);
    EXPECT_EQ(f.figures.outliers, 0) << few;
    EXPECT_EQ(f.figures.stations, few);
    for (const bool estimate : {false, true}) {
      options.fit.estimate_misfit = estimate;
      const Fit g = fit_of(s.sheet, stations, options);
      if (g.figures.degrees_of_freedom < 1) {
        EXPECT_EQ(g.figures.p_value, 1.0);
      }
    }
  }
}

TEST(TemperatureInput, WhereNoOrderIsAskedForNoLevelIsMissing) {
  Scene s;
  plumb::TemperatureOptions options = options_of(plumb::kAutomaticOrder);
  const auto one = on_levels(s.truth, levels_of(1), s.noise);
  EXPECT_GT(fit_of(s.sheet, one, options).report.missing, 0);
  options.max_order = 0;
  EXPECT_EQ(fit_of(s.sheet, one, options).report.missing, 0);
}

}  // namespace
}  // namespace temperature_input_test
