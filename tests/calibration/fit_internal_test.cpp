// The sums of a fit, each part asked by itself: stations that do not count, readings whose squares are no numbers.
#include "../../src/calibration/fit_internal.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>

#include "calibration/fit_scene.hpp"
#include "plumb/calibration/observability.hpp"

namespace fit_internal_test {
namespace {

using namespace calibration_test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kSize = 12;  // four parameters for each of three
using Information = std::array<double, std::size_t{kSize} * kSize>;

/// A length that is a number, and in units of its noise none.
// Negative: REQ-034
TEST(StationSolver, AResidualBeyondAllNumbersIsNotUsed) {
  Scene s;
  for (int i = 0; i < 3; ++i) s.sheet.sensor[at(i)].row.sigma_mps2 = 1e-3;
  const fit::Problem problem = s.problem();
  fit::StationSolver solver(problem, s.theta, 0.0);
  EXPECT_EQ(solver.solve(s.stations[0]), fit::Loaded::used);
  Station far = s.stations[0];
  far.mean[0] = 1e153;
  EXPECT_EQ(solver.read(far), fit::Loaded::used);
  EXPECT_EQ(solver.solve(far), fit::Loaded::not_finite);
}

TEST(FitTally, SumsWithoutAStationAreNothing) {
  fit::Harmonics harmonics;
  const fit::FitTally empty;
  EXPECT_EQ(empty.excitation(), 0.0);
  EXPECT_EQ(empty.direction_variance(), 0.0);
  EXPECT_EQ(fit::FitTally(&harmonics).excitation(), 0.0);
  EXPECT_EQ(excitation_of(nullptr, 0), 0.0);
  const Vec3 no_direction = {kNan, 0.0, 1.0};
  EXPECT_EQ(excitation_of(&no_direction, 1), 0.0);
}

/// Residuals of nothing at all, and a median over no degree of freedom.
TEST(MedianMisfit, OfAPerfectToolIsNothing) {
  Scene s;
  EXPECT_EQ(fit::median_misfit<int>(s.problem(), s.theta, 0.25, 0, 1.0), 0.25);
  EXPECT_EQ(fit::median_misfit<int>(s.problem(), s.theta, 0.0, 4, 1.0), 0.0);
  s.stations[1].mean[0] = 4.0;
  EXPECT_GE(fit::median_misfit<int>(s.problem(), s.theta, 0.0, 4, 1.0), 0.0);
}

TEST(Screening, AStationWithoutSamplesIsNeverOut) {
  Scene s;
  fit::Screen screen;
  screen.theta = s.theta;
  fit::Problem problem = s.problem();
  problem.screen = &screen;
  fit::Screening screening(problem);
  Station far = s.stations[0];
  far.mean[1] = 500.0;
  EXPECT_TRUE(screening.out(far));
  far.count = 0;
  EXPECT_FALSE(screening.out(far));
}

/// A group whose only stations are so far off that they have no say has no inclination.
TEST(FitSums, ARollGroupWithoutWeightChangesNothing) {
  Scene s;
  for (std::size_t k = 0; k < 6; ++k) s.stations[k].mean[(k + 1) % 3] += 3.0;
  s.stations[0].roll_group = s.stations[1].roll_group = 7;
  for (const std::size_t k : {0U, 1U}) s.stations[k].mean[k] = 500.0;
  s.stations[5].roll_group = 9;
  s.stations[5].count = 0;
  fit::Problem problem = s.problem();
  EXPECT_TRUE(problem.roll.used);
  EXPECT_EQ(problem.roll.groups, 1) << "a station without samples is in none";
  const auto blocks = std::make_unique<fit::Blocks>();
  const auto roll = std::make_unique<fit::RollSums>();
  Parameters rhs{};
  const fit::Room room = {roll.get(), nullptr, nullptr};
  const fit::Sums sums = fit::accumulate(problem, s.theta, 0.0, fit::Loss::tukey, blocks->data(), rhs, room);
  EXPECT_TRUE(sums.finite);
  ASSERT_EQ(roll->groups, 1);
  EXPECT_EQ(roll->group[0].weight, 0.0);
  EXPECT_EQ(sums.rows, 15) << "five stations of three rows, and none of the group";
  Information with{}, without{};
  const fit::PriorRoots roots = fit::prior_roots(s.sheet);
  fit::expand(blocks->data(), roll.get(), roots, 3, fit::Square{with.data(), kSize});
  fit::expand(blocks->data(), nullptr, roots, 3, fit::Square{without.data(), kSize});
  EXPECT_EQ(with, without);
}

}  // namespace
}  // namespace fit_internal_test
