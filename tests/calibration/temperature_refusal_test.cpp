// What the temperatures of the stations cannot support is refused, and what is missing is named.
#include <gtest/gtest.h>

#include <limits>

#include "calibration/temperature_support.hpp"

namespace temperature_refusal_test {
namespace {

using namespace temperature_test;
using plumb::Errc;
using plumb::ParameterKind;

struct Bench {
  plumb::Datasheet sheet = paper_sheet();
  Noise noise{81};
  Truth truth = temperature_test::draw_truth(sheet, noise);
};

/// The tool lies the flatter the hotter it is: eleven inclinations of six rolls.
std::vector<plumb::Station> well(const Truth& truth, Noise& noise, double sigma_mps2 = kSigma_mps2) {
  std::vector<plumb::Station> out;
  for (int i = 0; i <= 10; ++i) {
    for (int roll = 0; roll < 6; ++roll) {
      const Vec3 g = calibration_test::rolled(9.0 * i, 60.0 * roll + 7.0 * i);
      out.push_back(station_at(truth, g, kLow_degc + 13.0 * i, noise, sigma_mps2));
    }
  }
  return out;
}

TEST(TemperatureRefusal, TooFewLevelsNamesTheMissingOnes) {
  Bench b;
  const auto stations = on_levels(b.truth, {25.0, 60.0}, b.noise);
  const Fit f = fit_of(b.sheet, stations, options_of(3));
  ASSERT_FALSE(f.made.has_value());
  EXPECT_EQ(f.made.error().code, Errc::too_few_levels);
  EXPECT_EQ(f.made.error().value, 2.0);
  EXPECT_EQ(f.made.error().limit, 4.0);
  EXPECT_EQ(f.report.levels.count, 2);
  EXPECT_EQ(f.report.levels.degc[0], 25.0);
  EXPECT_EQ(f.report.levels.degc[1], 60.0);
  ASSERT_EQ(f.report.missing, 2);
  EXPECT_EQ(f.report.missing_degc[0], 105.0);
  EXPECT_EQ(f.report.missing_degc[1], 150.0);
  // With them it is accepted.
  EXPECT_TRUE(fit_of(b.sheet, on_levels(b.truth, {25.0, 60.0, 105.0, 150.0}, b.noise), options_of(3)).made.has_value());
}

/// However little the noise and however wide the span of use: a polynomial is not determined by rounding.
TEST(TemperatureRefusal, WithoutNoiseTheRankIsThatOfTheLevels) {
  Bench b;
  b.sheet = paper_sheet(1e-6 * plumb::kG0_mps2);
  for (int levels = 1; levels <= 4; ++levels) {
    const auto stations = on_levels(b.truth, levels_of(levels, 20.0, 60.0), b.noise, 1e-6 * plumb::kG0_mps2);
    EXPECT_EQ(fit_of(b.sheet, stations, options_of(3)).report.rank, 5 + 8 * levels) << levels;
  }
  EXPECT_LT(fit_of(b.sheet, well(b.truth, b.noise, 1e-6 * plumb::kG0_mps2), options_of(3)).report.rank, 37);
}

TEST(TemperatureRefusal, TemperaturesTooNearAreOneLevel) {
  Bench b;
  // The rank alone would let four temperatures within 12 degC pass for more than one level.
  const auto stations = on_levels(b.truth, {60.0, 64.0, 68.0, 72.0}, b.noise);
  const Fit f = fit_of(b.sheet, stations, options_of(3));
  ASSERT_FALSE(f.made.has_value());
  EXPECT_EQ(f.made.error().code, Errc::too_few_levels);
  EXPECT_EQ(f.report.levels.count, 2);
  EXPECT_GT(f.report.rank, 29);
}

TEST(TemperatureRefusal, AutomaticTakesTheHighestOrderThereIs) {
  Bench b;
  for (int levels = 1; levels <= 5; ++levels) {
    const auto stations = on_levels(b.truth, levels_of(levels), b.noise);
    plumb::TemperatureOptions options = options_of(plumb::kAutomaticOrder);
    options.fit.max_norm_rms_mps2 = 1.0;
    options.fit.max_outlier_share = 1.0;
    const Fit f = fit_of(b.sheet, stations, options);
    ASSERT_TRUE(f.made.has_value()) << levels;
    EXPECT_EQ(f.report.order, std::min(levels - 1, 3));
    EXPECT_EQ(f.report.missing, levels < 4 ? 1 : 0);
    options.max_order = 1;
    EXPECT_EQ(fit_of(b.sheet, stations, options).report.order, std::min(levels - 1, 1));
  }
}

TEST(TemperatureRefusal, LevelsWithFewAttitudesLowerTheAutomaticOrder) {
  Bench b;
  auto stations = on_levels(b.truth, levels_of(3), b.noise);
  // One attitude at a fourth level says little of sixteen numbers.
  stations.push_back(station_at(b.truth, {0.0, 0.0, plumb::kG0_mps2}, 125.0, b.noise));
  const Fit asked = fit_of(b.sheet, stations, options_of(3));
  ASSERT_FALSE(asked.made.has_value());
  EXPECT_EQ(asked.made.error().code, Errc::unobservable);
  EXPECT_EQ(asked.made.error().limit, 37.0);
  EXPECT_GE(asked.made.error().value, 29.0);
  EXPECT_LT(asked.made.error().value, 37.0);
  const Fit automatic = fit_of(b.sheet, stations, options_of(plumb::kAutomaticOrder));
  ASSERT_TRUE(automatic.made.has_value());
  EXPECT_EQ(automatic.report.order, 2);
}

TEST(TemperatureRefusal, NullDirectionsOfMissingLevelsNameOneSensorEach) {
  Bench b;
  const Fit f = fit_of(b.sheet, on_levels(b.truth, {25.0, 60.0}, b.noise), options_of(3));
  ASSERT_EQ(f.report.null_directions, 16);
  std::array<int, 8> named{};
  for (const plumb::TemperatureNull& null : f.report.null) {
    ASSERT_GE(null.terms, 1);
    const plumb::TemperatureTerm& first = null.term[0];
    int highest = 0;
    for (int k = 0; k < null.terms; ++k) {
      // A scale of order 0 is the length of W; the tilted axis has a little of it across.
      const bool own = null.term[at(k)].sensor == first.sensor;
      EXPECT_TRUE(own);
      highest = std::max(highest, null.term[at(k)].order);
    }
    EXPECT_GE(highest, 2);
    ++named[at(2 * first.sensor + (first.kind == ParameterKind::bias ? 1 : 0))];
  }
  for (const int count : named) EXPECT_EQ(count, 2);
}

TEST(TemperatureRefusal, TemperatureThatFollowsTheInclinationIsNoSecondVariable) {
  Bench b;
  const Fit f = fit_of(b.sheet, well(b.truth, b.noise), options_of(3));
  ASSERT_FALSE(f.made.has_value());
  EXPECT_EQ(f.made.error().code, Errc::unobservable);
  EXPECT_TRUE(f.report.follows_inclination);
  EXPECT_LE(f.report.rank, 34);
  ASSERT_GE(f.report.null_directions, 3);
  for (int k = 0; k < std::min(f.report.null_directions, plumb::kMaxNullDirections); ++k) {
    EXPECT_GE(f.report.null[at(k)].terms, 2) << "a sensor alone is determined at eleven levels";
  }
  // The same attitudes and temperatures in another order of temperatures: determined.
  auto shuffled = well(b.truth, b.noise);
  std::vector<plumb::Station> mixed;
  for (int i = 0; i <= 10; ++i) {
    for (int roll = 0; roll < 6; ++roll) {
      const Vec3 g = calibration_test::rolled(9.0 * i, 60.0 * roll + 7.0 * i);
      mixed.push_back(station_at(b.truth, g, kLow_degc + 13.0 * ((3 * i + 5 * roll) % 11), b.noise));
    }
  }
  const Fit free = fit_of(b.sheet, mixed, options_of(3));
  EXPECT_TRUE(free.made.has_value());
  EXPECT_FALSE(free.report.follows_inclination);
  EXPECT_EQ(free.report.rank, 37);
}

TEST(TemperatureRefusal, OptionsOutOfRange) {
  Bench b;
  const auto stations = on_levels(b.truth, levels_of(4), b.noise);
  const auto refused = [&](const plumb::TemperatureOptions& options) {
    const Fit f = fit_of(b.sheet, stations, options);
    return f.made ? plumb::Error{} : f.made.error();
  };
  for (const int order : {-2, 4})
    EXPECT_EQ(refused(options_of(order)), (plumb::Error{Errc::out_of_range, 2, 0.0, 0.0}));
  plumb::TemperatureOptions highest = options_of(plumb::kAutomaticOrder);
  highest.max_order = 4;
  EXPECT_EQ(refused(highest), (plumb::Error{Errc::out_of_range, 2, 0.0, 0.0}));
  for (const double high : {25.0, 15.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_EQ(refused(options_of(3, 20.0, high)), (plumb::Error{Errc::out_of_range, 3, 0.0, 0.0})) << high;
  }
  b.sheet.sensor[1].prior.scale_t[2] = 0.0;
  EXPECT_EQ(refused(options_of(3)), (plumb::Error{Errc::out_of_range, 4, 0.0, 0.0}));
  EXPECT_EQ(refused(options_of(2)).code, Errc::ok);
}

TEST(TemperatureRefusal, WhatTheFitAtOneTemperatureRefusesToo) {
  Bench b;
  auto stations = on_levels(b.truth, levels_of(4), b.noise);
  const std::vector<plumb::Station> few(stations.begin(), stations.begin() + 8);
  EXPECT_EQ(fit_of(b.sheet, few, options_of(3)).made.error().code, Errc::too_few_stations);
  stations[5].temperature_degc = std::nan("");
  const Fit lost = fit_of(b.sheet, stations, options_of(3));
  ASSERT_FALSE(lost.made.has_value());
  EXPECT_EQ(lost.made.error().code, Errc::diverged);
  EXPECT_EQ(lost.made.error().index, 5);
  plumb::Datasheet broken = b.sheet;
  broken.sensor[2].coefficients.scale[0] = 0.0;
  EXPECT_EQ(fit_of(broken, stations, options_of(3)).made.error().code, Errc::not_finite);
}

TEST(TemperatureRefusal, AScaleThatBendsBeyondItsBoundIsImplausible) {
  Bench b;
  b.truth.model.sensor[3].scale[1] = 5e-3 * b.truth.model.sensor[3].scale[0];  // 60 % over the span
  for (auto& s : b.sheet.sensor) s.prior.scale_t[0] = 5e-3;
  const auto stations = on_levels(b.truth, levels_of(4), b.noise);
  const Fit f = fit_of(b.sheet, stations, options_of(3));
  ASSERT_FALSE(f.made.has_value());
  EXPECT_EQ(f.made.error().code, Errc::implausible);
  EXPECT_EQ(f.made.error().index, 3);
}

TEST(TemperatureLevels, AreSortedApartAndCounted) {
  std::vector<plumb::Station> stations(7);
  const double degc[] = {80.0, 21.0, 20.0, 29.9, 30.0, 85.0, std::numeric_limits<double>::quiet_NaN()};
  for (std::size_t k = 0; k < stations.size(); ++k) {
    stations[k].temperature_degc = degc[k];
    stations[k].count = 1;
  }
  plumb::TemperatureLevels l = plumb::temperature_levels(stations.data(), 7);
  ASSERT_EQ(l.count, 3);
  EXPECT_NEAR(l.degc[0], (20.0 + 21.0 + 29.9) / 3.0, 1e-12);
  EXPECT_EQ(l.stations[0], 3);
  EXPECT_EQ(l.degc[1], 30.0);
  EXPECT_EQ(l.degc[2], 82.5);
  EXPECT_EQ(l.lowest_degc, 20.0);
  EXPECT_EQ(l.highest_degc, 85.0);
  stations[4].count = 0;
  EXPECT_EQ(plumb::temperature_levels(stations.data(), 7).count, 2);
  EXPECT_EQ(plumb::temperature_levels(nullptr, 7).count, 0);
}

/// Roll groups fix a frame of their own, and the fit over temperature keeps that of the datasheet.
TEST(TemperatureRefusal, RollGroupsStayAtOrderZero) {
  Bench b;
  std::vector<plumb::Station> stations = on_levels(b.truth, {25.0, 60.0, 105.0, 150.0}, b.noise);
  stations[0].roll_group = stations[1].roll_group = 1;
  const Fit asked = fit_of(b.sheet, stations, options_of(1));
  ASSERT_FALSE(asked.made.has_value());
  EXPECT_EQ(asked.made.error(), (plumb::Error{Errc::out_of_range, 5, 0.0, 0.0}));
  EXPECT_TRUE(asked.report.rolls);
  const Fit chosen = fit_of(b.sheet, stations, options_of(plumb::kAutomaticOrder));
  EXPECT_EQ(chosen.report.order, 0);
  EXPECT_EQ(chosen.report.missing, 0);
  // One station in a group says nothing of a frame.
  stations[1].roll_group = 0;
  EXPECT_FALSE(fit_of(b.sheet, stations, options_of(1)).report.rolls);
}

}  // namespace
}  // namespace temperature_refusal_test
