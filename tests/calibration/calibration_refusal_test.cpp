/// What a fit must refuse, and with which word.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "calibration_support.hpp"
#include "plumb/calibration/acceptance.hpp"
#include "plumb/calibration/observability.hpp"

namespace calibration_refusal_test {
namespace {

using namespace calibration_test;

constexpr double kSigma = 2e-4 * plumb::kG0_mps2;

struct Bench {
  Noise noise{1};
  plumb::Datasheet sheet = paper_tool(kSigma);
  Truth truth = draw_truth(sheet, noise);
  std::vector<plumb::Station> stations = random_stations(sheet, truth, 48, noise, kSigma);
  plumb::GravityReference gravity = standard_gravity();
  plumb::FitOptions options;
  plumb::FitReport report;

  plumb::Expected<plumb::Calibration> run() {
    return plumb::calibrate(sheet, gravity, stations.data(), static_cast<int>(stations.size()), options, &report);
  }
  plumb::Errc refusal() {
    const auto c = run();
    return c ? plumb::Errc::ok : c.error().code;
  }
};

TEST(CalibrationRefusal, TheBenchItselfIsFine) {
  Bench b;
  EXPECT_EQ(b.refusal(), plumb::Errc::ok);
}

TEST(CalibrationRefusal, TooFewStations) {
  Bench b;
  b.stations.resize(2);
  const auto c = b.run();
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, plumb::Errc::too_few_stations);
  EXPECT_EQ(c.error().value, 2.0);
  EXPECT_EQ(c.error().limit, 9.0);
  b.options.require_full_rank = false;
  EXPECT_EQ(b.refusal(), plumb::Errc::too_few_stations);
  b.stations.clear();
  EXPECT_EQ(b.refusal(), plumb::Errc::too_few_stations);
  const auto null = plumb::calibrate(b.sheet, b.gravity, nullptr, 48);
  ASSERT_FALSE(null.has_value());
  EXPECT_EQ(null.error().code, plumb::Errc::too_few_stations);
}

// Negative: REQ-034
TEST(CalibrationRefusal, NumbersThatAreNone) {
  for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity(), -1e308, 1e308}) {
    Bench b;
    b.stations[7].mean[2] = poison;
    EXPECT_EQ(b.refusal(), plumb::Errc::diverged) << poison;
    EXPECT_EQ(b.report.stop, plumb::StopReason::not_finite) << poison;
  }
  Bench b;
  b.stations[7].temperature_degc = std::nan("");
  EXPECT_EQ(b.refusal(), plumb::Errc::diverged);
  Bench weight;
  weight.gravity.g_mps2 = std::nan("");
  EXPECT_EQ(weight.refusal(), plumb::Errc::diverged);
  Bench prior;
  prior.sheet.sensor[1].prior.scale = -1.0;
  EXPECT_EQ(prior.refusal(), plumb::Errc::diverged);
}

/// What cannot be squared, or whose square cannot be divided by.
// Negative: REQ-034
TEST(CalibrationRefusal, NumbersTooSmallOrTooLargeToBeSquared) {
  using Place = double& (*)(Bench&);
  constexpr Place kPlaces[] = {[](Bench& b) -> double& { return b.gravity.g_mps2; },
                               [](Bench& b) -> double& { return b.sheet.sensor[2].row.sigma_mps2; },
                               [](Bench& b) -> double& { return b.sheet.sensor[2].prior.bias_mps2; },
                               [](Bench& b) -> double& { return b.sheet.sensor[2].prior.scale; },
                               [](Bench& b) -> double& { return b.sheet.sensor[2].prior.axis_rad; }};
  for (const Place place : kPlaces) {
    for (const double beyond : {9e-101, 1e-300, 1.1e100, 1e300}) {
      Bench b;
      place(b) = beyond;
      EXPECT_EQ(b.refusal(), plumb::Errc::diverged) << beyond;
      EXPECT_EQ(b.report.stop, plumb::StopReason::not_finite) << beyond;
      EXPECT_EQ(b.report.iterations, 0) << beyond;
      plumb::StationPlanner planner(b.sheet, b.gravity.g_mps2);
      EXPECT_EQ(planner.best(100.0).gain, 0.0) << beyond;
    }
    for (const double at_the_edge : {1e-100, 1e100}) {
      Bench b;
      place(b) = at_the_edge;
      b.run();
      EXPECT_GT(b.report.iterations, 0) << at_the_edge;
    }
  }
  Bench resumed;
  plumb::Calibrator fit(resumed.sheet, resumed.gravity, resumed.options);
  EXPECT_FALSE(fit.done());
  resumed.sheet.sensor[0].row.sigma_mps2 = 1e-200;
  fit.resume(resumed.sheet, resumed.options);
  EXPECT_TRUE(fit.done());
  Bench frozen;
  for (auto& s : frozen.sheet.sensor) s.prior = {0.0, 0.0, 0.0, {}, {}};
  frozen.run();
  EXPECT_GT(frozen.report.iterations, 0);
}

// Negative: REQ-030
TEST(CalibrationRefusal, AllAttitudesTheSame) {
  Bench b;
  for (plumb::Station& s : b.stations) s = station_at(b.sheet, b.truth, rolled(30.0, 10.0), b.noise, kSigma);
  EXPECT_EQ(b.refusal(), plumb::Errc::unobservable);
  EXPECT_EQ(b.report.rank, 2);
}

TEST(CalibrationRefusal, ScaleOfTheWrongSignOrZero) {
  Bench negative;
  for (double& c : negative.sheet.sensor[0].coefficients.scale) c = -c;
  EXPECT_NE(negative.refusal(), plumb::Errc::ok);
  Bench zero;
  zero.sheet.sensor[0].coefficients.scale = {};
  const auto c = zero.run();
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, plumb::Errc::not_finite);
  EXPECT_EQ(c.error().index, 0);
}

TEST(CalibrationRefusal, GravityFarOff) {
  for (const double factor : {0.7, 1.3}) {
    Bench b;
    b.gravity.g_mps2 *= factor;
    const plumb::Errc code = b.refusal();
    EXPECT_TRUE(code == plumb::Errc::implausible || code == plumb::Errc::poor_fit) << static_cast<int>(code);
  }
}

// Negative: REQ-034
TEST(CalibrationRefusal, ParametersBeyondTheirPhysicalBounds) {
  Bench scale;
  scale.options.max_scale_change = 1e-4;
  EXPECT_EQ(scale.refusal(), plumb::Errc::implausible);
  Bench axis;
  axis.options.max_axis_change_rad = 1e-5;
  EXPECT_EQ(axis.refusal(), plumb::Errc::implausible);
  Bench bias;
  bias.options.max_bias_sigmas = 1e-3;
  EXPECT_EQ(bias.refusal(), plumb::Errc::implausible);
}

// Verifies: REQ-034
TEST(CalibrationRefusal, NormBeyondItsBound) {
  Bench b;
  b.options.max_norm_rms_mps2 = 1e-4;
  for (int i = 0; i < b.sheet.size; ++i) b.sheet.sensor[static_cast<std::size_t>(i)].row.sigma_mps2 *= 0.1;
  const auto c = b.run();
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, plumb::Errc::poor_fit);
  EXPECT_GT(c.error().value, c.error().limit);
}

/// Sensors that scatter by 0.5 m/s^2 a sample, as their datasheet says: the means of 32 are off by more than 0.05
/// m/s^2, and no calibration could be better.
// Verifies: REQ-034
TEST(CalibrationRefusal, CoarseSensorsThatKeepTheirDatasheetAreCalibrated) {
  Bench b;
  constexpr double kCoarse_mps2 = 0.5;
  b.sheet = paper_tool(kCoarse_mps2);
  b.stations = random_stations(b.sheet, b.truth, 96, b.noise, kCoarse_mps2);
  const auto c = b.run();
  ASSERT_TRUE(c.has_value()) << (c ? 0.0 : c.error().value);
  EXPECT_GT(b.report.norm_rms_mps2, b.options.max_norm_rms_mps2);
  const plumb::Judgement judged = plumb::judge(b.sheet, b.gravity, *c, plumb::HoldOut{}, plumb::OddSensor{});
  EXPECT_EQ(judged.error.code, plumb::Errc::ok) << plumb::to_string(judged.concern) << ' ' << judged.error.value;
  // The same scatter from sensors that promise a tenth of it is refused.
  for (int i = 0; i < b.sheet.size; ++i) b.sheet.sensor[static_cast<std::size_t>(i)].row.sigma_mps2 *= 0.1;
  EXPECT_EQ(b.refusal(), plumb::Errc::poor_fit);
}

TEST(CalibrationRefusal, ConvergenceNotReached) {
  Bench b;
  b.options.max_iterations = 2;
  b.options.start = plumb::FitStart::datasheet;
  EXPECT_EQ(b.refusal(), plumb::Errc::diverged);
  EXPECT_EQ(b.report.stop, plumb::StopReason::iteration_limit);
  EXPECT_EQ(b.report.iterations, 2);
  Bench unused;
  plumb::Calibrator calibrator(unused.sheet, unused.gravity, {});
  EXPECT_FALSE(calibrator.finish(unused.stations.data(), 48).has_value());
}

TEST(CalibrationRefusal, ANumberThatIsNoneNamesItsStation) {
  for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity(), -1e308, 1e308}) {
    for (const plumb::FitStart start : {plumb::FitStart::automatic, plumb::FitStart::datasheet}) {
      Bench b;
      b.options.start = start;
      b.stations[7].mean[2] = poison;
      const auto c = b.run();
      ASSERT_FALSE(c.has_value());
      EXPECT_EQ(c.error(), (plumb::Error{plumb::Errc::diverged, 7, 0.0, 0.0})) << poison;
    }
  }
  for (int sensor = 0; sensor < 4; ++sensor) {
    for (const double scale : {0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      Bench b;
      b.sheet.sensor[at(sensor)].coefficients.scale[0] = scale;
      const auto c = b.run();
      ASSERT_FALSE(c.has_value());
      EXPECT_EQ(c.error(), (plumb::Error{plumb::Errc::not_finite, sensor, 0.0, 0.0})) << scale;
    }
  }
}

TEST(CalibrationRefusal, AScaleOfTheWrongSignNamesItsSensor) {
  for (int sensor = 0; sensor < 4; ++sensor) {
    Bench b;
    for (double& c : b.sheet.sensor[at(sensor)].coefficients.scale) c = -c;
    const auto c = b.run();
    ASSERT_FALSE(c.has_value()) << sensor;
    EXPECT_TRUE(c.error().code == plumb::Errc::implausible || c.error().code == plumb::Errc::poor_fit);
    EXPECT_EQ(c.error().index, sensor);
  }
}

TEST(CalibrationRefusal, FewerPositionsThanUnknowns) {
  Bench b;
  b.stations.resize(8);
  EXPECT_EQ(b.refusal(), plumb::Errc::too_few_stations);
  Bench triad;  // nine positions hold nine unknowns of three sensors, but not where one is there twice
  plumb::AxisList axes{};
  triad.sheet = datasheet_of(axes, plumb::orthogonal_triad(axes), kSigma);
  triad.sheet = datasheet_of(axes, 3, kSigma);
  triad.truth = draw_truth(triad.sheet, triad.noise);
  triad.stations = random_stations(triad.sheet, triad.truth, 9, triad.noise, kSigma);
  triad.stations[8] = triad.stations[0];
  EXPECT_EQ(triad.refusal(), plumb::Errc::unobservable);
  EXPECT_EQ(triad.report.rank, 8);
}

TEST(CalibrationRefusal, TwoChannelsOfOneSensor) {
  Bench b;  // both columns of the log hold the same sensor, the datasheet has it along two axes
  for (plumb::Station& s : b.stations) s.mean[1] = s.mean[0];
  const auto c = b.run();
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, plumb::Errc::implausible);
  EXPECT_TRUE(c.error().index == 0 || c.error().index == 1);
  Bench twin;  // a triad with two axes alike spans a plane
  plumb::AxisList axes{};
  plumb::orthogonal_triad(axes);
  axes[1] = axes[0];
  twin.sheet = datasheet_of(axes, 3, kSigma);
  EXPECT_EQ(twin.refusal(), plumb::Errc::axes_rank_deficient);
}

TEST(CalibrationRefusal, TheSameNumbersInTwoColumns) {
  plumb::AxisList axes{};
  plumb::orthogonal_triad(axes);
  axes[3] = axes[2];  // the datasheet has two sensors along z, the log has one of them twice
  Bench b;
  b.sheet = datasheet_of(axes, 4, kSigma);
  b.truth = draw_truth(b.sheet, b.noise);
  b.stations = random_stations(b.sheet, b.truth, 48, b.noise, kSigma);
  EXPECT_EQ(b.refusal(), plumb::Errc::ok) << "two sensors along one axis are none of it";
  for (plumb::Station& s : b.stations) s.mean[3] = s.mean[2];
  const auto c = b.run();
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error(), (plumb::Error{plumb::Errc::implausible, 3, 0.0, 0.0}));
}

TEST(CalibrationRefusal, SaturatedReadingsAreNotUsedAndCounted) {
  Bench b;
  const double full_scale = 2.8;  // of 3 V/g0: clipped where a sensor points along gravity
  for (int i = 0; i < 4; ++i) b.sheet.sensor[at(i)].full_scale_raw = full_scale;
  int clipped = 0;
  for (plumb::Station& s : b.stations) {
    for (int i = 0; i < 4; ++i) {
      if (std::fabs(s.mean[at(i)]) < full_scale) continue;
      s.mean[at(i)] = std::copysign(full_scale, s.mean[at(i)]);
      ++clipped;
    }
  }
  ASSERT_GE(clipped, 4);
  const auto c = b.run();
  ASSERT_TRUE(c.has_value());
  EXPECT_EQ(b.report.clipped, clipped);
  EXPECT_EQ(b.report.clipped_sensors, plumb::SensorSet(15U));
  EXPECT_LE(sphere_error(b.sheet, b.truth, *c).tilt_rad, 4e-4);
  EXPECT_GT(b.report.p_value, 1e-4);
}

TEST(CalibrationRefusal, GravityOffByOnePercentIsACommonScale) {
  Bench b;
  b.truth = Truth{};
  for (int i = 0; i < 4; ++i) b.truth.w[at(i)] = b.sheet.sensor[at(i)].row.axis;
  b.stations = random_stations(b.sheet, b.truth, 48, b.noise, kSigma);
  ASSERT_TRUE(b.run().has_value());
  EXPECT_NEAR(b.report.common_scale.mean, 0.0, 1e-4);
  EXPECT_NEAR(b.report.common_scale.sigma, 0.0115 / 2.0, 1e-9);
  b.gravity.g_mps2 *= 1.01;
  ASSERT_TRUE(b.run().has_value());
  EXPECT_NEAR(b.report.common_scale.mean, 1.0 / 1.01 - 1.0, 2e-4);
}

/// An axis that is far off turns the frame of all, so that others leave their bounds with it.
TEST(CalibrationRefusal, TheAxisThatIsFarOffIsReportedAndNoOther) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    for (int sensor = 0; sensor < 4; ++sensor) {
      Bench b;
      b.noise = Noise(seed);
      b.truth = draw_truth(b.sheet, b.noise);
      b.stations = random_stations(b.sheet, b.truth, 48, b.noise, kSigma);
      Vec3& axis = b.sheet.sensor[at(sensor)].row.axis;
      const Vec3 across = plumb::cross(axis, b.noise.direction());
      axis = turned(axis, plumb::scaled(across, plumb::rad_from_deg(30.0) / plumb::norm(across)));
      const auto c = b.run();
      ASSERT_FALSE(c.has_value()) << seed;
      EXPECT_EQ(c.error().code, plumb::Errc::implausible) << seed;
      EXPECT_EQ(c.error().index, sensor) << seed;
      EXPECT_EQ(b.report.suspects, plumb::SensorSet().with(sensor)) << seed;
    }
  }
}

TEST(CalibrationRefusal, WhereTwoExplainItAsWellNeitherIsReported) {
  // The axes are hardly known, so that one far off may as well be the others turned about it.
  Bench b;
  for (int i = 0; i < 4; ++i) b.sheet.sensor[at(i)].prior.axis_rad = 0.3;
  Vec3& axis = b.sheet.sensor[1].row.axis;
  const Vec3 across = plumb::cross(axis, Vec3{0.0, 0.0, 1.0});
  axis = turned(axis, plumb::scaled(across, plumb::rad_from_deg(30.0) / plumb::norm(across)));
  const auto c = b.run();
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, plumb::Errc::implausible);
  EXPECT_EQ(c.error().index, -1);
  EXPECT_TRUE(b.report.suspects.has(1));
  EXPECT_GT(b.report.suspects.size(), 1);
}

TEST(CalibrationRefusal, DatasheetThatIsNoArray) {
  Bench twin;
  twin.sheet.sensor[1].row.id = twin.sheet.sensor[0].row.id;
  EXPECT_EQ(twin.refusal(), plumb::Errc::duplicate_id);
  Bench flat;
  for (int i = 0; i < 4; ++i) {
    const double a = 0.5 * i;
    flat.sheet.sensor[at(i)].row.axis = {std::cos(a), std::sin(a), 0.0};
  }
  EXPECT_EQ(flat.refusal(), plumb::Errc::axes_rank_deficient);
  Bench crowd;
  crowd.sheet.size = plumb::kCapacity + 1;
  EXPECT_EQ(crowd.refusal(), plumb::Errc::too_many_sensors);
  Bench silent;
  silent.sheet.sensor[2].row.sigma_mps2 = 0.0;
  EXPECT_EQ(silent.refusal(), plumb::Errc::sigma_not_positive);
}

TEST(CalibrationRefusal, EveryStopReasonHasAName) {
  for (const plumb::StopReason r :
       {plumb::StopReason::none, plumb::StopReason::converged, plumb::StopReason::iteration_limit,
        plumb::StopReason::no_descent, plumb::StopReason::not_finite}) {
    EXPECT_STRNE(plumb::to_string(r), "unknown");
  }
  EXPECT_STREQ(plumb::to_string(static_cast<plumb::StopReason>(99)), "unknown");
}

}  // namespace
}  // namespace calibration_refusal_test
