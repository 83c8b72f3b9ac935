#include "plumb/numeric/cholesky.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace plumb {
namespace cholesky_test {
namespace {

constexpr double kSentinel = -12345.0;

/// n x n in storage with a wider leading dimension; what lies outside must not change.
struct Matrix {
  int n = 0;
  int stride = 0;
  std::vector<double> a;

  Matrix(int size, int extra)
      : n(size), stride(size + extra), a(static_cast<std::size_t>(size * (size + extra)), kSentinel) {}
  double& operator()(int i, int j) { return a[static_cast<std::size_t>(i * stride + j)]; }
  double operator()(int i, int j) const { return a[static_cast<std::size_t>(i * stride + j)]; }
  bool margin_untouched() const {
    for (int i = 0; i < n; ++i) {
      for (int j = n; j < stride; ++j) {
        if ((*this)(i, j) != kSentinel) return false;
      }
    }
    return true;
  }
};

double any_entry() {
  return *rc::gen::weightedOneOf<int>(
             {{6, rc::gen::inRange(-1000, 1001)}, {1, rc::gen::elementOf(std::vector<int>{0, 1, -1000, 1000})}}) /
         1000.0;
}

/// B B' + d I, positive definite by construction; its condition is at most (n^2 + d) / d.
Matrix any_positive(double d) {
  const int n = *rc::gen::inRange(1, 13);
  Matrix b(n, 0);
  for (double& v : b.a) v = any_entry();
  Matrix m(n, *rc::gen::inRange(0, 4));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      double sum = i == j ? d : 0.0;
      for (int k = 0; k < n; ++k) sum += b(i, k) * b(j, k);
      m(i, j) = sum;
    }
  }
  return m;
}

TEST(Cholesky, FactorOfATwoByTwo) {
  Matrix m(2, 1);
  m(0, 0) = 4.0;
  m(0, 1) = std::numeric_limits<double>::quiet_NaN();  // above the diagonal: not read
  m(1, 0) = 2.0;
  m(1, 1) = 5.0;
  ASSERT_TRUE(cholesky_factor(m.a.data(), 2, m.stride));
  EXPECT_EQ(m(0, 0), 2.0);
  EXPECT_EQ(m(1, 0), 1.0);
  EXPECT_EQ(m(1, 1), 2.0);
  EXPECT_TRUE(std::isnan(m(0, 1)));
  double b[2] = {8.0, 14.0};
  cholesky_solve(m.a.data(), 2, m.stride, b);
  EXPECT_EQ(b[0], 0.75);
  EXPECT_EQ(b[1], 2.5);
  cholesky_inverse(m.a.data(), 2, m.stride);
  EXPECT_EQ(m(0, 0), 0.3125);
  EXPECT_EQ(m(0, 1), -0.125);
  EXPECT_EQ(m(1, 0), -0.125);
  EXPECT_EQ(m(1, 1), 0.25);
  EXPECT_TRUE(m.margin_untouched());
}

TEST(Cholesky, OneByOne) {
  double a = 9.0;
  double b = 6.0;
  ASSERT_TRUE(cholesky_factor(&a, 1, 1));
  cholesky_solve(&a, 1, 1, &b);
  EXPECT_DOUBLE_EQ(b, 2.0 / 3.0);
  cholesky_inverse(&a, 1, 1);
  EXPECT_DOUBLE_EQ(a, 1.0 / 9.0);
}

TEST(Cholesky, RefusesWhatIsNotPositiveDefinite) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, inf, -inf, std::nan("")}) {
    double a[4] = {1.0, 0.0, 0.0, bad};
    EXPECT_FALSE(cholesky_factor(a, 2, 2)) << bad;
    double first[4] = {bad, 0.0, 0.0, 1.0};
    EXPECT_FALSE(cholesky_factor(first, 2, 2)) << bad;
  }
  double off[4] = {1.0, 0.0, std::nan(""), 1.0};
  EXPECT_FALSE(cholesky_factor(off, 2, 2));
  double indefinite[4] = {1.0, 2.0, 2.0, 1.0};
  EXPECT_FALSE(cholesky_factor(indefinite, 2, 2));
  double semidefinite[4] = {1.0, 1.0, 1.0, 1.0};
  EXPECT_FALSE(cholesky_factor(semidefinite, 2, 2));
}

TEST(Cholesky, RefusesArgumentsThatMakeNoMatrix) {
  double a[4] = {1.0, 0.0, 0.0, 1.0};
  EXPECT_FALSE(cholesky_factor(nullptr, 2, 2));
  EXPECT_FALSE(cholesky_factor(a, 0, 2));
  EXPECT_FALSE(cholesky_factor(a, 2, 1));
  EXPECT_FALSE(cholesky_factor_packed(nullptr, 2));
  EXPECT_FALSE(cholesky_factor_packed(a, 0));
}

RC_GTEST_PROP(CholeskyLaw, FactorTimesItsTransposeIsTheMatrix, ()) {
  const Matrix a = any_positive(1e-6);
  Matrix l = a;
  RC_ASSERT(cholesky_factor(l.a.data(), l.n, l.stride));
  for (int i = 0; i < a.n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = 0; k <= j; ++k) sum += l(i, k) * l(j, k);
      RC_ASSERT(std::fabs(sum - a(i, j)) <= 1e-14 * a.n);
    }
    for (int j = i + 1; j < a.n; ++j) RC_ASSERT(l(i, j) == a(i, j));
  }
  RC_ASSERT(l.margin_untouched());
}

RC_GTEST_PROP(CholeskyLaw, SolutionSatisfiesTheEquations, ()) {
  const Matrix a = any_positive(1e-3);
  std::vector<double> b(static_cast<std::size_t>(a.n));
  for (double& v : b) v = any_entry();
  Matrix l = a;
  RC_ASSERT(cholesky_factor(l.a.data(), l.n, l.stride));
  std::vector<double> x = b;
  cholesky_solve(l.a.data(), l.n, l.stride, x.data());
  double size = 0.0;
  for (const double v : x) size += std::fabs(v);
  for (int i = 0; i < a.n; ++i) {
    double sum = -b[static_cast<std::size_t>(i)];
    for (int j = 0; j < a.n; ++j) sum += a(i, j) * x[static_cast<std::size_t>(j)];
    RC_ASSERT(std::fabs(sum) <= 1e-14 * a.n * (1.0 + a.n * size));
  }
}

RC_GTEST_PROP(CholeskyLaw, InverseIsSymmetricAndInverts, ()) {
  const double d = 1e-3;
  const Matrix a = any_positive(d);
  Matrix v = a;
  RC_ASSERT(cholesky_factor(v.a.data(), v.n, v.stride));
  cholesky_inverse(v.a.data(), v.n, v.stride);
  RC_ASSERT(v.margin_untouched());
  for (int i = 0; i < a.n; ++i) {
    for (int j = 0; j < a.n; ++j) {
      RC_ASSERT(v(i, j) == v(j, i));
      double sum = i == j ? -1.0 : 0.0;
      for (int k = 0; k < a.n; ++k) sum += a(i, k) * v(k, j);
      RC_ASSERT(std::fabs(sum) <= 1e-15 * a.n * (a.n * a.n + d) / d);
    }
  }
}

RC_GTEST_PROP(CholeskyLaw, ANegativeDirectionIsAlwaysRefused, ()) {
  // Subtract more than the whole trace along one direction: x'Ax < 0 there.
  Matrix a = any_positive(1e-3);
  double trace = 0.0;
  for (int i = 0; i < a.n; ++i) trace += a(i, i);
  const int k = *rc::gen::inRange(0, a.n);
  a(k, k) -= 1.01 * trace;
  RC_ASSERT(!cholesky_factor(a.a.data(), a.n, a.stride));
}

TEST(Cholesky, PackedIsTheSameDigitForDigit) {
  constexpr int kSize = 7;
  Matrix a(kSize, 2);
  std::vector<double> packed, x(kSize), y(kSize);
  for (int i = 0; i < kSize; ++i) {
    x[static_cast<std::size_t>(i)] = y[static_cast<std::size_t>(i)] = 1.0 / (i + 1);
    for (int j = 0; j <= i; ++j) {
      a(i, j) = i == j ? 3.0 + i : 0.3 * std::sin(1.0 + i * j);
      packed.push_back(a(i, j));
    }
  }
  ASSERT_TRUE(cholesky_factor(a.a.data(), kSize, a.stride));
  ASSERT_TRUE(cholesky_factor_packed(packed.data(), kSize));
  cholesky_solve(a.a.data(), kSize, a.stride, x.data());
  cholesky_solve_packed(packed.data(), kSize, y.data());
  EXPECT_EQ(x, y);
  packed[0] = -1.0;
  EXPECT_FALSE(cholesky_factor_packed(packed.data(), kSize));
}

}  // namespace
}  // namespace cholesky_test
}  // namespace plumb
