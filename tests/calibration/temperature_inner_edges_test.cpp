// Edges of the parts of the fit over temperature, and fits whose priors, stations or options leave them no way out.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "../../src/calibration/temperature_model.hpp"
#include "calibration/temperature_support.hpp"

namespace temperature_inner_edges_test {
namespace {

using namespace temperature_test;
using plumb::Errc;

struct Scene {
  plumb::Datasheet sheet = paper_sheet();
  Noise noise{91};
  Truth truth = temperature_test::draw_truth(sheet, noise);
  std::vector<plumb::Station> stations = on_levels(truth, levels_of(3), noise);
  std::vector<plumb::Station> scratch = stations;
  plumb::fit::Joint joint{sheet, {kLow_degc, kHigh_degc}, 1};
  plumb::fit::JointState state = joint.nominal;
  std::unique_ptr<plumb::TemperatureWork> work = std::make_unique<plumb::TemperatureWork>();
  plumb::TemperatureReport report;
  plumb::FitReport figures;

  Scene() { report.levels = plumb::temperature_levels(stations.data(), count()); }
  int count() const { return static_cast<int>(stations.size()); }
  plumb::fit::JointAnalysis analysis(double floor) {
    return {joint, state, plumb::kG0_mps2, 0.0, floor, stations.data(), count(), scratch.data()};
  }
};

TEST(TemperatureInnerEdge, TheRankIsThatOfWhatIsAboveTheFloor) {
  Scene s;
  ASSERT_TRUE(plumb::fit::find_rank(s.analysis(1e-10), *s.work, s.report));
  EXPECT_EQ(s.report.gauge, 3);
  EXPECT_EQ(s.report.rank, s.joint.parameters() - 3);
  EXPECT_EQ(s.report.null_directions, 0);
  // Below every value: all count, and no rotation does.
  ASSERT_TRUE(plumb::fit::find_rank(s.analysis(-1.0), *s.work, s.report));
  EXPECT_EQ(s.report.rank, s.joint.parameters());
  EXPECT_EQ(s.report.gauge, 0);
}

TEST(TemperatureInnerEdge, AxesWithoutLengthHaveNoRotationAndNoRank) {
  Scene s;
  s.state.theta.fill(0.0);
  ASSERT_TRUE(plumb::fit::find_rank(s.analysis(1e-10), *s.work, s.report));
  EXPECT_EQ(s.report.rank, 0);
  EXPECT_EQ(s.report.rank + s.report.gauge + s.report.null_directions, s.joint.parameters());
}

// Negative: REQ-034
TEST(TemperatureInnerEdge, InformationThatIsNoneHasNoRankAndNoPosterior) {
  Scene s;
  const int size = s.joint.parameters();
  for (int k = 0; k < size; ++k) s.work->information[at(k * size + k)] = -2.0;
  EXPECT_FALSE(plumb::fit::analyse(s.analysis(1e-10), *s.work, s.report, s.figures));
}

/// A prior so wide that the information beside it is beyond all numbers.
// Negative: REQ-034
TEST(TemperatureInnerEdge, InformationBeyondAllNumbersHasNoRank) {
  Scene s;
  plumb::Datasheet wide = s.sheet;
  for (int i = 0; i < wide.size; ++i) wide.sensor[at(i)].prior.bias_mps2 = 1e153;
  const plumb::fit::Joint joint(wide, {kLow_degc, kHigh_degc}, 1);
  const plumb::fit::JointState state = joint.nominal;
  const plumb::fit::JointAnalysis analysis = {
      joint, state, plumb::kG0_mps2, 0.0, 1e-10, s.stations.data(), s.count(), s.scratch.data()};
  EXPECT_FALSE(plumb::fit::find_rank(analysis, *s.work, s.report));
}

/// Where nothing but the slopes over temperature is open, nothing is at the middle of the span: no multiple of the mean
/// is as small.
TEST(TemperatureInnerEdge, ACovarianceThatVanishesSomewhereHasNoCover) {
  plumb::AxisList axes{};
  const double h = std::sqrt(1.0 / 3.0);
  for (int i = 0; i < 4; ++i) axes[at(i)] = {i % 2 == 0 ? h : -h, i < 2 ? h : -h, i % 3 == 0 ? h : -h};
  const plumb::Datasheet sheet = sheet_of(axes, 4);
  const plumb::fit::Joint joint(sheet, {kLow_degc, kHigh_degc}, 1);
  const auto work = std::make_unique<plumb::TemperatureWork>();
  const int size = joint.parameters(), per = joint.per_sensor();
  const auto open = [&](int parameter, double variance) {
    for (int i = 0; i < joint.sensors(); ++i) {
      const int k = per * i + parameter;
      work->information[at(k * size + k)] = variance;
    }
  };
  open(4, 1e-6);
  open(5, 1e-6);
  EXPECT_EQ(plumb::fit::covering_covariance(joint, joint.nominal, {kLow_degc, kHigh_degc}, *work), 0.0);
  for (int p = 0; p < 4; ++p) open(p, 1e-6);
  EXPECT_GE(plumb::fit::covering_covariance(joint, joint.nominal, {kLow_degc, kHigh_degc}, *work), 1.0);
}

// Negative: REQ-034
TEST(TemperatureInnerEdge, SumsBeyondAllNumbersAreNotFinite) {
  Scene s;
  for (int i = 0; i < s.joint.sensors(); ++i) s.joint.sheet.sensor[at(i)].row.sigma_mps2 = 1e-50;
  for (std::size_t k = 0; k < 8; ++k) s.stations[k].mean[0] = 3e103;
  plumb::fit::reduce_all(s.joint, s.state, s.stations.data(), s.count(), s.scratch.data());
  const plumb::fit::Problem problem = {s.joint.sheet, plumb::kG0_mps2, {s.scratch.data(), s.count()}, s.count(), {},
                                       nullptr};
  plumb::fit::JointSums sums;
  plumb::fit::accumulate(s.joint, s.state, problem, 0.0, plumb::fit::Loss::squares, s.work->information.data(), sums);
  EXPECT_FALSE(sums.sums.finite);
}

/// A scale that is right in the middle of the span and bends beyond its bound at the ends.
// Negative: REQ-034
TEST(TemperatureInnerEdge, AScaleThatBendsBeyondItsBoundIsRefused) {
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
TEST(TemperatureInnerEdge, GravityThatIsNoNumberHasNoFit) {
  Scene s;
  const auto made =
      plumb::calibrate_over_temperature(s.sheet, {std::nan(""), 0.0, plumb::GravityModel::value}, s.stations.data(),
                                        s.count(), options_of(1), s.scratch.data(), *s.work);
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, Errc::diverged);
}

/// Two channels that hold one sensor's readings, a constant apart.
// Negative: REQ-034
TEST(TemperatureInnerEdge, TwinsAreNamedOverTemperatureToo) {
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
TEST(TemperatureInnerEdge, StationsWithoutSamplesAreNoOutliers) {
  Scene s;
  s.stations = on_levels(s.truth, levels_of(4), s.noise);
  for (const int k : {5, 17, 30}) s.stations[at(k)].mean[at(k % 4)] += 0.05;
  s.stations[8].count = s.stations[21].count = 0;
  const Fit f = fit_of(s.sheet, s.stations, options_of(1));
  EXPECT_EQ(f.figures.outliers, 3);
  EXPECT_EQ(f.figures.stations, s.count() - 5);
}

TEST(TemperatureInnerEdge, OfAFewStationsNoneIsSetAsideAndNoMisfitIsEstimated) {
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

TEST(TemperatureInnerEdge, WhereNoOrderIsAskedForNoLevelIsMissing) {
  Scene s;
  plumb::TemperatureOptions options = options_of(plumb::kAutomaticOrder);
  const auto one = on_levels(s.truth, levels_of(1), s.noise);
  EXPECT_GT(fit_of(s.sheet, one, options).report.missing, 0);
  options.max_order = 0;
  EXPECT_EQ(fit_of(s.sheet, one, options).report.missing, 0);
}

}  // namespace
}  // namespace temperature_inner_edges_test
