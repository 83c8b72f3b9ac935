// What stands at the edge of what the functions of this room take: nothing, too much, numbers that are none.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "calibration/calibration_support.hpp"
#include "plumb/calibration/acceptance.hpp"
#include "plumb/calibration/cross_check.hpp"
#include "plumb/calibration/null_directions.hpp"
#include "plumb/calibration/observability.hpp"
#include "plumb/calibration/paper_calibration.hpp"
#include "plumb/calibration/paper_parameters.hpp"

namespace {

using namespace calibration_test;
using namespace plumb;

constexpr double kSigma = 2e-4 * kG0_mps2;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Bench {
  explicit Bench(std::uint64_t seed = 1, int count = 48) : noise(seed) {
    stations = random_stations(sheet, truth, count, noise, kSigma);
  }
  Noise noise;
  Datasheet sheet = paper_tool(kSigma);
  Truth truth = draw_truth(sheet, noise);
  std::vector<Station> stations;
  GravityReference gravity = standard_gravity();
  FitOptions options;
  FitReport report;

  int count() const { return static_cast<int>(stations.size()); }
  Expected<Calibration> run() { return calibrate(sheet, gravity, stations.data(), count(), options, &report); }
  Errc refusal() {
    const auto c = run();
    return c ? Errc::ok : c.error().code;
  }
};

TEST(CalibrationEdge, FrozenScalesHaveNoCommonOne) {
  EXPECT_EQ((CommonScale{0.1, 0.0, 0.0}.sigmas()), 0.0);
  EXPECT_EQ((CommonScale{0.1, 0.0, 0.05}.sigmas()), 2.0);
}

/// Every number that a datasheet has, wrong on its own: refused, and the sensor is said where there is one.
// Negative: REQ-034
TEST(CalibrationEdge, ADatasheetWithOneWrongNumberIsRefused) {
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
TEST(CalibrationEdge, ANameWithoutAnEndIsCut) {
  Bench b;
  b.sheet.sensor[2].row.id.fill('x');
  const auto c = b.run();
  ASSERT_TRUE(c.has_value());
  EXPECT_STREQ(c->array.row(2).id.data(), std::string(15, 'x').c_str());
}

TEST(CalibrationEdge, AFitThatNeverSettlesEndsAllTheSame) {
  Bench b(1, 12);
  b.options.stop_relative = -1.0;
  b.options.max_iterations = std::numeric_limits<int>::max();
  EXPECT_EQ(b.refusal(), Errc::diverged);
}

TEST(CalibrationEdge, WithoutFreedomNothingIsJudgedByTheResiduals) {
  Bench b(1, 3);
  b.options.require_full_rank = false;
  b.options.estimate_misfit = false;
  const auto c = b.run();
  EXPECT_LE(b.report.degrees_of_freedom, 0);
  EXPECT_EQ(b.report.p_value, 1.0);
  EXPECT_TRUE(c.has_value()) << describe(c.error().code);
}

TEST(CalibrationEdge, ABoundOfZeroLeavesNoRoom) {
  Bench scale;
  scale.options.max_scale_change = 0.0;
  EXPECT_EQ(scale.refusal(), Errc::implausible);
  Bench axis;
  axis.options.max_axis_change_rad = 0.0;
  EXPECT_EQ(axis.refusal(), Errc::implausible);
}

TEST(CalibrationEdge, AScatterBeyondAllBoundsIsNoFigure) {
  Bench b;
  for (Station& s : b.stations) {
    s.count = 4;
    s.scatter.fill(1e200);
  }
  b.run();
  for (const double noise : b.report.sample_noise_mps2) EXPECT_EQ(noise, 0.0);
}

/// The first sensor is the noisiest: those after it do not take its place.
TEST(CalibrationEdge, TheNoisiestSampleNamesTheSensor) {
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
TEST(CalibrationEdge, AStationWithoutSamplesCountsNowhere) {
  Bench b;
  Noise loud(3);
  for (Station& s : b.stations) s.mean[1] += 40.0 * kSigma * 3.0 / kG0_mps2 * loud.normal();
  b.options.max_sensor_excess = 1e9;
  b.options.max_norm_rms_mps2 = 1.0;
  b.options.reject_outliers = false;
  b.run();
  const FitReport without = b.report;
  ASSERT_EQ(without.loud_sensor, 1);
  b.stations.push_back(b.stations[0]);
  b.stations.back().count = 0;
  b.stations.back().roll_group = 4;
  b.run();
  EXPECT_EQ(b.report.stations, without.stations);
  EXPECT_EQ(b.report.loud_sensor, 1);
  EXPECT_NEAR(b.report.loud_misfit_mps2, without.loud_misfit_mps2, 1e-9);
  EXPECT_EQ(b.report.roll_groups, 0);
}

/// Channels swapped, and a station that one of them does not deliver: that one tells nothing of twins.
TEST(CalibrationEdge, TwinsAreLookedForWhereBothDeliver) {
  Bench b;
  for (Station& s : b.stations) s.mean[1] = s.mean[0];
  b.stations[3].count = 0;
  b.stations[4].delivered = SensorSet::first(4).without(3);
  EXPECT_EQ(b.refusal(), Errc::implausible);
}

struct Held {
  explicit Held(int count = 24) {
    for (int i = 0; i < sheet.size; ++i) sheet.sensor[at(i)].prior.axis_rad = 0.0;
    Noise noise(5);
    const Truth truth = draw_truth(sheet, noise, 0.2, 0.0);
    options.require_full_rank = false;
    options.estimate_misfit = false;
    stations = random_stations(sheet, truth, count, noise, kSigma);
  }
  Error run() {
    Calibrator fit(sheet, gravity, options);
    const StationList list(stations.data(), static_cast<int>(stations.size()));
    for (int k = 0; k < 200 && !fit.done(); ++k) fit.iterate_held(list);
    fit.iterate_held(list);  // after its end: nothing
    return fit.finish_held(list, out);
  }
  Datasheet sheet = paper_tool(kSigma);
  GravityReference gravity = standard_gravity();
  FitOptions options;
  std::vector<Station> stations;
  HeldFit out;
};

TEST(HeldFitEdge, TakesAsManyStationsAsItCountsAndNoMore) {
  Held fits;
  EXPECT_EQ(fits.run().code, Errc::ok);
  Held many(200);
  EXPECT_EQ(many.run().code, Errc::diverged);
}

TEST(StationListEdge, OnlyTheFirstCanBeLeftOut) {
  std::vector<StationMean> means(60);
  StationList list(means.data(), 60, SensorSet::first(4), 4);
  EXPECT_EQ(list.size(), 45);
  list.leave_out(StationList::kMarked - 1);
  list.leave_out(StationList::kMarked);
  EXPECT_EQ(list[StationList::kMarked - 1].count, 0U);
  EXPECT_EQ(list[StationList::kMarked].count, 1U);
  EXPECT_EQ(list[0].count, 1U);
}

TEST(HeldFitEdge, NumbersThatAreNoneAreRefused) {
  Held reading;
  reading.stations[5].mean[1] = kNan;
  EXPECT_EQ(reading.run().code, Errc::diverged);
  Held scale;
  scale.sheet.sensor[2].coefficients.scale[0] = 0.0;
  EXPECT_EQ(scale.run().code, Errc::not_finite);
  Held endless;
  endless.options.stop_relative = -1.0;
  endless.options.max_iterations = 20;
  EXPECT_EQ(endless.run().code, Errc::diverged);
  Held few(2);
  EXPECT_EQ(few.run().code, Errc::too_few_stations);
}

TEST(HeldFitEdge, SpecificForceHasTheOtherSign) {
  Held gravity, force;
  force.sheet.reads = Reads::specific_force;
  for (Station& s : force.stations) {
    for (int i = 0; i < 4; ++i) {
      // V = SF(T) (f + B), and f = -g.
      const SensorModel model = force.sheet.model();
      const double offset = model.bias_at(i, s.temperature_degc) * model.scale_at(i, s.temperature_degc);
      s.mean[at(i)] = 2.0 * offset - s.mean[at(i)];
    }
  }
  ASSERT_EQ(gravity.run().code, Errc::ok);
  ASSERT_EQ(force.run().code, Errc::ok);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(force.out.bias_mps2[at(i)], -gravity.out.bias_mps2[at(i)], 1e-9) << i;
    EXPECT_NEAR(force.out.length[at(i)], gravity.out.length[at(i)], 1e-9) << i;
  }
}

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

/// Held biases and scales with stations that stray. As few as there are parameters: nothing is left to judge by.
TEST(HeldFitEdge, StraysRefuseItAndTooFewAreNotJudged) {
  Held strays;
  strays.stations[3].mean[1] += 0.2;
  strays.stations[9].mean[2] -= 0.2;
  EXPECT_NE(strays.run().code, Errc::ok) << "without the misfit there is no noise that explains them";
  Held few(4);
  few.run();
  EXPECT_LE(few.out.degrees_of_freedom, 0);
  EXPECT_EQ(few.out.p_value, 1.0);
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
