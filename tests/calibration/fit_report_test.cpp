// What the report of a fit says beside the fit itself, each figure asked by itself: ranks, bounds, turns, twins.
#include "../../src/calibration/fit_report.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "calibration/fit_scene.hpp"
#include "plumb/calibration/null_directions.hpp"
#include "plumb/calibration/observability.hpp"

namespace fit_report_test {
namespace {

using namespace calibration_test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

constexpr int kSize = 12;  // four parameters for each of three
using Information = std::array<double, std::size_t{kSize} * kSize>;

/// Half of sqrt(2) where a rotation about axis q moves a component of an axis of the triad.
Parameters rotation(int q) {
  Parameters out{};
  for (int i = 0; i < 3; ++i) {
    Vec3 e{};
    e[at(q)] = 1.0;
    Vec3 h{};
    h[at(i)] = 1.0;
    const Vec3 d = cross(h, e);
    for (int p = 0; p < 3; ++p) out[at(4 * i + p)] = d[at(p)] / std::sqrt(2.0);
  }
  return out;
}

/// `all` in every direction but the rotations; `own` in each of these, and `shared` between any two.
Information information_of(double all, double own, double shared) {
  Information m{};
  for (int k = 0; k < kSize; ++k) m[at(k * kSize + k)] = all;
  for (int q = 0; q < 3; ++q) {
    for (int r = 0; r < 3; ++r) {
      const Parameters a = rotation(q), b = rotation(r);
      for (int i = 0; i < kSize; ++i) {
        for (int j = 0; j < kSize; ++j) {
          m[at(i * kSize + j)] += a[at(i)] * b[at(j)] * (q == r ? own - all : shared);
        }
      }
    }
  }
  return m;
}

bool analysed(Information m, double floor, FitReport& report) {
  const Datasheet sheet = triad();
  Information scratch{};
  const Parameters theta = fit::datasheet_parameters(sheet);
  return fit::analyse(sheet, {}, fit::prior_roots(sheet), theta, floor, m.data(), scratch.data(), report);
}

TEST(FitReport, TheGaugeIsCountedByWhatIsThere) {
  FitReport plain, none, full, shared;
  ASSERT_TRUE(analysed(information_of(1e6, 0.0, 0.0), 1e-4, plain));
  EXPECT_EQ(plain.rank, 9);
  EXPECT_EQ(plain.gauge, 3);
  EXPECT_EQ(plain.null_directions, 0);
  ASSERT_TRUE(analysed(information_of(0.0, 0.0, 0.0), 1e-4, none));
  EXPECT_EQ(none.rank, 0);
  EXPECT_EQ(none.gauge + none.null_directions, kSize);
  EXPECT_NEAR(none.data_share[3], 0.0, 1e-12);
  ASSERT_TRUE(analysed(information_of(1e6, 1e6, 0.0), 1e-4, full));
  EXPECT_EQ(full.rank, kSize) << "rotations that something sees are no gauge";
  EXPECT_EQ(full.gauge, 0);
  // Each rotation alone below the threshold, their sum above it: two are left.
  ASSERT_TRUE(analysed(information_of(1e6, 90.0, 90.0), 1e-4, shared));
  EXPECT_EQ(shared.rank, 10);
  EXPECT_EQ(shared.gauge, 2);
  EXPECT_EQ(shared.null_directions, 0);
}

TEST(FitReport, InformationBelowZeroHasNoInverse) {
  FitReport report;
  EXPECT_FALSE(analysed(information_of(1e6, -5.0, 0.0), 1e-4, report));
}

/// Neither that of a fit, nor that of bias and scale alone.
// Negative: REQ-034
TEST(FitReport, InformationThatIsNoNumberHasNoRank) {
  FitReport report;
  Information m = information_of(1e6, 0.0, 0.0);
  m[at(5 * kSize + 2)] = kNan;
  EXPECT_FALSE(analysed(m, 1e-4, report));
  fit::Blocks blocks{};
  EXPECT_EQ(fit::rank_of_held(triad(), blocks.data(), 1e-4), 0);
  blocks[at(2 * fit::kMomentCount - 1)] = kNan;
  EXPECT_EQ(fit::rank_of_held(triad(), blocks.data(), 1e-4), -1);
}

/// A bias that is no number is named, and not the one that is merely far off.
// Negative: REQ-034
TEST(FitReport, AValueThatIsNoNumberIsWorseThanAnyOther) {
  Scene s;
  s.theta[at(4 * 1 + 3)] = kNan;
  s.theta[at(4 * 2 + 3)] = 1e3 * s.options.max_bias_sigmas;
  SensorSet suspects;
  const Error worst = fit::implausible(s.sheet, {}, s.options, s.theta, suspects);
  EXPECT_EQ(worst.code, Errc::implausible);
  EXPECT_EQ(worst.index, 1);
  EXPECT_TRUE(std::isnan(worst.value));
}

TEST(FitReport, AxesAlongTheRollAxisDoNotTurnAboutIt) {
  Scene s;
  fit::Roll roll;
  roll.used = true;
  Parameters along{}, change{};
  for (int i = 0; i < 3; ++i) along[at(4 * i + 2)] = 1.0;
  change[0] = 1e-3;
  EXPECT_EQ(norm(fit::remove_rotation(along, 3, roll, change)), 0.0);
  EXPECT_EQ(change[0], 1e-3);
}

/// One line of axes knows no turn across it; axes that have not turned at all are one with the nominal ones.
TEST(FitReport, TheCommonTurnOfAxesOnOneLineIsUnknown) {
  Scene s;
  const CommonTurn none = fit::common_turn(s.sheet, {0.0, 0.0, 1.0}, s.theta);
  EXPECT_EQ(none.rad, 0.0);
  EXPECT_GT(none.sigma_rad, 0.0);
  EXPECT_EQ(none.sensor, -1);
  for (int i = 0; i < 3; ++i) s.sheet.sensor[at(i)].row.axis = {0.0, 0.0, 1.0};
  const CommonTurn line = fit::common_turn(s.sheet, {0.0, 0.0, 1.0}, fit::datasheet_parameters(s.sheet));
  EXPECT_EQ(line.rad, 0.0);
  EXPECT_EQ(line.sensor, -1);
  // Two axes along the roll axis: without the third nothing is felt of a turn about it.
  Scene two;
  two.sheet.sensor[1].row.axis = {0.0, 0.0, 1.0};
  Parameters turned = fit::datasheet_parameters(two.sheet);
  turned[1] = 0.01;
  const CommonTurn lone = fit::common_turn(two.sheet, {0.0, 0.0, 1.0}, turned);
  EXPECT_TRUE(std::isfinite(lone.rad));
}

TEST(FitReport, ATurnThatExplainsOnlyAPartIsReportedBySensor) {
  Scene s;
  fit::Roll roll;
  roll.used = true;
  s.options.max_axis_change_rad = 0.02;
  const double c = std::cos(0.05), n = std::sin(0.05);
  // All axes turned about x, which the roll axis z does not allow.
  s.theta[at(4 * 1 + 1)] = s.theta[at(4 * 2 + 2)] = c;
  s.theta[at(4 * 1 + 2)] = n;
  s.theta[at(4 * 2 + 1)] = -n;
  SensorSet suspects;
  const Error together = fit::implausible(s.sheet, roll, s.options, s.theta, suspects);
  EXPECT_EQ(together.code, Errc::implausible);
  EXPECT_EQ(together.index, -1);
  s.theta[3] = 2.0 * s.options.max_bias_sigmas;
  const Error own = fit::implausible(s.sheet, roll, s.options, s.theta, suspects);
  EXPECT_EQ(own.code, Errc::implausible);
  EXPECT_GE(own.index, 0) << "a bias that no turn takes away";
}

TEST(FitReport, AFewOutlierStationsOfThreeSensorsAreReported) {
  const Scene s;
  FitFigures figures;
  figures.outliers = 1;
  figures.degrees_of_freedom = 7;
  figures.p_value = 1.0;
  EXPECT_EQ(fit::doubtful_screening(s.sheet, figures).code, Errc::poor_fit);
  figures.degrees_of_freedom = 8;
  EXPECT_EQ(fit::doubtful_screening(s.sheet, figures).code, Errc::ok);
}

TEST(FitReport, StationsWithoutSamplesReportNoTwins) {
  Scene s;
  for (Station& station : s.stations) station.mean = {4.0, 4.0, 4.0};
  EXPECT_EQ(fit::twin_channels(s.problem()).code, Errc::implausible);
  for (Station& station : s.stations) station.count = 0;
  EXPECT_EQ(fit::twin_channels(s.problem()).code, Errc::ok);
}

TEST(FitReport, AnInclinationThatNoStationShowsHasNoSigma) {
  Scene s;
  s.stations[0].roll_group = s.stations[1].roll_group = 3;
  Expected<SensorArray> array = s.sheet.array();
  ASSERT_TRUE(array.has_value());
  plumb::RowUncertainty u;
  for (int a = 0; a < kSize; ++a) u.covariance[at(a * (a + 1) / 2 + a)] = 1e-6;
  array->set_uncertainty(u);
  const fit::Problem problem = s.problem();
  ASSERT_TRUE(problem.roll.used);
  const double all = fit::inclination_sigma(problem, s.theta, *array);
  EXPECT_GT(all, 0.0);
  s.stations[4].count = 0;
  EXPECT_NE(fit::inclination_sigma(problem, s.theta, *array), all);
  for (Station& station : s.stations) station.count = 0;
  EXPECT_EQ(fit::inclination_sigma(problem, s.theta, *array), 0.0);
}

TEST(FitReport, StationsWithoutSamplesAreOfNoLevel) {
  Scene s;
  std::vector<Station> all;
  for (int k = 0; k < 12; ++k) {
    for (Station station : s.stations) {
      station.temperature_degc = k % 2 == 0 ? 20.0 : 60.0;
      if (k % 2 == 0) station.mean[0] += 5.0;
      all.push_back(station);
    }
  }
  s.stations = all;
  const LevelMisfit before = fit::level_misfit(s.problem(), s.theta, s.stations.data(), 0.0);
  EXPECT_EQ(before.sensor, 0);
  for (std::size_t k = 0; k < 6; ++k) s.stations[k].count = 0;
  const LevelMisfit after = fit::level_misfit(s.problem(), s.theta, s.stations.data(), 0.0);
  EXPECT_EQ(after.sensor, 0);
  EXPECT_GT(after.sigma_mps2, before.sigma_mps2) << "fewer stations say it";
}

/// A rotation in which the axes of two sensors alone move is named by these, not as one of all; and three axes that
/// move without a common turn are none.
TEST(NullCombinations, WhatIsNoRotationOfAllIsNotCalledOne) {
  const Datasheet sheet = triad();
  FitReport report;
  report.parameters = kSize;
  report.null_directions = 1;
  const auto combination = [&](const Parameters& direction) {
    report.null_direction[0].component = direction;
    auto out = std::make_unique<NullCombinations>();
    EXPECT_EQ(null_combinations(sheet, report, *out), 1);
    return (*out)[0];
  };
  const NullCombination pair = combination(rotation(0));
  EXPECT_FALSE(pair.rotates_all);
  EXPECT_EQ(pair.terms, 2);
  Parameters all{};
  for (int q = 0; q < 3; ++q) {
    for (int k = 0; k < kSize; ++k) all[at(k)] += rotation(q)[at(k)] / std::sqrt(3.0);
  }
  EXPECT_TRUE(combination(all).rotates_all);
  Parameters bent = all;
  bent[1] = -bent[1];
  EXPECT_FALSE(combination(bent).rotates_all);
}

}  // namespace
}  // namespace fit_report_test
