// Angles of a tool whose attitude is known, their covariance against ISCWSA's weights and against differences.
#include "plumb/survey/attitude.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "plumb/navigation/tilt.hpp"
#include "simulated_survey.hpp"

namespace attitude_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;

double apart(double a, double b) { return std::fabs(std::remainder(a - b, 2.0 * kPi)); }

Truth any_truth() {
  const auto angle = [](double most) { return *rc::gen::inRange(0, 1000000) / 1e6 * most; };
  Truth out{angle(kPi), angle(2.0 * kPi), angle(2.0 * kPi)};
  if (*rc::gen::inRange(0, 4) == 0) out.inclination_rad = *rc::gen::element(0.5 * kPi, 0.01, kPi - 0.01);
  if (*rc::gen::inRange(0, 4) == 0) out.azimuth_rad = 0.5 * kPi * *rc::gen::inRange(0, 4);
  if (*rc::gen::inRange(0, 4) == 0) out.toolface_rad = 0.5 * kPi * *rc::gen::inRange(0, 4);
  return out;
}

World any_world() {
  return {9.78 + *rc::gen::inRange(0, 60) / 1000.0, *rc::gen::inRange(22, 68) * 1e-6,
          rad_from_deg(*rc::gen::inRange(-85, 86))};
}

RC_GTEST_PROP(SurveyAttitudeLaw, IsTheAttitudeOfTheTool, ()) {
  const Truth truth = any_truth();
  RC_PRE(std::sin(truth.inclination_rad) > 1e-3);
  const Attitude a = attitude_of(station_of(truth, any_world()), independent_covariance(1e-6, 1e-12));
  RC_ASSERT(a.inclination && a.gravity_toolface && a.azimuth);
  RC_ASSERT(apart(a.inclination->rad, truth.inclination_rad) < 1e-12);
  RC_ASSERT(apart(a.gravity_toolface->rad, truth.toolface_rad) < 1e-11);
  RC_ASSERT(apart(a.azimuth->angle.rad, truth.azimuth_rad) < 1e-10);
  RC_ASSERT(a.azimuth->angle.rad >= 0.0 && a.azimuth->angle.rad < 2.0 * kPi);
}

// Verifies: REQ-231
TEST(SurveyAttitude, OfAVerticalToolIsItsMagneticToolface) {
  for (const double turn_deg : {0.0, 30.0, 200.0, 359.0}) {
    const Attitude a = attitude_of(station_of({0.0, rad_from_deg(turn_deg), rad_from_deg(20.0)}, World{}),
                                   independent_covariance(0.004, 70e-9));
    ASSERT_TRUE(a.magnetic_toolface.has_value());
    EXPECT_NEAR(apart(a.magnetic_toolface->rad, rad_from_deg(turn_deg + 20.0)), 0.0, 1e-12);
    ASSERT_FALSE(a.azimuth.has_value());
    ASSERT_FALSE(a.gravity_toolface.has_value());
    EXPECT_EQ(a.azimuth.error().why, NoAngle::vertical);
    // 5 sigma of 0.004 m/s^2 in 9.81 m/s^2.
    EXPECT_NEAR(a.azimuth.error().limit, 5.0 * 0.004 / 9.81, 1e-12);
    EXPECT_EQ(a.azimuth.error().text(),
              "the tool is within 0.000 deg of vertical, and 5 sigma of its tilt are 0.117 deg");
    EXPECT_NEAR(a.inclination->sigma_rad, 0.004 / 9.81, 1e-12);
  }
}

// Negative: REQ-231
RC_GTEST_PROP(SurveyAttitudeLaw, NearVerticalThereIsNoAzimuth, ()) {
  const double limit = 5.0 * 0.004 / 9.81, tilt = limit * *rc::gen::inRange(0, 2000) / 1000.0;
  RC_PRE(std::fabs(tilt - limit) > 1e-9);
  const bool up = *rc::gen::arbitrary<bool>();
  Measurement m = station_of({up ? kPi - tilt : tilt, 1.0, 2.0}, World{});
  const Attitude a = attitude_of(m, independent_covariance(0.004, 70e-9));
  RC_ASSERT(a.azimuth.has_value() == (tilt > limit));
  RC_ASSERT(a.inclination && a.inclination->sigma_rad >= 0.999 * 0.004 / 9.81);
}

double angle_at(const Measurement& m, int row) {
  const Attitude a = attitude_of(m, independent_covariance(1e-9, 1e-15));
  switch (row) {
    case 0: return a.inclination->rad;
    case 1: return a.gravity_toolface->rad;
    case 2: return a.magnetic_toolface->rad;
    default: return a.azimuth->angle.rad;
  }
}

RC_GTEST_PROP(SurveyAttitudeLaw, DerivativesAreDifferences, ()) {
  const Truth truth = any_truth();
  const World world = any_world();
  RC_PRE(std::sin(truth.inclination_rad) > 0.02);
  const Measurement m = station_of(truth, world);
  RC_PRE(std::hypot(m.field_tesla[0], m.field_tesla[1]) > 1e-6);
  const std::array<double, 24> j = angle_jacobian(m.gravity_mps2, m.field_tesla);
  for (int row = 0; row < 4; ++row) {
    for (std::size_t k = 0; k < 6; ++k) {
      const double step = k < 3 ? 1e-5 : 1e-10;
      Measurement up = m, down = m;
      (k < 3 ? up.gravity_mps2[k] : up.field_tesla[k - 3]) += step;
      (k < 3 ? down.gravity_mps2[k] : down.field_tesla[k - 3]) -= step;
      const double slope = std::remainder(angle_at(up, row) - angle_at(down, row), 2.0 * kPi) / (2.0 * step);
      const double exact = j[6 * static_cast<std::size_t>(row) + k];
      const double scale =
          (k < 3 ? 1.0 / world.g_mps2 : 1.0 / world.field_tesla) * 100.0 / std::sin(truth.inclination_rad);
      RC_ASSERT(std::fabs(slope - exact) < 1e-5 * scale);
    }
  }
}

/// SPE 67616, table of weights: what a unit error of one sensor does to the azimuth, at toolface 0 (Gy, By to the high
/// side).
TEST(SurveyAttitude, HasTheWeightsOfTheIscwsaModel) {
  const World w;
  for (const double i_deg : {10.0, 45.0, 90.0, 120.0}) {
    for (const double a_deg : {0.0, 35.0, 90.0, 250.0}) {
      const double i = rad_from_deg(i_deg), a = rad_from_deg(a_deg), t = std::tan(w.dip_rad);
      const double across = w.field_tesla * std::cos(w.dip_rad);
      const Measurement m = station_of({i, a, 0.7}, w);
      const std::array<double, 24> j = angle_jacobian(m.gravity_mps2, m.field_tesla);
      EXPECT_NEAR(j[2], -std::sin(i) / w.g_mps2, 1e-12);                        // ABZ on the inclination
      EXPECT_NEAR(j[18 + 2], t * std::sin(i) * std::sin(a) / w.g_mps2, 1e-12);  // ABZ
      EXPECT_NEAR(j[18 + 5] * across, -std::sin(i) * std::sin(a), 1e-12);       // MBZ, AMIL
      EXPECT_NEAR((j[18 + 3] * std::cos(0.7) - j[18 + 4] * std::sin(0.7)) * across, std::cos(a), 1e-12);  // MBXY-TI2
      EXPECT_NEAR((j[18 + 3] * std::sin(0.7) + j[18 + 4] * std::cos(0.7)) * across, -std::cos(i) * std::sin(a),
                  1e-12);  // TI1
    }
  }
}

TEST(SurveyAttitude, IsWeakToEastAndWestWhereTheToolLiesDown) {
  ToolErrors tool = iscwsa_tool();
  const auto sigma_deg = [&](double i_deg, double a_deg) {
    const Measurement m = station_of({rad_from_deg(i_deg), rad_from_deg(a_deg), 0.3}, World{});
    return deg_from_rad(attitude_of(m, total_covariance(m, tool)).azimuth->angle.sigma_rad);
  };
  EXPECT_GT(sigma_deg(90.0, 90.0), 2.0 * sigma_deg(90.0, 0.0));
  EXPECT_GT(sigma_deg(90.0, 270.0), 2.0 * sigma_deg(90.0, 180.0));
  // AMIL alone: 220 nT over the horizontal field.
  tool = {};
  tool.axial_interference_tesla = 220e-9;
  EXPECT_NEAR(sigma_deg(90.0, 90.0), deg_from_rad(220e-9 / (50e-6 * std::cos(1.25))), 1e-9);
  EXPECT_NEAR(sigma_deg(90.0, 0.0), 0.0, 1e-9);
}

RC_GTEST_PROP(SurveyAttitudeLaw, AgreesWithTheTiltOfTheCore, ()) {
  const Truth truth = any_truth();
  RC_PRE(std::sin(truth.inclination_rad) > 0.05);
  const Measurement m = station_of(truth, World{});
  const Mat3 c{4e-6, 1e-6, 0.0, 1e-6, 3e-6, 5e-7, 0.0, 5e-7, 2e-6};
  Covariance6 total = independent_covariance(0.0, 1e-9);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) total[6 * r + k] = c[3 * r + k];
  }
  const Tilt tilt = tilt_of(m.gravity_mps2, c, 0.0);
  const Attitude a = attitude_of(m, total);
  RC_ASSERT(std::fabs(a.inclination->sigma_rad - tilt.inclination_sigma_rad) < 1e-12);
  RC_ASSERT(std::fabs(a.gravity_toolface->sigma_rad - tilt.toolface_sigma_rad) < 1e-10);
  RC_ASSERT(std::fabs(a.covariance[0] - a.inclination->sigma_rad * a.inclination->sigma_rad) < 1e-18);
}

TEST(SurveyAttitude, WithoutAHorizontalFieldThereIsNoAzimuth) {
  World pole;
  pole.dip_rad = rad_from_deg(89.9);  // 87 nT across
  const Attitude a = attitude_of(station_of({1.0, 1.0, 1.0}, pole), independent_covariance(0.004, 70e-9));
  ASSERT_FALSE(a.azimuth.has_value());
  EXPECT_EQ(a.azimuth.error().why, NoAngle::no_horizontal);
  EXPECT_NEAR(a.azimuth.error().found, 87.3e-9, 1e-10);
  EXPECT_TRUE(a.gravity_toolface.has_value());
}

TEST(SurveyAttitude, OfWhatIsNoNumberIsUndefined) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < 6; ++k) {
    Measurement m = station_of({1.0, 1.0, 1.0}, World{});
    (k < 3 ? m.gravity_mps2[k] : m.field_tesla[k - 3]) = nan;
    const Attitude a = attitude_of(m, independent_covariance(0.004, 70e-9));
    ASSERT_FALSE(a.inclination || a.azimuth || a.gravity_toolface || a.magnetic_toolface);
    EXPECT_EQ(a.azimuth.error().why, NoAngle::not_finite);
  }
  const Attitude none = attitude_of(Measurement{}, independent_covariance(0.004, 70e-9));
  EXPECT_EQ(none.inclination.error().why, NoAngle::no_gravity);
}

TEST(SurveyAttitude, BoundsHoldBiasesAndTheRisk) {
  Measurement m = station_of({0.5 * kPi, 0.5 * kPi, 0.0}, World{});
  m.bias_bound[5] = 300e-9;
  const Attitude a = attitude_of(m, independent_covariance(0.0, 50e-9));
  const double across = 50e-6 * std::cos(1.25);
  EXPECT_NEAR(a.azimuth->angle.bias_rad, 300e-9 / across, 1e-12);
  EXPECT_NEAR(a.azimuth->angle.sigma_rad, 50e-9 / across, 1e-9);
  EXPECT_NEAR(protection_level_rad(a.azimuth->angle, 0.0027), 2.9998 * 50e-9 / across + 300e-9 / across, 1e-6);
  EXPECT_EQ(protection_level_rad(a.azimuth->angle, 0.0), kPi);
  EXPECT_EQ(protection_level_rad({0.0, 10.0, 0.0}, 1e-7), kPi);
}

// Negative: REQ-232
TEST(SurveyAttitude, NorthsAreTypesOfTheirOwn) {
  const Reference reference = reference_of(World{});
  const MagneticAzimuth magnetic{{rad_from_deg(2.0), rad_from_deg(0.3), 0.0}};
  const auto to_true = true_azimuth(magnetic, reference.field);
  ASSERT_TRUE(to_true.has_value());
  EXPECT_NEAR(deg_from_rad(to_true->angle.rad), 358.0, 1e-9);
  EXPECT_NEAR(deg_from_rad(to_true->angle.sigma_rad), 0.5, 1e-9);
  const auto to_grid = grid_azimuth(*to_true, {true, rad_from_deg(-3.0)});
  ASSERT_TRUE(to_grid.has_value());
  EXPECT_NEAR(deg_from_rad(to_grid->angle.rad), 1.0, 1e-9);
  EXPECT_STREQ(to_string(decltype(to_grid)::value_type::north), "grid");
  EXPECT_EQ(grid_azimuth(*to_true, {}).error().why, NoAngle::no_convergence);
  geomagnetic::FieldReference without = reference.field;
  without.declination_known = false;
  EXPECT_EQ(true_azimuth(magnetic, without).error().why, NoAngle::no_declination);
  EXPECT_FALSE((std::is_convertible_v<MagneticAzimuth, TrueAzimuth>));
}

}  // namespace
}  // namespace attitude_test
