// Edges of the fit over temperature: levels, options and stations that are none, and fits that do not end well.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "calibration/temperature_support.hpp"

namespace temperature_edges_test {
namespace {

using namespace temperature_test;
using plumb::Errc;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Bench {
  plumb::Datasheet sheet = paper_sheet();
  Noise noise{81};
  Truth truth = temperature_test::draw_truth(sheet, noise);
  std::vector<plumb::Station> on(int levels) { return on_levels(truth, levels_of(levels), noise); }
};

std::vector<plumb::Station> at_degc(const std::vector<double>& degc) {
  std::vector<plumb::Station> out;
  for (const double t : degc) {
    plumb::Station s;
    s.count = 1;
    s.temperature_degc = t;
    out.push_back(s);
  }
  return out;
}

plumb::TemperatureLevels levels_at(const std::vector<plumb::Station>& stations) {
  return plumb::temperature_levels(stations.data(), static_cast<int>(stations.size()));
}

TEST(TemperatureLevels, OfMoreThanAreKeptTheLowestAreKept) {
  std::vector<double> degc;
  for (int k = 0; k < plumb::kMaxTemperatureLevels + 4; ++k) degc.push_back(-100.0 + 20.0 * k);
  const plumb::TemperatureLevels levels = levels_at(at_degc(degc));
  EXPECT_EQ(levels.count, plumb::kMaxTemperatureLevels);
  EXPECT_EQ(levels.degc[0], -100.0);
  EXPECT_EQ(levels.highest_degc, degc.back());
}

TEST(TemperatureLevels, WhereEveryStationIsAloneTheLevelsAreTheSpan) {
  auto stations = at_degc({20.0, 60.0, 100.0, kNan});
  const plumb::TemperatureLevels levels = levels_at(stations);
  const plumb::ChebyshevSpan span = plumb::confirmed_span(stations.data(), 4, levels);
  EXPECT_EQ(span.lowest, 20.0);
  EXPECT_EQ(span.highest, 100.0);
  stations[1].count = 0;
  EXPECT_EQ(plumb::confirmed_span(stations.data(), 4, levels).highest, 100.0);
}

TEST(TemperatureLevels, TheFullestMayBeAnyOfThem) {
  const auto stations = at_degc({20.0, 60.0, 61.0, 100.0});
  const plumb::ChebyshevSpan span = plumb::fullest_level(stations.data(), 4, levels_at(stations));
  EXPECT_EQ(span.lowest, 60.0);
  EXPECT_EQ(span.highest, 61.0);
}

TEST(TemperatureLevels, NoMoreAreAskedForThanThereIsRoomToSay) {
  std::array<double, plumb::kMaxTemperatureOrder + 1> degc{};
  const plumb::TemperatureLevels none;
  EXPECT_EQ(plumb::missing_levels(none, {20.0, 150.0}, 20, degc), plumb::kMaxTemperatureOrder + 1);
  for (std::size_t k = 1; k < degc.size(); ++k) EXPECT_GT(degc[k], degc[k - 1]);
  const auto stations = at_degc({20.0, 20.0});
  EXPECT_EQ(plumb::missing_levels(levels_at(stations), {20.0, 150.0}, 4, degc), 3);
  EXPECT_LT(degc[0], degc[1]);
  EXPECT_LT(degc[1], degc[2]);
}

TEST(TemperatureEdge, OptionsAndPriorsThatAreNoneAreRefused) {
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

TEST(TemperatureEdge, AnAutomaticOrderOfAtMostZeroIsTheFitWithoutTemperature) {
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
TEST(TemperatureEdge, WithoutStationsOrAnEndThereIsNoFit) {
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
TEST(TemperatureEdge, NumbersThatAreNoneAreRefused) {
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

TEST(TemperatureEdge, WithoutFreedomNothingIsJudgedByTheResiduals) {
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
TEST(TemperatureEdge, OutliersBeyondTheListAreCounted) {
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
TEST(TemperatureEdge, ADatasheetTakesTheTermsThatThereAre) {
  Bench b;
  const Fit f = fit_of(b.sheet, b.on(3), options_of(1));
  ASSERT_TRUE(f.made.has_value());
  plumb::Calibration three = *f.made;
  three.model.size = 3;
  const plumb::Datasheet out = plumb::with_temperature_of(b.sheet, three);
  EXPECT_NE(out.sensor[2].coefficients.scale[1], b.sheet.sensor[2].coefficients.scale[1]);
  EXPECT_EQ(out.sensor[3].coefficients.scale[1], b.sheet.sensor[3].coefficients.scale[1]);
}

}  // namespace
}  // namespace temperature_edges_test
