// Stations that agree with their reference, and stations that do not.
#include "plumb/survey/checks.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "simulated_survey.hpp"

namespace checks_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;

const Truth kHole{rad_from_deg(60.0), rad_from_deg(40.0), rad_from_deg(100.0)};

// Verifies: REQ-230
TEST(SurveyChecks, AGoodStationHasEveryAzimuth) {
  StationSettings settings;
  settings.convergence = {true, rad_from_deg(1.5)};
  const SurveyStation s = judge_station(station_of(kHole, World{}), reference_of(World{}), settings);
  EXPECT_EQ(s.status, StationStatus::accepted);
  EXPECT_EQ(s.flags(), "");
  ASSERT_TRUE(s.attitude.azimuth && s.true_azimuth && s.grid_azimuth);
  EXPECT_NEAR(deg_from_rad(s.attitude.azimuth->angle.rad), 40.0, 1e-9);
  EXPECT_NEAR(deg_from_rad(s.true_azimuth->angle.rad), 36.0, 1e-9);
  EXPECT_NEAR(deg_from_rad(s.grid_azimuth->angle.rad), 34.5, 1e-9);
}

// Negative: REQ-230
TEST(SurveyChecks, AFieldThatIsOffLeavesTheInclination) {
  Measurement m = station_of(kHole, World{});
  m.field_tesla[2] += 3e-6;
  const SurveyStation s = judge_station(m, reference_of(World{}), {});
  EXPECT_EQ(s.status, StationStatus::inclination_only);
  EXPECT_EQ(s.flags(), "BD");
  EXPECT_TRUE(s.attitude.inclination && s.attitude.gravity_toolface);
  ASSERT_FALSE(s.attitude.azimuth || s.true_azimuth || s.grid_azimuth || s.attitude.magnetic_toolface);
  EXPECT_EQ(s.true_azimuth.error().why, NoAngle::field_failed);
  EXPECT_GT(s.attitude.covariance[0], 0.0);
  EXPECT_EQ(s.attitude.covariance[15], 0.0);
}

TEST(SurveyChecks, AFieldThatIsTurnedFailsByItsDipAlone) {
  World turned;
  turned.dip_rad += rad_from_deg(1.5);
  const SurveyStation s = judge_station(station_of(kHole, turned), reference_of(World{}), {});
  EXPECT_EQ(s.flags(), "D");
  EXPECT_EQ(s.status, StationStatus::inclination_only);
}

// Negative: REQ-230
TEST(SurveyChecks, GravityThatIsOffLeavesNothing) {
  Measurement m = station_of(kHole, World{});
  m.gravity_mps2[0] += 0.1;
  const SurveyStation s = judge_station(m, reference_of(World{}), {});
  EXPECT_EQ(s.status, StationStatus::rejected);
  EXPECT_EQ(s.flags()[0], 'G');
  EXPECT_FALSE(s.attitude.inclination || s.attitude.gravity_toolface || s.attitude.azimuth || s.true_azimuth ||
               s.grid_azimuth);
  EXPECT_EQ(s.grid_azimuth.error().why, NoAngle::gravity_failed);
}

// Negative: REQ-233
TEST(SurveyChecks, LimitsAreThoseOfTheUncertainties) {
  StationSettings settings;
  settings.tool = {};
  settings.checks.false_alarm = 0.0455002638963584;  // 2 sigma
  Measurement m = station_of(kHole, World{});
  m.random = independent_covariance(2e-3, 40e-9);
  m.bias_bound = {0.0, 0.0, 0.0, 0.0, 0.0, 100e-9};
  Reference reference = reference_of(World{});
  reference.field.total_tesla_sigma.random = 60e-9;
  const StationChecks c = judge_station(m, reference, settings).checks;
  EXPECT_NEAR(c.gravity.limit, 2.0 * std::hypot(2e-3, 1.5e-3), 1e-12);
  const double along = m.field_tesla[2] / World{}.field_tesla;
  EXPECT_NEAR(c.field.limit, 2.0 * std::sqrt(130.0 * 130 + 60 * 60 + 40 * 40) * 1e-9 + std::fabs(along) * 100e-9,
              1e-16);
  EXPECT_GT(c.dip.limit, 2.0 * rad_from_deg(0.2));
  EXPECT_NEAR(c.field.sigma, std::sqrt(130.0 * 130 + 60 * 60 + 40 * 40) * 1e-9, 1e-16);
}

TEST(SurveyChecks, FixedLimitsAreTheUsualNumbers) {
  StationSettings settings;
  settings.checks.limits = LimitKind::fixed;
  World off;
  off.field_tesla += 299e-9;
  off.dip_rad += rad_from_deg(0.249);
  off.g_mps2 += 2.49e-3 * kG0_mps2;
  EXPECT_EQ(judge_station(station_of(kHole, off), reference_of(World{}), settings).flags(), "");
  off.field_tesla += 2e-9;
  EXPECT_EQ(judge_station(station_of(kHole, off), reference_of(World{}), settings).flags(), "B");
  off.dip_rad += rad_from_deg(0.002);
  EXPECT_EQ(judge_station(station_of(kHole, off), reference_of(World{}), settings).flags(), "BD");
  off.g_mps2 += 0.02e-3 * kG0_mps2;
  EXPECT_EQ(judge_station(station_of(kHole, off), reference_of(World{}), settings).flags(), "GBD");
}

// Verifies: REQ-233
TEST(SurveyChecks, FalseAlarmsAreAsRareAsStated) {
  // Errors drawn as they are stated: of 20 000 stations a tenth fails each check, within four sigma of counting.
  std::mt19937_64 generator(20260331);
  std::normal_distribution<double> normal;
  StationSettings settings;
  settings.checks.false_alarm = 0.1;
  settings.tool = {};
  constexpr int kStations = 20000;
  int failed[3] = {};
  for (int k = 0; k < kStations; ++k) {
    const Truth truth{0.3 + 2.0 * (k % 97) / 97.0, 6.2 * (k % 89) / 89.0, 6.2 * (k % 83) / 83.0};
    Measurement m = station_of(truth, World{});
    m.random = independent_covariance(4e-3, 80e-9);
    Reference reference = reference_of(World{});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      m.gravity_mps2[axis] += 4e-3 * normal(generator);
      m.field_tesla[axis] += 80e-9 * normal(generator);
    }
    reference.gravity.g_mps2 += reference.gravity.sigma_mps2 * normal(generator);
    reference.field.total_tesla += 130e-9 * normal(generator);
    reference.field.dip_rad += rad_from_deg(0.2) * normal(generator);
    const StationChecks c = judge_station(m, reference, settings).checks;
    failed[0] += c.gravity.passed ? 0 : 1;
    failed[1] += c.field.passed ? 0 : 1;
    failed[2] += c.dip.passed ? 0 : 1;
  }
  for (const int count : failed) EXPECT_NEAR(count, 0.1 * kStations, 4.0 * std::sqrt(0.09 * kStations));
}

RC_GTEST_PROP(SurveyChecksLaw, TotalsDerivativesAreDifferences, ()) {
  const auto part = [](double most) { return (*rc::gen::inRange(-1000, 1001)) / 1000.0 * most; };
  const Vec3 g{part(10.0), part(10.0), part(10.0)}, b{part(60e-6), part(60e-6), part(60e-6)};
  RC_PRE(norm(g) > 1.0 && norm(b) > 5e-6 && norm(cross(g, b)) > 0.02 * norm(g) * norm(b));
  const std::array<double, 18> j = totals_jacobian(g, b);
  for (std::size_t k = 0; k < 6; ++k) {
    const double step = k < 3 ? 1e-6 : 1e-11;
    Vec3 gu = g, gd = g, bu = b, bd = b;
    (k < 3 ? gu[k] : bu[k - 3]) += step;
    (k < 3 ? gd[k] : bd[k - 3]) -= step;
    const Totals up = totals_of(gu, bu), down = totals_of(gd, bd);
    const double unit = k < 3 ? 1.0 / norm(g) : 1.0 / norm(b);
    RC_ASSERT(std::fabs((up.gravity_mps2 - down.gravity_mps2) / (2.0 * step) - j[k]) < 1e-5);
    RC_ASSERT(std::fabs((up.field_tesla - down.field_tesla) / (2.0 * step) - j[6 + k]) < 1e-4);
    RC_ASSERT(std::fabs((up.dip_rad - down.dip_rad) / (2.0 * step) - j[12 + k]) < 1e-4 * unit);
  }
}

TEST(SurveyChecks, DipOfAFieldAlongGravityHasAWidth) {
  const std::array<double, 18> j = totals_jacobian({0.0, 0.0, 9.81}, {0.0, 0.0, 50e-6});
  double square = 0.0;
  for (std::size_t k = 12; k < 15; ++k) square += j[k] * j[k];
  EXPECT_NEAR(std::sqrt(square), 1.0 / 9.81, 1e-12);
}

TEST(SurveyChecks, WhatIsNoNumberFails) {
  for (std::size_t k = 0; k < 6; ++k) {
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      Measurement m = station_of(kHole, World{});
      (k < 3 ? m.gravity_mps2[k] : m.field_tesla[k - 3]) = value;
      const SurveyStation s = judge_station(m, reference_of(World{}), {});
      EXPECT_NE(s.status, StationStatus::accepted);
      EXPECT_FALSE(s.attitude.azimuth.has_value());
      EXPECT_EQ(s.flags()[0], 'N');
    }
  }
  EXPECT_EQ(judge_station(Measurement{}, reference_of(World{}), {}).status, StationStatus::rejected);
}

}  // namespace
}  // namespace checks_test
