// What moves the whole path at once: an alignment's rotation, sag, and errors of the measured depth.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "plumb/survey/survey_run.hpp"
#include "simulated_survey.hpp"
#include "turned_tool.hpp"

namespace carried_errors_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;
using namespace turned_tool;

std::vector<PathStationErrors> arc(double radius_m, double end_rad, int steps) {
  std::vector<PathStationErrors> out;
  for (int k = 0; k <= steps; ++k) {
    PathStationErrors at;
    const double angle = end_rad * k / steps;
    // A hair off vertical: the first station has an azimuth.
    at.station = {2000.0 + radius_m * angle, angle, true, 0.0};
    out.push_back(at);
  }
  return out;
}

std::vector<PathStationErrors> tangent(double inclination_rad, double from_m, int stations) {
  std::vector<PathStationErrors> out;
  for (int k = 0; k < stations; ++k) {
    PathStationErrors at;
    at.station = {from_m + 30.0 * k, inclination_rad, true, 0.0};
    out.push_back(at);
  }
  return out;
}

double sigma(const PositionCovariance& c, std::size_t k) { return std::sqrt(c[4 * k]); }

CommonErrors sagging(double rad) {
  CommonErrors out;
  out.sag_sigma_rad = rad;
  return out;
}

// Verifies: REQ-250
TEST(Sag, OfATangentIsASectorOfItsLength) {
  const double inclination = rad_from_deg(60.0), sag = rad_from_deg(0.1);
  const auto found = position_covariances(tangent(inclination, 1500.0, 11), sagging(sag));
  const double across = 300.0 * sag * std::sin(inclination);
  EXPECT_NEAR(sigma(found[10], 0), across * std::cos(inclination), 1e-12);
  EXPECT_NEAR(sigma(found[10], 2), across * std::sin(inclination), 1e-12);
  EXPECT_NEAR(found[10][2], -across * across * std::cos(inclination) * std::sin(inclination), 1e-12);
  EXPECT_EQ(sigma(found[10], 1), 0.0);
}

// Verifies: REQ-250
TEST(Sag, OfAnArcIsItsIntegral) {
  // North and depth by integral of R (cos I, -sin I) sin I dI from 0 to 90 deg: R / 2 and -R pi / 4.
  const double radius = 500.0, sag = 1e-3;
  const auto found = position_covariances(arc(radius, 0.5 * kPi, 900), sagging(sag));
  EXPECT_NEAR(sigma(found.back(), 0), 0.5 * radius * sag, 1e-6);
  EXPECT_NEAR(sigma(found.back(), 2), 0.25 * kPi * radius * sag, 1e-6);
}

TEST(Sag, OfAVerticalHoleIsNone) {
  const auto found = position_covariances(tangent(0.0, 0.0, 11), sagging(1e-3));
  EXPECT_EQ(found.back(), PositionCovariance{});
}

// Verifies: REQ-250
TEST(DepthErrors, OfATangentLieAlongIt) {
  const double inclination = rad_from_deg(30.0);
  CommonErrors depth;
  depth.depth_sigma_m = 0.35;
  const auto constant = position_covariances(tangent(inclination, 1500.0, 11), depth);
  EXPECT_EQ(constant[0], PositionCovariance{});
  for (const std::size_t k : {1U, 10U}) {
    EXPECT_NEAR(sigma(constant[k], 0), 0.35 * std::sin(inclination), 1e-12);
    EXPECT_NEAR(sigma(constant[k], 2), 0.35 * std::cos(inclination), 1e-12);
  }
  depth = {};
  depth.depth_scale_sigma = 5e-4;
  const auto scaled_depth = position_covariances(tangent(inclination, 1500.0, 11), depth);
  EXPECT_NEAR(sigma(scaled_depth[1], 2), 5e-4 * 1530.0 * std::cos(inclination), 1e-12);
  EXPECT_NEAR(sigma(scaled_depth[10], 0), 5e-4 * 1800.0 * std::sin(inclination), 1e-12);
  EXPECT_NEAR(scaled_depth[10][2], std::pow(5e-4 * 1800.0, 2) * std::sin(inclination) * std::cos(inclination), 1e-12);
}

// Verifies: REQ-250
TEST(DepthErrors, OfAnArcMoveItByItsFirstChordAndStretchItsPosition) {
  // A constant error lengthens the first course, straight down; one in proportion stretches the rest about the first.
  const double radius = 500.0, scale = 5e-4;
  const auto hole = arc(radius, 0.5 * kPi, 900);
  CommonErrors depth;
  depth.depth_sigma_m = 0.35;
  EXPECT_NEAR(sigma(position_covariances(hole, depth).back(), 2), 0.35, 1e-5);
  EXPECT_NEAR(sigma(position_covariances(hole, depth).back(), 0), 0.0, 1e-3);
  depth = {};
  depth.depth_scale_sigma = scale;
  const auto found = position_covariances(hole, depth).back();
  EXPECT_NEAR(sigma(found, 2), scale * (2000.0 + radius), 2e-5);
  EXPECT_NEAR(sigma(found, 0), scale * radius, 1e-3);
}

/// Depths of the hole laid out anew with the error in them.
TEST(DepthErrors, AreDifferencesOfThePath) {
  std::vector<PathStationErrors> hole;
  std::vector<PathStation> as_read, moved;
  for (int k = 0; k < 12; ++k) {
    PathStationErrors at;
    at.station = {1000.0 + 30.0 * k, 0.1 + 0.11 * k, true, 0.3 * k};
    hole.push_back(at);
    as_read.push_back(at.station);
    if (k > 0) at.station.md_m += 0.01 + 1e-5 * at.station.md_m;
    moved.push_back(at.station);
  }
  const PathPoint a = minimum_curvature(as_read)->back(), b = minimum_curvature(moved)->back();
  CommonErrors one, other;
  one.depth_sigma_m = 0.01;
  other.depth_scale_sigma = 1e-5;
  const PositionCovariance c = position_covariances(hole, one).back(), d = position_covariances(hole, other).back();
  EXPECT_NEAR(std::fabs(b.tvd_m - a.tvd_m), sigma(c, 2) + sigma(d, 2), 1e-9);
}

// Negative: REQ-250
TEST(PathSigmas, StatedNoneAddNothing) {
  EXPECT_FALSE(PathSigmas{}.any());
  EXPECT_EQ(position_covariances(tangent(1.0, 1500.0, 5), CommonErrors{}).back(), PositionCovariance{});
}

std::vector<Truth> hole() {
  std::vector<Truth> out;
  for (int k = 0; k < 18; ++k) out.push_back({rad_from_deg(5.0 + 5.0 * k), rad_from_deg(70.0 + 2.0 * k), 1.7 * k});
  return out;
}

/// The path of a survey with this alignment instead of its own.
PathPoint end_with(const std::vector<ReferencedStation>& stations, const JointAlignment& alignment) {
  std::vector<PathStation> out;
  for (const ReferencedStation& s : stations) {
    const SurveyStation judged = judge_corrected(aligned(s.measured, alignment), s.reference, {});
    out.push_back({s.measured.md_m, judged.attitude.inclination->rad, true, judged.true_azimuth->angle.rad});
  }
  return minimum_curvature(out)->back();
}

// Verifies: REQ-251
TEST(AlignedPath, CarriesWhatARotationMoves) {
  TurnedTool tool;
  tool.turn_rad = degrees(0.3, -0.2, 0.4);
  tool.noisy = false;
  const std::vector<ReferencedStation> stations = tool.of(hole());
  const auto found = align_magnetometers(stations, {});
  ASSERT_TRUE(found.has_value()) << found.error().text();
  const double small = 1e-5;
  const auto turned_by = [&](std::size_t axis, double rad) {
    Vec3 turn{};
    turn[axis] = rad;
    JointAlignment more = *found;
    const Mat3 first = rotation_of(turn);
    using Rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    Eigen::Map<Rotation>(more.rotation.data()) =
        Eigen::Map<const Rotation>(first.data()) * Eigen::Map<const Rotation>(found->rotation.data());
    return end_with(stations, more);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const PathPoint ahead = turned_by(axis, small), behind = turned_by(axis, -small);
    CommonErrors common;
    common.carried[(kAlignmentUnknowns + 1) * axis] = small * small;
    std::vector<PathStationErrors> errors;
    for (const ReferencedStation& s : stations)
      errors.push_back(path_errors(judge_corrected(aligned(s.measured, *found), s.reference, {}), North::true_north,
                                   alignment_weights(s.measured, *found)));
    for (PathStationErrors& one : errors) one.random_rad2 = {};
    const PositionCovariance c = position_covariances(errors, common).back();
    EXPECT_NEAR(sigma(c, 0), 0.5 * std::fabs(ahead.north_m - behind.north_m), 1e-4 * std::sqrt(c[0] + c[4])) << axis;
    EXPECT_NEAR(sigma(c, 1), 0.5 * std::fabs(ahead.east_m - behind.east_m), 1e-4 * std::sqrt(c[0] + c[4])) << axis;
  }
}

struct Coverage {
  std::array<double, 3> squares{};
  std::array<int, 3> within{};  ///< 1.96 sigma
  int counted = 0;
};

void count(const Survey& found, const PathPoint& is, Coverage& out) {
  const PathPoint& at = found.path->back();
  const PositionCovariance& c = found.position_covariance.back();
  const double off[] = {at.north_m - is.north_m, at.east_m - is.east_m, at.tvd_m - is.tvd_m};
  for (std::size_t k = 0; k < 3; ++k) {
    out.squares[k] += off[k] * off[k] / c[4 * k];
    out.within[k] += std::fabs(off[k]) <= 1.959964 * sigma(c, k) ? 1 : 0;
  }
  ++out.counted;
}

// Tools turned, and with errors, as stated; aligned by their own survey: the end of the path lies as far off as said.
// Verifies: REQ-251
TEST(AlignedPath, LiesWithinItsCovariance) {
  constexpr int kTools = 400;
  std::mt19937_64 random(20260331);  // NOLINT: repeatable
  std::normal_distribution<double> normal;
  Coverage coverage;
  std::vector<PathStation> truth;
  const std::vector<Truth> attitudes = hole();
  for (std::size_t k = 0; k < attitudes.size(); ++k)
    truth.push_back({30.0 * static_cast<double>(k), attitudes[k].inclination_rad, true,
                     attitudes[k].azimuth_rad + reference_of(World{}).field.declination_rad});
  const PathPoint is = minimum_curvature(truth)->back();
  for (int n = 0; n < kTools; ++n) {
    TurnedTool tool;
    for (double& one : tool.turn_rad) one = rad_from_deg(0.5) * normal(random);
    for (std::size_t k = 0; k < kTermCount; ++k)
      tool.errors[k] = sigma_of(static_cast<Term>(k), iscwsa_tool()) * normal(random);
    tool.seed = static_cast<unsigned>(n + 1);
    World stated;
    stated.g_mps2 += 1.5e-3 * normal(random);
    stated.field_tesla += 130e-9 * normal(random);
    stated.dip_rad += rad_from_deg(0.2) * normal(random);
    std::vector<ReferencedStation> stations = tool.of(attitudes, stated);
    const double declination_error = rad_from_deg(0.4) * normal(random);
    for (ReferencedStation& s : stations) s.reference.field.declination_rad += declination_error;
    SurveySettings settings;
    settings.station.checks.false_alarm = 1e-12;  // every tool counts, whatever it drew
    settings.align_within_rad = rad_from_deg(0.5);
    const Survey found = run_survey(stations, settings);
    if (found.path && found.path->size() == truth.size() && *found.alignment) count(found, is, coverage);
  }
  std::printf("[ measured ] %d tools: squares over variances %.3f, %.3f, %.3f; within 1.96 sigma %d, %d, %d\n",
              coverage.counted, coverage.squares[0] / coverage.counted, coverage.squares[1] / coverage.counted,
              coverage.squares[2] / coverage.counted, coverage.within[0], coverage.within[1], coverage.within[2]);
  EXPECT_GT(coverage.counted, kTools * 95 / 100);
  const double tolerance = 4.0 * std::sqrt(2.0 / coverage.counted);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(coverage.squares[k] / coverage.counted, 1.0, tolerance);
    EXPECT_NEAR(coverage.within[k], 0.95 * coverage.counted, 4.0 * std::sqrt(0.05 * 0.95 * coverage.counted));
  }
}

// Negative: REQ-251
TEST(AlignedPath, IsLessSureThanTheSameToolAlignedExactly) {
  TurnedTool tool;
  tool.noisy = false;
  const std::vector<ReferencedStation> stations = tool.of(hole());
  SurveySettings settings;
  settings.align_within_rad = rad_from_deg(0.5);
  const Survey found = run_survey(stations, settings);
  ASSERT_TRUE(found.alignment && *found.alignment);
  ASSERT_EQ(found.position_covariance.size(), found.path->size());
  JointAlignment exact = **found.alignment;
  std::vector<PathStationErrors> errors;
  for (const ReferencedStation& s : stations)
    errors.push_back(path_errors(judge_corrected(aligned(s.measured, exact), s.reference, {}), North::true_north,
                                 alignment_weights(s.measured, exact)));
  CommonErrors common;
  common.carried = exact.covariance;
  common.declination_sigma_rad = rad_from_deg(0.4);
  const double with = position_covariances(errors, common).back()[4];
  EXPECT_NEAR(with, found.position_covariance.back()[4], 1e-12 * with);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < kAlignmentUnknowns; ++b)
      common.carried[kAlignmentUnknowns * a + b] = common.carried[kAlignmentUnknowns * b + a] = 0.0;
  }
  EXPECT_NE(position_covariances(errors, common).back()[4], with);
}

}  // namespace
}  // namespace carried_errors_test
