/// Where a fit starts: with the closed form it gets there from anywhere, in fewer iterations (docs/theory.md,
/// section 9.3).
#include <gtest/gtest.h>

#include <cmath>

#include "calibration_support.hpp"

namespace closed_form_test {
namespace {

using namespace calibration_test;

constexpr double kSigma = 2e-4 * plumb::kG0_mps2;

plumb::Expected<plumb::Calibration> fit(const plumb::Datasheet& d, const std::vector<plumb::Station>& stations,
                                        const plumb::FitOptions& options = {}, plumb::FitReport* report = nullptr) {
  return plumb::calibrate(d, standard_gravity(), stations.data(), static_cast<int>(stations.size()), options, report);
}

plumb::FitOptions lenient(plumb::FitStart start) {
  plumb::FitOptions o;
  o.start = start;
  o.estimate_misfit = false;
  o.max_bias_sigmas = 1000.0;
  o.max_scale_change = 3.0;
  o.max_axis_change_rad = 1.5;
  return o;
}

plumb::Datasheet tool_of(int n) {
  plumb::AxisList axes{};
  if (n == 3) {
    plumb::orthogonal_triad(axes);
  } else if (n == 4) {
    plumb::paper_tetrahedron(axes);
  } else {
    plumb::cone_with_axis(axes, n);
  }
  return datasheet_of(axes, n, kSigma);
}

/// 500 tools whose parameters lie `spread` times as far off as a datasheet's (bias within 0.02 g0, scale within 2 %,
/// two tilts within 1 deg each); the datasheet knows no better than 1x. Returns the most iterations.
int converges(int n, double spread, plumb::FitStart start) {
  int most = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Noise noise(seed);
    const plumb::Datasheet d = tool_of(n);
    const Truth truth = draw_truth(d, noise, spread, plumb::rad_from_deg(spread));
    const auto c = fit(d, random_stations(d, truth, 48, noise, kSigma), lenient(start));
    EXPECT_TRUE(c.has_value()) << n << " sensors, " << spread << "x, seed " << seed;
    if (!c) continue;
    // The right one: what is left is noise, and the tool says where down is.
    EXPECT_LE(c->report.chi2, 3.0 * c->report.degrees_of_freedom) << n << " sensors, " << spread << "x, seed " << seed;
    EXPECT_LE(sphere_error(d, truth, *c).tilt_rad, 1.5e-3) << n << " sensors, " << spread << "x, seed " << seed;
    EXPECT_EQ(c->report.start, start == plumb::FitStart::datasheet ? start : plumb::FitStart::closed_form);
    most = std::max(most, c->report.iterations);
  }
  std::cout << "[ measured ] n = " << n << ", " << spread << "x from the " << plumb::to_string(start)
            << ": most iterations " << most << '\n';
  return most;
}

TEST(FitStart, FromTheClosedFormEveryToolConvergesAndUsuallyInThree) {
  for (const int n : {3, 4}) {
    for (const double spread : {1.0, 10.0}) EXPECT_LE(converges(n, spread, plumb::FitStart::automatic), 3);
    converges(n, 20.0, plumb::FitStart::automatic);  // a prior at 35 sigma may take its time over the frame
  }
}

TEST(FitStart, FromTheDatasheetInSix) {
  for (const int n : {3, 4}) {
    EXPECT_LE(converges(n, 1.0, plumb::FitStart::datasheet), 6);
    converges(n, 10.0, plumb::FitStart::datasheet);
  }
}

TEST(FitStart, BothEndAtTheSamePlace) {
  for (const int n : {3, 4, plumb::kCapacity}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Noise noise(seed);
      const plumb::Datasheet d = tool_of(n);
      const Truth truth = draw_truth(d, noise);
      const std::vector<plumb::Station> stations = random_stations(d, truth, 48, noise, kSigma);
      const auto one = fit(d, stations, lenient(plumb::FitStart::datasheet));
      const auto two = fit(d, stations, lenient(plumb::FitStart::closed_form));
      ASSERT_TRUE(one.has_value() && two.has_value());
      EXPECT_EQ(one->report.start, plumb::FitStart::datasheet);
      EXPECT_NEAR(one->report.chi2, two->report.chi2, 1e-6 * one->report.chi2);
      for (int i = 0; i < n; ++i) {
        EXPECT_LE(plumb::norm(plumb::minus(one->array.axis(i), two->array.axis(i))), 1e-7) << n << " " << seed;
      }
    }
  }
}

TEST(FitStart, WithoutFullRankTheDatasheetItIs) {
  Noise noise(2);
  const plumb::Datasheet d = tool_of(4);
  const Truth truth = draw_truth(d, noise);
  plumb::FitOptions o;
  o.require_full_rank = false;
  const std::vector<std::vector<double>> sets = {{0.0}, {30.0}, {30.0, 60.0}};
  for (const auto& inclinations : sets) {
    std::vector<plumb::Station> stations;
    for (const double inclination : inclinations) {
      for (int k = 0; k < 24; ++k)
        stations.push_back(station_at(d, truth, rolled(inclination, 15.0 * k), noise, kSigma));
    }
    const auto c = fit(d, stations, o);
    ASSERT_TRUE(c.has_value()) << inclinations.size();
    EXPECT_EQ(c->report.start, plumb::FitStart::datasheet) << inclinations.size();
  }
}

TEST(FitStart, FrozenParametersStayWhereTheyAre) {
  Noise noise(3);
  plumb::Datasheet d = tool_of(4);
  const Truth truth = draw_truth(d, noise);
  d.sensor[2].prior.axis_rad = 0.0;
  plumb::FitOptions o = lenient(plumb::FitStart::closed_form);
  o.require_full_rank = false;
  plumb::FitReport report;
  (void)fit(d, random_stations(d, truth, 48, noise, kSigma), o, &report);
  EXPECT_EQ(report.start, plumb::FitStart::datasheet);
}

TEST(FitStart, EveryStartHasAName) {
  EXPECT_STREQ(plumb::to_string(plumb::FitStart::automatic), "automatic");
  EXPECT_STREQ(plumb::to_string(plumb::FitStart::datasheet), "datasheet");
  EXPECT_STREQ(plumb::to_string(plumb::FitStart::closed_form), "closed form");
  EXPECT_STREQ(plumb::to_string(static_cast<plumb::FitStart>(99)), "unknown");
}

TEST(FitStart, WithThePriorEveryStationSetConverges) {
  // docs/theory.md, section 9.1: from one station rolled in place to the uniform sphere.
  const std::vector<std::pair<std::vector<double>, int>> sets = {{{0.0}, 24},
                                                                 {{30.0}, 24},
                                                                 {{30.0, 60.0}, 12},
                                                                 {{0.0, 45.0, 90.0}, 8},
                                                                 {{30.0, 45.0, 60.0}, 8},
                                                                 {{80.0, 85.0, 90.0}, 8},
                                                                 {{10.0, 20.0, 30.0}, 8},
                                                                 {{0, 10, 20, 30, 40, 50, 60, 70, 80, 90}, 5}};
  plumb::FitOptions o;
  o.require_full_rank = false;
  for (const int n : {3, 4}) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      Noise noise(seed);
      const plumb::Datasheet d = tool_of(n);
      const Truth truth = draw_truth(d, noise);
      for (const auto& set : sets) {
        std::vector<plumb::Station> stations;
        for (const double inclination : set.first) {
          for (int k = 0; k < set.second; ++k) {
            stations.push_back(station_at(d, truth, rolled(inclination, 360.0 * k / set.second), noise, kSigma));
          }
        }
        plumb::FitReport report;
        EXPECT_TRUE(fit(d, stations, o, &report).has_value())
            << n << " sensors, first inclination " << set.first[0] << ", seed " << seed << ": "
            << plumb::to_string(report.stop);
      }
      for (const int count : {9, 12, 24, 48, 100}) {
        plumb::FitReport report;
        EXPECT_TRUE(fit(d, random_stations(d, truth, count, noise, kSigma), o, &report).has_value())
            << n << " sensors, " << count << " at random, seed " << seed << ": " << plumb::to_string(report.stop);
      }
    }
  }
}

}  // namespace
}  // namespace closed_form_test
