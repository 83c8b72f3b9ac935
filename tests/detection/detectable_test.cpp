#include "plumb/detection/detectable.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "plumb/numeric/tails.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-055

namespace detectable_test {
namespace {

using namespace plumb;

double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * kPi); }

/// One and three degrees of freedom have closed forms.
double one(double shift, double limit) { return normal_tail(shift - limit) - normal_tail(shift + limit); }
double three(double shift, double limit) {
  return one(shift, limit) - (density(limit - shift) - density(limit + shift)) / shift;
}

TEST(MissedShift, MatchesTheClosedForms) {
  for (const double shift : {0.01, 0.5, 2.0, 7.5, 20.0, 34.0}) {
    for (const double limit : {0.5, 3.3, 4.9, 10.0, 25.0}) {
      EXPECT_NEAR(missed_shift_probability(shift, limit, 1), one(shift, limit), 1e-12) << shift << " " << limit;
      EXPECT_NEAR(missed_shift_probability(shift, limit, 3), three(shift, limit), 1e-11) << shift << " " << limit;
    }
  }
}

TEST(MissedShift, NoShiftIsMissedAsOftenAsNothingAlarms) {
  for (const int dof : {1, 2, 5, 21}) {
    const double limit = std::sqrt(chi2_tail_quantile(1e-3, dof));
    EXPECT_NEAR(missed_shift_probability(0.0, limit, dof), 1.0 - 1e-3, 1e-12);
  }
  EXPECT_EQ(missed_shift_probability(3.0, 0.0, 2), 0.0);
  EXPECT_EQ(missed_shift_probability(100.0, 50.0, 2), 0.0);
  EXPECT_EQ(missed_shift_probability(100.0, 99.0, 2), 1.0);
}

TEST(MissedShift, MatchesASimulation) {
  plumb_test::Noise noise(11);
  const double limit = std::sqrt(chi2_tail_quantile(1e-5, 5)), shift = 6.0;
  int missed = 0;
  constexpr int kTrials = 100000;
  for (int t = 0; t < kTrials; ++t) {
    double square = 0.0;
    for (int k = 0; k < 5; ++k) {
      const double z = noise.normal() + (k == 0 ? shift : 0.0);
      square += z * z;
    }
    if (square <= limit * limit) ++missed;
  }
  const double p = missed_shift_probability(shift, limit, 5);
  EXPECT_NEAR(missed, kTrials * p, 4.0 * std::sqrt(kTrials * p * (1.0 - p)));
}

/// The figures of docs/theory.md, section 7.1: 4.417 + 3.090 for one degree of freedom.
TEST(DetectableShift, OfOneDegreeIsTheSumOfTwoQuantiles) {
  const double limit = std::sqrt(chi2_tail_quantile(1e-5, 1));
  EXPECT_NEAR(detectable_shift(limit, 1, 1e-3), 4.4172 + 3.0902, 1e-3);
  EXPECT_TRUE(std::isnan(detectable_shift(4.0, 0, 1e-3)));
}

TEST(DetectableShift, BeyondTheExactRangeIsABoundThatJoins) {
  for (const int dof : {1, 3, 12}) {
    const double below = detectable_shift(24.999, dof, 1e-3), above = detectable_shift(25.001, dof, 1e-3);
    EXPECT_GE(above, below);
    EXPECT_LE(above - below, 0.003 + (dof - 1) / 49.0);
  }
}

RC_GTEST_PROP(DetectableShiftLaw, IsMissedAsOftenAsAskedFor, ()) {
  const int dof = *rc::gen::inRange(1, 22);
  const double limit =
      std::sqrt(chi2_tail_quantile(std::pow(10.0, -*rc::gen::inRange(2, 12)), dof)) + *rc::gen::inRange(0, 10);
  const double p = std::pow(10.0, -*rc::gen::inRange(1, 9));
  const double shift = detectable_shift(limit, dof, p);
  RC_ASSERT(std::fabs(missed_shift_probability(shift, limit, dof) - p) <= 1e-3 * p + 1e-12);
  RC_ASSERT(shift <= limit + normal_tail_quantile(p));
}

TEST(DetectableShift, BeyondWhatIsComputedItIsTheUpperBound) {
  const double small = detectable_shift(10.0, 3, 1e-3);
  EXPECT_GT(small, 10.0);
  EXPECT_GT(detectable_shift(1e12, 3, 1e-3), 1e12);
  EXPECT_EQ(detectable_shift(25.0, 1, 1e-300), 25.0 + normal_tail_quantile(1e-300));
}

}  // namespace
}  // namespace detectable_test
