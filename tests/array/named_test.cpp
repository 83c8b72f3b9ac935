#include "plumb/array/named.hpp"

#include <limits>

#include "array_test_support.hpp"

namespace plumb {
namespace test {
namespace named_test {
namespace {

/// H'H, row-major.
Mat3 gram(const AxisList& axes, int n) {
  Mat3 m{};
  for (int i = 0; i < n; ++i) {
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) m[3 * r + c] += axes[at(i)][r] * axes[at(i)][c];
    }
  }
  return m;
}

void expect_balanced(const AxisList& axes, int n) {
  const Mat3 m = gram(axes, n);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(m[k], k % 4 == 0 ? n / 3.0 : 0.0, 2e-14) << n << " entry " << k;
  for (int i = 0; i < n; ++i) EXPECT_NEAR(norm(axes[at(i)]), 1.0, 4e-16);
}

TEST(PaperTetrahedron, IsEq16) {
  AxisList axes{};
  ASSERT_EQ(paper_tetrahedron(axes), 4);
  const double r2 = std::sqrt(2.0);
  const double r6 = std::sqrt(6.0);
  const Vec3 paper[4] = {{2 * r2 / 3, 0, 1.0 / 3}, {-r2 / 3, r6 / 3, 1.0 / 3}, {-r2 / 3, -r6 / 3, 1.0 / 3}, {0, 0, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(axes[i][k], paper[i][k], 1e-15);
  }
  expect_balanced(axes, 4);
}

TEST(PaperTetrahedron, IsTheConeWithAxisOfFour) {
  AxisList paper{};
  AxisList general{};
  paper_tetrahedron(paper);
  ASSERT_EQ(cone_with_axis(general, 4), 4);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(general[i][k], paper[i][k], 1e-15);
  }
}

TEST(Named, EverySetIsBalancedAndOfUnitAxes) {
  for (int n = 3; n <= kCapacity; ++n) {
    AxisList axes{};
    ASSERT_EQ(cone(axes, n), n);
    expect_balanced(axes, n);
    if (n >= 4) {
      ASSERT_EQ(cone_with_axis(axes, n), n);
      expect_balanced(axes, n);
    }
    if (n == 3 || n == 4 || n == 6 || n == 10) {
      ASSERT_EQ(platonic(axes, n), n);
      expect_balanced(axes, n);
    } else {
      EXPECT_EQ(platonic(axes, n), 0);
    }
  }
}

TEST(Named, WhatCannotBeBuiltIsZero) {
  AxisList axes{};
  EXPECT_EQ(cone(axes, 2), 0);
  EXPECT_EQ(cone(axes, kCapacity + 1), 0);
  EXPECT_EQ(cone(axes, 4, std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(cone(axes, 4, 1.1 * kPi), 0);
  EXPECT_EQ(cone_with_axis(axes, 3), 0);
  EXPECT_EQ(cone_with_axis(axes, kCapacity + 1), 0);
  EXPECT_EQ(platonic(axes, kCapacity + 1), 0);
  EXPECT_EQ(platonic(axes, -1), 0);
  if constexpr (kCapacity < 10) {
    EXPECT_EQ(platonic(axes, 10), 0);
  }
}

TEST(Platonic, SixAxesAreEquiangular) {
  if constexpr (kCapacity >= 6) {
    AxisList axes{};
    ASSERT_EQ(platonic(axes, 6), 6);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(std::fabs(dot(axes[i], axes[j])), 1.0 / std::sqrt(5.0), 1e-15);
    }
  }
}

RC_GTEST_PROP(NamedLaw, AConeHasItsHalfAngleAndEqualAzimuths, ()) {
  const int n = *rc::gen::inRange(3, kCapacity + 1);
  const double half_angle = any_in(1e-3, kPi - 1e-3);
  AxisList axes{};
  RC_ASSERT(cone(axes, n, half_angle) == n);
  for (int i = 0; i < n; ++i) {
    const Vec3& a = axes[at(i)];
    const Vec3& b = axes[at((i + 1) % n)];
    RC_ASSERT(std::fabs(angle_between_rad(a, {0.0, 0.0, 1.0}) - half_angle) <= 1e-14);
    const double sine = std::sin(half_angle);
    const double chord = 2.0 * sine * std::sin(kPi / n);
    RC_ASSERT(std::fabs(norm(minus(a, b)) - chord) <= 1e-14);
  }
}

}  // namespace
}  // namespace named_test
}  // namespace test
}  // namespace plumb
