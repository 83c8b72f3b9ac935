// What each term of noise adds, against the sums and integrals that define it.
#include "plumb/noise/terms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "plumb/core/units.hpp"

namespace terms_test {
namespace {

using namespace plumb;
using namespace plumb::noise;

/// The Allan variance of means over m samples by the power of the samples: an integral over all frequencies.
double by_power(Term term, int m, double period_s) {
  double sum = 0.0;
  const int steps = 100000;
  for (int k = 0; k < steps; ++k) {
    const double cycles = 0.5 * (k + 0.5) / steps, sine = std::sin(kPi * cycles);
    const double filter = std::pow(std::sin(kPi * cycles * m), 4) / (m * m * sine * sine);
    // Two-sided: both signs of the frequency; the filter of the half difference of two means.
    sum += 2.0 * filter * power_of_unit_terms(cycles, period_s)[index(term)] * 0.5 / steps;
  }
  return 2.0 * sum;
}

TEST(NoiseTerms, PowerAndAllanVarianceAreOfTheSameNoise) {
  const double period_s = 0.02;
  for (const Term term : {Term::quantisation, Term::white, Term::bias_instability, Term::random_walk}) {
    for (const int m : {1, 3, 50}) {
      const double expected = allan_variance(term, 1.0, m * period_s);
      EXPECT_NEAR(by_power(term, m, period_s) / expected, 1.0, 2e-3) << to_string(term) << ' ' << m;
    }
  }
}

TEST(NoiseTerms, HaveTheSlopesOfTheStandard) {
  // IEEE Std 952-1997, annex C.
  EXPECT_NEAR(allan_variance(Term::quantisation, 2.0, 10.0), 3.0 * 4.0 / 100.0, 1e-12);
  EXPECT_NEAR(allan_variance(Term::white, 2.0, 10.0), 4.0 / 10.0, 1e-12);
  EXPECT_NEAR(std::sqrt(allan_variance(Term::bias_instability, 2.0, 10.0)), 2.0 * 0.664, 1e-3);
  EXPECT_NEAR(allan_variance(Term::random_walk, 2.0, 10.0), 4.0 * 10.0 / 3.0, 1e-12);
  EXPECT_NEAR(allan_variance(Term::drift_rate, -2.0, 10.0), 4.0 * 100.0 / 2.0, 1e-12);
  EXPECT_NEAR(allan_variance(Coefficients{2.0, 2.0, 0.0, 2.0, 2.0}, 10.0), 0.12 + 0.4 + 40.0 / 3.0 + 200.0, 1e-12);
}

TEST(NoiseTerms, HaveNames) {
  EXPECT_STREQ(to_string(Term::bias_instability), "bias_instability");
  EXPECT_STREQ(symbol(Term::random_walk), "K");
}

}  // namespace
}  // namespace terms_test
