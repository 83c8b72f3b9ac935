#include "plumb/navigation/tilt.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "plumb/core/units.hpp"

namespace plumb {
namespace tilt_test {
namespace {

constexpr double kG = 9.81;
const Mat3 kWhite = {1e-6, 0, 0, 0, 1e-6, 0, 0, 0, 1e-6};
const double kUnknown = kPi / std::sqrt(3.0);

Vec3 gravity_at(double inclination, double toolface, double g = kG) {
  return {-g * std::sin(inclination) * std::sin(toolface), -g * std::sin(inclination) * std::cos(toolface),
          g * std::cos(inclination)};
}

/// Inclinations down to 1e-12 rad from either end, and the ends.
double any_inclination() {
  const int kind = *rc::gen::inRange(0, 6);
  const double small = std::pow(10.0, -12.0 * *rc::gen::inRange(0, 1001) / 1000.0);
  if (kind == 0) return *rc::gen::elementOf(std::vector<double>{0.0, kPi / 2.0, kPi});
  if (kind == 1) return small;
  if (kind == 2) return kPi - small;
  return kPi * *rc::gen::inRange(0, 1000001) / 1e6;
}

double any_toolface() {
  const int kind = *rc::gen::inRange(0, 4);
  if (kind == 0) return *rc::gen::elementOf(std::vector<double>{0.0, kPi / 2.0, kPi, 1.5 * kPi, 1e-12, 6.2831853});
  return 2.0 * kPi * *rc::gen::inRange(0, 1000000) / 1e6;
}

double any_length() {
  return std::pow(10.0, *rc::gen::elementOf(std::vector<double>{-300, -160, -3, 0, 1, 3, 160, 300}));
}

TEST(Tilt, CardinalAttitudes) {
  EXPECT_EQ(tilt_of({0, 0, kG}, kWhite).inclination_rad, 0.0);
  EXPECT_DOUBLE_EQ(tilt_of({0, 0, -kG}, kWhite).inclination_rad, kPi);
  EXPECT_DOUBLE_EQ(tilt_of({0, -kG, 0}, kWhite).inclination_rad, kPi / 2);
  EXPECT_EQ(tilt_of({0, -kG, 0}, kWhite).toolface_rad, 0.0);  // high side up: y against gravity
  EXPECT_DOUBLE_EQ(tilt_of({-kG, 0, 0}, kWhite).toolface_rad, kPi / 2);
  EXPECT_DOUBLE_EQ(tilt_of({0, kG, 0}, kWhite).toolface_rad, kPi);
  EXPECT_DOUBLE_EQ(tilt_of({kG, 0, 0}, kWhite).toolface_rad, 1.5 * kPi);
}

// Negative: REQ-008
TEST(Tilt, ToolfaceIsValidBeyondThreeDegreesOnly) {
  EXPECT_FALSE(tilt_of(gravity_at(rad_from_deg(2.999), 1.0), kWhite).toolface_valid);
  EXPECT_TRUE(tilt_of(gravity_at(rad_from_deg(3.001), 1.0), kWhite).toolface_valid);
  EXPECT_TRUE(tilt_of(gravity_at(rad_from_deg(176.999), 1.0), kWhite).toolface_valid);
  EXPECT_FALSE(tilt_of(gravity_at(rad_from_deg(177.001), 1.0), kWhite).toolface_valid);
  EXPECT_TRUE(tilt_of(gravity_at(rad_from_deg(2.0), 1.0), kWhite, rad_from_deg(1.0)).toolface_valid);
  EXPECT_FALSE(tilt_of(gravity_at(1.0, 1.0), kWhite, std::numeric_limits<double>::quiet_NaN()).toolface_valid);
}

TEST(Tilt, WhatIsNoVectorGivesZerosAndNothingValid) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const Vec3& g : {Vec3{0, 0, 0}, Vec3{-0.0, 0, -0.0}, Vec3{nan, 0, 1}, Vec3{0, inf, 1}, Vec3{0, 0, -inf}}) {
    const Tilt t = tilt_of(g, kWhite);
    EXPECT_FALSE(t.inclination_valid);
    EXPECT_FALSE(t.toolface_valid);
    EXPECT_EQ(t.inclination_rad, 0.0);
    EXPECT_EQ(t.toolface_rad, 0.0);
    EXPECT_EQ(t.inclination_sigma_rad, 0.0);
    EXPECT_EQ(t.toolface_sigma_rad, 0.0);
  }
}

TEST(Tilt, SigmaOfWhiteNoiseIsSigmaOverG) {
  const Tilt t = tilt_of(gravity_at(1.0, 2.0), kWhite);
  EXPECT_NEAR(t.inclination_sigma_rad, 1e-3 / kG, 1e-16);
  EXPECT_NEAR(t.toolface_sigma_rad, 1e-3 / kG / std::sin(1.0), 1e-16);
}

TEST(Tilt, AlongThePoleTheWorstHorizontalDirectionCountsAndToolfaceIsUnknown) {
  const Mat3 c = {4e-6, 1e-6, 0, 1e-6, 4e-6, 0, 0, 0, 1.0};
  const Tilt t = tilt_of({0, 0, kG}, c);
  EXPECT_NEAR(t.inclination_sigma_rad, std::sqrt(5e-6) / kG, 1e-16);
  EXPECT_EQ(t.toolface_sigma_rad, kUnknown);
  EXPECT_EQ(t.toolface_rad, 0.0);
}

TEST(Tilt, AnInvalidCovarianceGivesTheSigmaOfAnUnknownAngle) {
  Mat3 c = kWhite;
  c[0] = std::numeric_limits<double>::quiet_NaN();
  const Tilt t = tilt_of(gravity_at(1.0, 2.0), c);
  EXPECT_EQ(t.inclination_sigma_rad, kUnknown);
  EXPECT_EQ(t.toolface_sigma_rad, kUnknown);
  EXPECT_TRUE(t.inclination_valid);
}

// Verifies: REQ-008
RC_GTEST_PROP(TiltLaw, AnglesAreReproducedAtEveryAttitudeAndLength, ()) {
  const double inclination = any_inclination();
  const double toolface = any_toolface();
  const Tilt t = tilt_of(gravity_at(inclination, toolface, any_length()), kWhite);
  RC_ASSERT(t.inclination_valid);
  RC_ASSERT(std::fabs(t.inclination_rad - inclination) <= 1e-15 * (1.0 + inclination));
  if (std::sin(inclination) >= 1e-3) {
    const double off = std::remainder(t.toolface_rad - toolface, 2.0 * kPi);
    RC_ASSERT(std::fabs(off) <= 4e-15);
  }
}

// Verifies: REQ-008
RC_GTEST_PROP(TiltLaw, AnyBitPatternGivesAnglesInRange, ()) {
  const auto any = [] {
    const auto special = rc::gen::elementOf(std::vector<double>{0.0, -0.0, 5e-324, -5e-324, 1e308, -1e308,
                                                                std::numeric_limits<double>::quiet_NaN(),
                                                                std::numeric_limits<double>::infinity()});
    return *rc::gen::oneOf(special, rc::gen::arbitrary<double>());
  };
  const Vec3 g = {any(), any(), any()};
  Mat3 c{};
  for (double& entry : c) entry = any();
  const Tilt t = tilt_of(g, c);
  RC_ASSERT(t.inclination_rad >= 0.0 && t.inclination_rad <= kPi);
  RC_ASSERT(t.toolface_rad >= 0.0 && t.toolface_rad < 2.0 * kPi);
  RC_ASSERT(t.inclination_sigma_rad >= 0.0 && t.inclination_sigma_rad <= kUnknown);
  RC_ASSERT(t.toolface_sigma_rad >= 0.0 && t.toolface_sigma_rad <= kUnknown);
  RC_ASSERT(t.inclination_valid || !t.toolface_valid);
}

RC_GTEST_PROP(TiltLaw, SigmasAreThoseOfTheNumericalGradient, ()) {
  const double inclination = 0.05 + (kPi - 0.1) * *rc::gen::inRange(0, 1001) / 1000.0;
  const Vec3 g = gravity_at(inclination, any_toolface());
  // A covariance by construction: L L' with a random lower triangle.
  const auto entry = [] { return 1e-3 * *rc::gen::inRange(-1000, 1001) / 1000.0; };
  const Mat3 l = {1e-3, 0, 0, entry(), 1e-3, 0, entry(), entry(), 1e-3};
  Mat3 c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) c[3 * i + j] += l[3 * i + k] * l[3 * j + k];
    }
  }
  Vec3 di{};
  Vec3 dt{};
  const double step = 1e-4;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 plus_k = g;
    Vec3 minus_k = g;
    plus_k[k] += step;
    minus_k[k] -= step;
    const Tilt a = tilt_of(plus_k, c);
    const Tilt b = tilt_of(minus_k, c);
    di[k] = (a.inclination_rad - b.inclination_rad) / (2.0 * step);
    dt[k] = std::remainder(a.toolface_rad - b.toolface_rad, 2.0 * kPi) / (2.0 * step);
  }
  const Tilt t = tilt_of(g, c);
  const double sigma_i = std::sqrt(dot(di, times(c, di)));
  const double sigma_t = std::sqrt(dot(dt, times(c, dt)));
  RC_ASSERT(std::fabs(t.inclination_sigma_rad - sigma_i) <= 1e-6 * sigma_i);
  RC_ASSERT(std::fabs(t.toolface_sigma_rad - sigma_t) <= 1e-6 * sigma_t);
}

}  // namespace
}  // namespace tilt_test
}  // namespace plumb
