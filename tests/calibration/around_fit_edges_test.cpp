// The same of what stands around a fit: its acceptance, its cross check, what it leaves open, and the paper's own.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "calibration/edges_support.hpp"
#include "plumb/calibration/acceptance.hpp"
#include "plumb/calibration/cross_check.hpp"
#include "plumb/calibration/null_directions.hpp"
#include "plumb/calibration/observability.hpp"
#include "plumb/calibration/paper_calibration.hpp"
#include "plumb/calibration/paper_parameters.hpp"

namespace around_fit_edges_test {
namespace {

using namespace calibration_test;

constexpr double kSigma = kEdgeSigma;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(AcceptanceEdge, AnIndexBeyondTheSheetAccusesNobody) {
  Bench b;
  const auto fit = b.run();
  ASSERT_TRUE(fit.has_value());
  OddSensor odd;
  odd.sensor = 4;
  odd.with_mps2 = 1.0;
  EXPECT_EQ(judge_odd_sensor(b.sheet, odd).error.code, Errc::ok);
  odd.sensor = 3;
  EXPECT_EQ(judge_odd_sensor(b.sheet, odd).error.index, 3);
  const Judgement whole = judge(b.sheet, b.gravity, *fit, HoldOut{}, odd);
  EXPECT_EQ(whole.concern, Concern::odd_sensor);
  Calibration bent = *fit;
  bent.report.level_misfit.sensor = 4;
  bent.report.level_misfit.mean_mps2 = 1.0;
  EXPECT_EQ(judge(b.sheet, b.gravity, bent, HoldOut{}, OddSensor{}).error.code, Errc::ok);
  bent.report.level_misfit.sensor = 1;
  EXPECT_EQ(judge(b.sheet, b.gravity, bent, HoldOut{}, OddSensor{}).concern, Concern::level_of_a_sensor);
  bent.report.level_misfit.mean_mps2 = 1e-9;
  EXPECT_EQ(judge(b.sheet, b.gravity, bent, HoldOut{}, OddSensor{}).error.code, Errc::ok);
  EXPECT_STREQ(to_string(Concern::roll_axis), "roll_axis");
  EXPECT_STREQ(to_string(Concern::level_of_a_sensor), "level_of_a_sensor");
}

TEST(CrossCheckEdge, WhatCannotBePredictedIsNotJudged) {
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

TEST(CrossCheckEdge, ASensorThatDidNotDeliverIsLeftOutOfTheParity) {
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

TEST(CrossCheckEdge, TheResidualOfNothingIsNothing) {
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

TEST(CrossCheckEdge, PlansLargerThanTheStationsEnd) {
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
TEST(CrossCheckEdge, WithNobodyToCompareWithNobodyStandsOut) {
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

TEST(DatasheetEdge, OfMoreSensorsThanFitTheFirstAreTold) {
  Datasheet sheet = paper_tool(kSigma);
  const RowUncertainty four = sheet.uncertainty();
  sheet.size = kCapacity + 5;
  const RowUncertainty all = sheet.uncertainty();
  for (int k = 0; k < RowUncertainty::packed_size(4); ++k) EXPECT_EQ(all.covariance[at(k)], four.covariance[at(k)]);
  EXPECT_EQ(sheet.array().error().code, Errc::too_many_sensors);
}

/// A cubic that passes through zero has no reading there.
TEST(SensorModelEdge, AScaleOfZeroHasNoReading) {
  SensorModel model;
  model.size = 1;
  model.sensor[0].scale = {1.0, -0.125, 0.0, 0.0};
  model.sensor[0].reference_degc = 20.0;
  EXPECT_TRUE(std::isnan(model.apply({1.0}, 28.0, SensorSet::first(1))[0]));
  EXPECT_EQ(model.apply({1.0}, 20.0, SensorSet::first(1))[0], 1.0);
}

TEST(CoverageEdge, NeighbouringBinsAreOneInclinationWhateverTheOrder) {
  const Datasheet d = paper_tool(kSigma);
  std::vector<SeenAttitude> seen;
  for (const double inclination : {60.0, 50.0, 45.0, 10.0, 90.0}) {
    const Vec3 g = rolled(inclination, 0.0);
    seen.push_back({scaled(g, 1.0 / norm(g)), SensorSet::first(4), 10.0});
  }
  const Coverage c = coverage_of(d, seen.data(), 5);
  EXPECT_EQ(c.inclinations, 4);
  EXPECT_NEAR(c.inclination_min_rad, rad_from_deg(10.0), 1e-9);
  EXPECT_NEAR(c.inclination_max_rad, rad_from_deg(90.0), 1e-9);
}

TEST(StationPlannerEdge, WithoutASheetItHasNothingToPropose) {
  const auto idle = [](const Datasheet& sheet, double g_mps2) {
    auto planner = std::make_unique<StationPlanner>(sheet, g_mps2);
    const bool taken = planner->add({{0, 0, 1}, SensorSet::first(4), 100.0});
    return !taken && planner->best(100.0).gain == 0.0;
  };
  Datasheet sheet = paper_tool(kSigma);
  EXPECT_FALSE(idle(sheet, kG0_mps2));
  EXPECT_TRUE(idle(sheet, 0.0));
  EXPECT_TRUE(idle(sheet, kInf));
  sheet.size = 2;
  EXPECT_TRUE(idle(sheet, kG0_mps2));
  sheet.size = kCapacity + 1;
  EXPECT_TRUE(idle(sheet, kG0_mps2));
}

TEST(StationPlannerEdge, AnAttitudeThatASensorMissedTellsLess) {
  AxisList axes{};
  const Datasheet sheet = datasheet_of(axes, cone(axes, 5), kSigma);
  auto planner = std::make_unique<StationPlanner>(sheet, kG0_mps2);
  EXPECT_TRUE(planner->add({{0, 0, 1}, SensorSet::first(5).without(1), 100.0}));
  EXPECT_FALSE(planner->add({{0, 0, 1}, SensorSet::first(5), kInf}));
  EXPECT_EQ(planner->best(0.0).gain, 0.0);
}

/// What a report by hand says is open: with and without the rotations that nobody sees, frozen axes among them.
TEST(NullDirectionsEdge, AReportByHandIsReadAsItStands) {
  Datasheet sheet = paper_tool(kSigma);
  auto found = std::make_unique<NullCombinations>();
  auto report = std::make_unique<FitReport>();
  report->null_directions = 2;
  report->null_direction[0].component[3] = 1.0;  // the bias of the first sensor
  report->null_direction[1].component[7] = std::sqrt(0.5);
  report->null_direction[1].component[11] = std::sqrt(0.5);
  for (const int gauge : {0, 1, 3}) {
    report->gauge = gauge;
    ASSERT_EQ(null_combinations(sheet, *report, *found), 2) << gauge;
    EXPECT_EQ((*found)[0].terms, 1) << gauge;
    EXPECT_EQ((*found)[0].term[0].kind, ParameterKind::bias);
    EXPECT_EQ((*found)[0].term[0].sensor, 0);
    EXPECT_FALSE((*found)[1].rotates_all);
  }
  sheet.sensor[2].prior.axis_rad = 0.0;
  EXPECT_EQ(null_combinations(sheet, *report, *found), 2);
  sheet.size = kCapacity + 1;
  EXPECT_EQ(null_combinations(sheet, *report, *found), 0);
}

/// All axes turned alike, and no rotation of which it is said that nobody sees it: told as one rotation.
TEST(NullDirectionsEdge, ACommonRotationIsToldAsOne) {
  const Datasheet sheet = paper_tool(kSigma);
  auto found = std::make_unique<NullCombinations>();
  auto report = std::make_unique<FitReport>();
  report->null_directions = 1;
  double square = 0.0;
  auto& component = report->null_direction[0].component;
  for (int i = 0; i < 4; ++i) {
    const Vec3 d = cross(sheet.sensor[at(i)].row.axis, {0.0, 0.0, 1.0});
    for (int p = 0; p < 3; ++p) component[at(4 * i + p)] = d[at(p)] / sheet.sensor[at(i)].prior.axis_rad;
    square += dot(d, d) / (sheet.sensor[at(i)].prior.axis_rad * sheet.sensor[at(i)].prior.axis_rad);
  }
  for (double& c : component) c /= std::sqrt(square);
  ASSERT_EQ(null_combinations(sheet, *report, *found), 1);
  EXPECT_TRUE((*found)[0].rotates_all);
  EXPECT_NEAR(std::fabs((*found)[0].rotation[2]), 1.0, 1e-6);
}

TEST(PaperEdge, RefusesWhatIsNoNumber) {
  Bench b;
  PaperFit fit;
  PaperOptions endless;
  endless.stop = kInf;
  const auto refused =
      paper_calibrate(b.sheet, b.gravity, b.stations.data(), b.count(), SensorSet::first(4), endless, fit);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, Errc::out_of_range);
  EXPECT_EQ(refused.error().index, 1);
  GravityReference far = b.gravity;
  far.g_mps2 = kInf;
  EXPECT_EQ(PaperError::make(b.sheet, far, SensorSet::first(4)).error().index, 4);
  auto all = std::make_unique<PaperCalibration>();
  Datasheet large = b.sheet;
  large.size = kPaperCapacity + 1;
  EXPECT_EQ(paper_calibrate_all(large, b.gravity, b.stations.data(), b.count(), {}, *all).error().code,
            Errc::too_many_sensors);
}

/// Stations that do not count, parameters at which nothing can be said: the sums are those of the rest, or none.
TEST(PaperEdge, StationsThatDoNotCountAreLeftOut) {
  Bench b;
  const auto error = PaperError::make(b.sheet, b.gravity, SensorSet::first(4));
  ASSERT_TRUE(error.has_value());
  const PaperParameters start = error->start();
  const double cost = error->cost(start, b.stations.data(), b.count());
  b.stations.push_back(b.stations[0]);
  b.stations.back().count = 0;
  EXPECT_EQ(error->cost(start, b.stations.data(), b.count()), cost);
  std::vector<double> matrix(400);
  PaperParameters gradient{};
  EXPECT_NEAR(error->gauss_newton(start, b.stations.data(), b.count(), matrix.data(), 20, gradient), cost, 1e-9 * cost);
  PaperParameters flat = start;
  flat[4] = 0.0;  // the scale factor of the first sensor
  std::vector<double> curvature(400, 7.0);
  error->add_curvature(flat, b.stations[0], 1.0, curvature.data());
  EXPECT_EQ(curvature, std::vector<double>(400, 7.0));
  PaperFit fit;
  PaperOptions plain;
  plain.step = PaperStep::plain_inverse;
  plain.max_iterations = 2;
  const auto done = paper_calibrate(b.sheet, b.gravity, b.stations.data(), b.count(), SensorSet::first(4), plain, fit);
  EXPECT_TRUE(done.has_value());
  PaperFit none;
  EXPECT_FALSE(
      paper_calibrate(b.sheet, b.gravity, b.stations.data() + 48, 1, SensorSet::first(4), {}, none).has_value() &&
      none.stop == StopReason::converged);
}

/// A trace that is full takes no more, and the fit goes on.
TEST(PaperEdge, AFullTraceTakesNoMore) {
  Bench b;
  auto trace = std::make_unique<PaperTrace>();
  trace->size = kMaxPaperIterations + 1;
  PaperFit fit;
  EXPECT_TRUE(
      paper_calibrate(b.sheet, b.gravity, b.stations.data(), b.count(), SensorSet::first(4), {}, fit, trace.get())
          .has_value());
}

TEST(PaperEdge, FormsOfArraysThatDoNotMatch) {
  AxisList axes{};
  const auto array_of = [](const AxisList& a, int n) {
    const Datasheet d = datasheet_of(a, n, kSigma);
    const auto made = d.array();
    EXPECT_TRUE(made.has_value());
    return *made;
  };
  const SensorArray three = array_of(axes, orthogonal_triad(axes));
  const SensorArray four = array_of(axes, paper_tetrahedron(axes));
  SensorModel model;
  model.size = 4;
  EXPECT_EQ(paper_form(four, three, model).error().code, Errc::out_of_range);
  AxisList flat{};
  flat[0] = {1.0, 0.0, 0.0};
  flat[1] = {0.0, 1.0, 0.0};
  flat[2] = {std::sqrt(0.5 - 1e-7), std::sqrt(0.5), std::sqrt(1e-7)};
  const SensorArray nearly = array_of(flat, 3);
  model.size = 3;
  EXPECT_EQ(paper_form(three, nearly, model).error().code, Errc::axes_rank_deficient);
}

}  // namespace
}  // namespace around_fit_edges_test
