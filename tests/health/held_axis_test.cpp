#include "plumb/health/detail/held_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

#include "recalibration_support.hpp"

// Serves: REQ-130

namespace held_axis_test {
namespace {

using namespace plumb;
using plumb_test::Noise;
using plumb_test::Shadow;

/// Over many tools whose axes are wrong by what their calibration admits, any combination of readings is as wrong as
/// the uncertainty says, in variance. Without the held axes' part in the fitted figures it would be far off.
TEST(HeldAxis, TheUncertaintyIsThatOfTheErrors) {
  for (int n : {3, 4, std::min(6, kCapacity)}) {
    double squared = 0.0;
    int figures = 0;
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
      Shadow s(n, seed);
      s.gravity.sigma_mps2 = 0.0;
      s.drift_sigmas.scale = 5e-3;
      s.fit->configure(s.model, alike(s.drift_sigmas), rad_from_deg(2.0));
      plumb_test::leave_uncertainty(s.array, 1e-4 * kG0_mps2, 5e-4);
      s.bend_axes(5e-4);
      s.drift(5e-4 * kG0_mps2, 1e-4);
      s.start();
      if (s.roam(24) != Recalibration::Outcome::accepted) continue;
      s.fit->apply(s.model, s.array, s.gravity, 0.0, false);
      for (int k = 0; k < 8; ++k) {
        const Vec3 g = scaled(plumb_test::random_direction(s.noise), kG0_mps2);
        std::array<double, kCapacity> c{};
        for (double& weight : c) weight = s.noise.normal();
        double error = 0.0, variance = 0.0;
        for (int i = 0; i < n; ++i) {
          error += c[static_cast<std::size_t>(i)] * s.reading_error(i, g);
          for (int j = 0; j < n; ++j) {
            variance +=
                c[static_cast<std::size_t>(i)] * c[static_cast<std::size_t>(j)] * s.array.uncertainty().at(i, j, g);
          }
        }
        squared += error * error / variance;
        ++figures;
      }
    }
    EXPECT_GT(figures, 1000) << n;
    EXPECT_GT(squared / figures, 0.7) << n;
    EXPECT_LT(squared / figures, 1.15) << n;
  }
}

/// Visits in a fan of attitudes, few enough that the prior keeps part of a wrong length back. The reference is off by
/// as much as its sigma says, and so was the one behind the scales in force.
TEST(HeldAxis, WhatThePriorMakesOfAWrongLengthIsWithinTheUncertaintyOfTheDirection) {
  for (int n : {4, std::min(5, kCapacity), std::min(6, kCapacity)}) {
    double squared = 0.0, turned_rad = 0.0;
    int figures = 0;
    for (std::uint64_t seed = 1; seed <= 120; ++seed) {
      Shadow s(n, seed);
      const double sigma = 1e-3;  // of the length, relative
      s.gravity.sigma_mps2 = sigma * kG0_mps2;
      s.drift_sigmas.scale = 5e-4;
      s.fit->configure(s.model, alike(s.drift_sigmas), rad_from_deg(2.0));
      plumb_test::leave_uncertainty(s.array, 1e-5 * kG0_mps2, 1e-5);
      const double then = sigma * s.noise.normal(), now = sigma * s.noise.normal();
      for (double& scale : s.drifted_scale) scale = then;
      s.start();
      Recalibration::Outcome outcome = Recalibration::Outcome::none;
      for (int k = 0; k < 60 && outcome == Recalibration::Outcome::none; ++k) {
        const Vec3 u = plumb_test::direction_at(10.0 + 70.0 * s.noise.uniform(), 360.0 * s.noise.uniform());
        s.gravity.g_mps2 = kG0_mps2 * (1.0 + now);
        s.offer(u);
        s.gravity.g_mps2 = kG0_mps2;
        for (int step = 0; step < 60 && outcome == Recalibration::Outcome::none; ++step) outcome = s.step(0.0);
      }
      if (outcome != Recalibration::Outcome::accepted) continue;
      s.fit->apply(s.model, s.array, s.gravity, 0.0, false);
      const LeastSquares map = least_squares(s.array, s.array.all());
      for (int k = 0; k < 8; ++k) {
        const Vec3 u = plumb_test::random_direction(s.noise);
        const Vec3 g = scaled(u, kG0_mps2 * (1.0 + now));
        const Vec3 aside = cross(u, plumb_test::random_direction(s.noise));
        const Vec3 across = scaled(aside, 1.0 / norm(aside));
        double error = 0.0, variance = 0.0;
        for (int i = 0; i < n; ++i) {
          const double c = dot(map.column[static_cast<std::size_t>(i)], across);
          error += c * s.reading_error(i, g);
          for (int j = 0; j < n; ++j) {
            variance += c * dot(map.column[static_cast<std::size_t>(j)], across) * s.array.uncertainty().at(i, j, g);
          }
        }
        squared += error * error / variance;
        turned_rad = std::fmax(turned_rad, std::fabs(error) / kG0_mps2);
        ++figures;
      }
    }
    std::printf("[ measured ] n = %d: %.3f over %d figures, largest turn %.3g mrad\n", n, squared / figures, figures,
                1e3 * turned_rad);
    EXPECT_GT(figures, 400) << n;
    EXPECT_LT(squared / figures, 1.15) << n;
    EXPECT_GT(squared / figures, 0.5) << n;
  }
}

/// Sensors that were not fitted keep what they had, and so does every axis across itself.
TEST(HeldAxis, WhatWasNotFittedIsKept) {
  Shadow s(5, 3);
  HeldAxisFit fit;
  fit.sensors = s.array.all().without(1);
  std::array<StationMean, 12> directions{};
  for (StationMean& station : directions) station.direction = plumb_test::random_direction(s.noise);
  fit.station = directions.data();
  fit.count = 12;
  fit.sigma_mps2.fill(1e-3);
  fit.prior.fill({0.02, 5e-4});
  RowUncertainty out;
  std::array<double, kCapacity> share{};
  ASSERT_TRUE(held_axis_uncertainty(s.array, s.gravity, fit, out, share));
  const RowUncertainty& old = s.array.uncertainty();
  const Vec3 g = scaled(plumb_test::random_direction(s.noise), kG0_mps2);
  EXPECT_NEAR(out.at(1, 1, g), old.at(1, 1, g), 1e-15);
  EXPECT_EQ(share[1], 0.0);
  EXPECT_GT(share[0], 0.9);
  for (int i : {0, 2, 3, 4}) {
    const Vec3 across = scaled(cross(s.array.axis(i), Vec3{0.3, 0.2, 0.9}), kG0_mps2);
    double before = 0.0, after = 0.0;
    for (int p = 0; p < 3; ++p) {
      for (int q = 0; q < 3; ++q) {
        const int a = 4 * i + std::max(p, q), b = 4 * i + std::min(p, q);
        const auto at = static_cast<std::size_t>(a * (a + 1) / 2 + b);
        const double w = across[static_cast<std::size_t>(p)] * across[static_cast<std::size_t>(q)];
        before += w * old.covariance[at];
        after += w * out.covariance[at];
      }
    }
    EXPECT_NEAR(after, before, 1e-12 * before);
  }
}

TEST(HeldAxis, WithoutStationsThePriorStays) {
  Shadow s(4, 4);
  HeldAxisFit fit;
  fit.sensors = s.array.all();
  fit.sigma_mps2.fill(1e-3);
  fit.prior.fill({0.02, 5e-4});
  RowUncertainty out;
  std::array<double, kCapacity> share{};
  ASSERT_TRUE(held_axis_uncertainty(s.array, s.gravity, fit, out, share));
  EXPECT_NEAR(share[0], 0.0, 1e-12);
  const Vec3 nowhere{};
  EXPECT_NEAR(out.at(0, 0, nowhere), 0.02 * 0.02, 1e-12) << "a bias is as unsure as the drift";
  fit.prior.fill({0.02, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_FALSE(held_axis_uncertainty(s.array, s.gravity, fit, out, share));
}

}  // namespace
}  // namespace held_axis_test
