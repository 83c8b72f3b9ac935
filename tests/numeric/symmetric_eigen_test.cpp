#include "plumb/numeric/symmetric_eigen.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace plumb {
namespace symmetric_eigen_test {
namespace {

constexpr double kSentinel = -12345.0;
constexpr int kLargest = plumb::kMaxEigenSize;

struct Problem {
  int n = 0;
  int stride = 0;
  std::vector<double> a;
  std::vector<double> values;
  std::vector<double> vectors;

  Problem(int size, int extra)
      : n(size),
        stride(size + extra),
        a(static_cast<std::size_t>(size * (size + extra)), kSentinel),
        values(static_cast<std::size_t>(size), kSentinel),
        vectors(a.size(), kSentinel) {}
  std::size_t at(int i, int j) const { return static_cast<std::size_t>(i * stride + j); }
  void set(int i, int j, double v) {
    a[at(i, j)] = v;
    a[at(j, i)] = v;
  }
  double vector(int i, int k) const { return vectors[at(i, k)]; }
  double value(int k) const { return values[static_cast<std::size_t>(k)]; }
  bool solve() { return symmetric_eigen(a.data(), n, stride, values.data(), vectors.data()); }
};

double frobenius(const Problem& p) {
  double sum = 0.0;
  for (int i = 0; i < p.n; ++i) {
    for (int j = 0; j < p.n; ++j) sum += p.a[p.at(i, j)] * p.a[p.at(i, j)];
  }
  return std::sqrt(sum);
}

/// The whole contract at once: A V = V D, V'V = I, ascending, margins left alone. Empty where it holds.
const char* violation(const Problem& before, const Problem& after) {
  const double tolerance = 1e-14 * before.n * (frobenius(before) + std::numeric_limits<double>::min());
  for (int k = 0; k < after.n; ++k) {
    if (k > 0 && after.value(k) < after.value(k - 1)) return "not ascending";
    for (int i = 0; i < after.n; ++i) {
      double residual = -after.value(k) * after.vector(i, k);
      double overlap = i == k ? -1.0 : 0.0;
      for (int j = 0; j < after.n; ++j) {
        residual += before.a[before.at(i, j)] * after.vector(j, k);
        overlap += after.vector(j, i) * after.vector(j, k);
      }
      if (!(std::fabs(residual) <= tolerance)) return "A v is not lambda v";
      if (!(std::fabs(overlap) <= 1e-14 * before.n)) return "vectors not orthonormal";
    }
    for (int j = after.n; j < after.stride; ++j) {
      if (after.a[after.at(k, j)] != kSentinel || after.vectors[after.at(k, j)] != kSentinel) return "margin written";
    }
  }
  return "";
}

double any_entry() {
  return *rc::gen::weightedOneOf<int>(
             {{6, rc::gen::inRange(-1000, 1001)}, {2, rc::gen::elementOf(std::vector<int>{0, 0, 1, -1, 1000})}}) /
         1000.0;
}

TEST(SymmetricEigen, TwoByTwo) {
  Problem p(2, 1);
  p.set(0, 0, 2.0);
  p.set(0, 1, 1.0);
  p.set(1, 1, 2.0);
  const Problem before = p;
  ASSERT_TRUE(p.solve());
  EXPECT_NEAR(p.value(0), 1.0, 1e-15);
  EXPECT_NEAR(p.value(1), 3.0, 1e-15);
  EXPECT_STREQ(violation(before, p), "");
}

TEST(SymmetricEigen, SecondDifferencesHaveTheirKnownSpectrumAtEverySize) {
  for (const int n : {1, 2, 3, 10, kLargest}) {
    Problem p(n, 0);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) p.a[p.at(i, j)] = i == j ? 2.0 : std::abs(i - j) == 1 ? -1.0 : 0.0;
    }
    const Problem before = p;
    ASSERT_TRUE(p.solve()) << n;
    for (int k = 0; k < n; ++k) {
      const double half = std::sin(std::acos(-1.0) * (k + 1) / (2.0 * (n + 1)));
      EXPECT_NEAR(p.value(k), 4.0 * half * half, 1e-13);
    }
    EXPECT_STREQ(violation(before, p), "");
  }
}

TEST(SymmetricEigen, ZeroAndIdentity) {
  for (const double d : {0.0, 1.0}) {
    Problem p(5, 2);
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j < 5; ++j) p.a[p.at(i, j)] = i == j ? d : 0.0;
    }
    ASSERT_TRUE(p.solve());
    for (int k = 0; k < 5; ++k) {
      EXPECT_EQ(p.value(k), d);
      EXPECT_EQ(p.vector(k, k), 1.0);
    }
  }
}

TEST(SymmetricEigen, AGradedMatrixKeepsTheDigitsOfItsSmallValue) {
  // det = 1e-20 (1 - 1/4) and the large value is 1 + 1e-20/4: the small one is 0.75e-20.
  Problem p(2, 0);
  p.set(0, 0, 1.0);
  p.set(0, 1, 0.5e-10);
  p.set(1, 1, 1e-20);
  ASSERT_TRUE(p.solve());
  EXPECT_NEAR(p.value(0) / 0.75e-20, 1.0, 1e-14);
}

TEST(SymmetricEigen, ExtremeScalesNeitherOverflowNorVanish) {
  for (const double scale : {1e-300, 1e300}) {
    Problem p(2, 0);
    p.set(0, 0, 2.0 * scale);
    p.set(0, 1, scale);
    p.set(1, 1, 2.0 * scale);
    ASSERT_TRUE(p.solve());
    EXPECT_NEAR(p.value(0) / scale, 1.0, 1e-15);
    EXPECT_NEAR(p.value(1) / scale, 3.0, 1e-15);
  }
}

/// Twice the largest number is none.
TEST(SymmetricEigen, RefusesWhoseValuesAreBeyondTheRange) {
  const double most = std::numeric_limits<double>::max();
  for (const double sign : {1.0, -1.0}) {
    Problem p(2, 0);
    p.set(0, 0, sign * most);
    p.set(0, 1, most);
    p.set(1, 1, sign * most);
    EXPECT_FALSE(p.solve());
  }
}

TEST(SymmetricEigen, RefusesWhatIsNoMatrix) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {inf, -inf, std::nan("")}) {
    Problem p(2, 0);
    p.set(0, 0, 1.0);
    p.set(0, 1, bad);
    p.set(1, 1, 1.0);
    EXPECT_FALSE(p.solve());
  }
  Problem p(2, 0);
  EXPECT_FALSE(symmetric_eigen(nullptr, 2, 2, p.values.data(), p.vectors.data()));
  EXPECT_FALSE(symmetric_eigen(p.a.data(), 2, 2, nullptr, p.vectors.data()));
  EXPECT_FALSE(symmetric_eigen(p.a.data(), 2, 2, p.values.data(), nullptr));
  EXPECT_FALSE(symmetric_eigen(p.a.data(), 0, 2, p.values.data(), p.vectors.data()));
  EXPECT_FALSE(symmetric_eigen(p.a.data(), 2, 1, p.values.data(), p.vectors.data()));
  EXPECT_FALSE(symmetric_eigen(p.a.data(), kLargest + 1, kLargest + 1, p.values.data(), p.vectors.data()));
}

TEST(SymmetricEigen, AnEntryBelowTheNormalNumbersTurnsNothing) {
  Problem p(3, 0);
  for (double& v : p.a) v = 0.0;
  p.set(2, 2, 1.0);
  p.set(0, 1, 1e-310);
  ASSERT_TRUE(p.solve());
  EXPECT_EQ(p.values, (std::vector<double>{0.0, 0.0, 1.0}));
  EXPECT_EQ(p.vector(0, 0), 1.0);
  EXPECT_EQ(p.vector(1, 0), 0.0);
}

RC_GTEST_PROP(SymmetricEigenLaw, DecomposesAnySymmetricMatrix, ()) {
  Problem p(*rc::gen::inRange(1, kLargest < 16 ? kLargest + 1 : 17), *rc::gen::inRange(0, 3));
  for (int i = 0; i < p.n; ++i) {
    for (int j = 0; j <= i; ++j) p.set(i, j, any_entry());
  }
  const Problem before = p;
  RC_ASSERT(p.solve());
  RC_ASSERT(std::string(violation(before, p)).empty());
}

RC_GTEST_PROP(SymmetricEigenLaw, GramMatrixHasTheRankOfItsFactorAndNoNegativeValue, ()) {
  const int n = *rc::gen::inRange(2, kLargest < 24 ? kLargest + 1 : 25);
  const int rank = *rc::gen::inRange(0, n);
  std::vector<double> b(static_cast<std::size_t>(n * (rank + 1)));
  for (double& v : b) v = any_entry();
  Problem p(n, 0);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = 0; k < rank; ++k)
        sum += b[static_cast<std::size_t>(i * rank + k)] * b[static_cast<std::size_t>(j * rank + k)];
      p.set(i, j, sum);
    }
  }
  const Problem before = p;
  RC_ASSERT(p.solve());
  RC_ASSERT(std::string(violation(before, p)).empty());
  const double noise = 1e-14 * n * frobenius(before);
  for (int k = 0; k < n; ++k) RC_ASSERT(p.value(k) >= -noise);
  for (int k = 0; k < n - rank; ++k) RC_ASSERT(p.value(k) <= noise);
}

RC_GTEST_PROP(SymmetricEigenLaw, LargestSizeConverges, ()) {
  Problem p(kLargest, 0);
  const int seed = *rc::gen::inRange(1, 1000000);
  const bool deficient = *rc::gen::arbitrary<bool>();
  // A cheap fixed recurrence instead of thousands of generators.
  unsigned state = static_cast<unsigned>(seed);
  const auto next = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<double>(state >> 8U) / 8388608.0 - 1.0;
  };
  std::vector<double> u(static_cast<std::size_t>(kLargest));
  for (double& v : u) v = next();
  for (int i = 0; i < p.n; ++i) {
    for (int j = 0; j <= i; ++j) {
      p.set(i, j, deficient ? u[static_cast<std::size_t>(i)] * u[static_cast<std::size_t>(j)] : next());
    }
  }
  const Problem before = p;
  RC_ASSERT(p.solve());
  RC_ASSERT(std::string(violation(before, p)).empty());
}

}  // namespace
}  // namespace symmetric_eigen_test
}  // namespace plumb
