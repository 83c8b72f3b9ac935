#include "plumb/numeric/symmetric_eigenvalues.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "plumb/numeric/symmetric_eigen.hpp"

namespace symmetric_eigenvalues_test {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Entries in [-1, 1] times `scale`.
std::vector<double> drawn_matrix(int n, int stride, double scale, std::uint64_t seed) {
  std::vector<double> a(at(n * stride));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
      a[at(i * stride + j)] = scale * (static_cast<double>(seed >> 11U) * 0x1.0p-52 - 1.0);
      a[at(j * stride + i)] = a[at(i * stride + j)];
    }
  }
  return a;
}

TEST(SymmetricEigenvalues, OfAKnownMatrix) {
  // Second differences of n points: 2 - 2 cos(k pi / (n + 1)).
  for (const int n : {1, 2, 3, 9, 16}) {
    std::vector<double> a(at(n * n)), values(at(n));
    for (int i = 0; i < n; ++i) {
      a[at(i * n + i)] = 2.0;
      if (i > 0) a[at(i * n + i - 1)] = a[at((i - 1) * n + i)] = -1.0;
    }
    ASSERT_TRUE(plumb::symmetric_eigenvalues(a.data(), n, n, values.data()));
    for (int k = 0; k < n; ++k) {
      EXPECT_NEAR(values[at(k)], 2.0 - 2.0 * std::cos((k + 1) * std::acos(-1.0) / (n + 1)), 1e-14);
    }
  }
}

TEST(SymmetricEigenvalues, OfDiagonalEmptyAndEqual) {
  std::vector<double> a = {3.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 2.0}, values(3);
  ASSERT_TRUE(plumb::symmetric_eigenvalues(a.data(), 3, 3, values.data()));
  EXPECT_EQ(values, (std::vector<double>{-1.0, 2.0, 3.0}));
  std::vector<double> zero(25), five(5);
  ASSERT_TRUE(plumb::symmetric_eigenvalues(zero.data(), 5, 5, five.data()));
  EXPECT_EQ(five, std::vector<double>(5, 0.0));
  std::vector<double> ones(16, 1.0), four(4);
  ASSERT_TRUE(plumb::symmetric_eigenvalues(ones.data(), 4, 4, four.data()));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(four[at(k)], 0.0, 1e-15);
  EXPECT_NEAR(four[3], 4.0, 1e-15);
}

/// A chain: nothing on the diagonal, where the shift of every step may be nothing too.
TEST(SymmetricEigenvalues, OfADiagonalOfZeros) {
  for (int n = 2; n <= 9; ++n) {
    std::vector<double> a(at(n * n)), values(at(n));
    for (int i = 1; i < n; ++i) a[at(i * n + i - 1)] = a[at((i - 1) * n + i)] = 1.0;
    ASSERT_TRUE(plumb::symmetric_eigenvalues(a.data(), n, n, values.data()));
    for (int k = 0; k < n; ++k) {
      EXPECT_NEAR(values[at(k)], -2.0 * std::cos((k + 1) * std::acos(-1.0) / (n + 1)), 1e-14) << n;
    }
  }
}

/// Twice the largest number is none.
TEST(SymmetricEigenvalues, RefusesWhoseValuesAreBeyondTheRange) {
  const double most = std::numeric_limits<double>::max();
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> a = {sign * most, most, most, sign * most}, values(2);
    EXPECT_FALSE(plumb::symmetric_eigenvalues(a.data(), 2, 2, values.data()));
  }
}

TEST(SymmetricEigenvalues, ExtremeScalesKeepTheirDigits) {
  for (const double scale : {0x1.0p-1060, 0x1.0p-900, 0x1.0p900, 0x1.0p1020}) {
    std::vector<double> a = {2.0 * scale, scale, scale, 2.0 * scale}, values(2);
    ASSERT_TRUE(plumb::symmetric_eigenvalues(a.data(), 2, 2, values.data()));
    EXPECT_NEAR(values[0] / scale, 1.0, 1e-15);
    EXPECT_NEAR(values[1] / scale, 3.0, 1e-15);
  }
}

TEST(SymmetricEigenvalues, RefusesWhatIsNoMatrix) {
  std::vector<double> a(16, 1.0), values(4);
  EXPECT_FALSE(plumb::symmetric_eigenvalues(nullptr, 4, 4, values.data()));
  EXPECT_FALSE(plumb::symmetric_eigenvalues(a.data(), 4, 4, nullptr));
  EXPECT_FALSE(plumb::symmetric_eigenvalues(a.data(), 0, 4, values.data()));
  EXPECT_FALSE(plumb::symmetric_eigenvalues(a.data(), 4, 3, values.data()));
  EXPECT_FALSE(plumb::symmetric_eigenvalues(a.data(), plumb::kMaxEigenSize + 1, 1000, values.data()));
  a[5] = std::nan("");
  EXPECT_FALSE(plumb::symmetric_eigenvalues(a.data(), 4, 4, values.data()));
  a[5] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(plumb::symmetric_eigenvalues(a.data(), 4, 4, values.data()));
}

RC_GTEST_PROP(SymmetricEigenvaluesLaws, TheSameAsJacobiToRoundingOfTheLargest, ()) {
  const int n = *rc::gen::inRange(1, 4 * plumb::kCapacity + 1);
  const int stride = n + *rc::gen::inRange(0, 3);
  const double scale = std::ldexp(1.0, *rc::gen::inRange(-1060, 1020));
  std::vector<double> a = drawn_matrix(n, stride, scale, *rc::gen::arbitrary<std::uint64_t>());
  std::vector<double> b = a, vectors(a.size()), values(at(n)), expected(at(n));
  RC_ASSERT(plumb::symmetric_eigenvalues(a.data(), n, stride, values.data()));
  RC_ASSERT(plumb::symmetric_eigen(b.data(), n, stride, expected.data(), vectors.data()));
  const double largest = std::fmax(std::fabs(expected[0]), std::fabs(expected[at(n - 1)]));
  for (int k = 0; k < n; ++k) {
    RC_ASSERT(std::fabs(values[at(k)] - expected[at(k)]) <= 1e-13 * largest + 1e-320);
    if (k > 0) RC_ASSERT(values[at(k)] >= values[at(k - 1)]);
  }
}

TEST(SymmetricEigenvalues, OfFewAreTheSameDigitForDigit) {
  for (int n = 1; n <= 2 * plumb::kCapacity; ++n) {
    std::vector<double> a = drawn_matrix(n, n, 1.0, 7U + static_cast<std::uint64_t>(n)), b = a, x(at(n)), y(at(n));
    ASSERT_TRUE(plumb::symmetric_eigenvalues(a.data(), n, n, x.data()));
    ASSERT_TRUE(plumb::symmetric_eigenvalues_of_few(b.data(), n, n, y.data()));
    EXPECT_EQ(x, y);
  }
  std::vector<double> a(4000), values(100);
  EXPECT_FALSE(plumb::symmetric_eigenvalues_of_few(a.data(), 2 * plumb::kCapacity + 1, 50, values.data()));
}

}  // namespace
}  // namespace symmetric_eigenvalues_test
