// Degrees of freedom of the overlapping Allan variance, against the formulas of the handbook.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "plumb/noise/allan.hpp"

namespace equivalent_freedom_test {
namespace {

using namespace plumb;
using noise::Coefficients;

constexpr std::size_t kReadings = 20000;
constexpr double kPhases = kReadings + 1.0;
constexpr Coefficients kQuantisation = {1.0, 0.0, 0.0, 0.0, 0.0}, kWhite = {0.0, 1.0, 0.0, 0.0, 0.0},
                       kFlicker = {0.0, 0.0, 1.0, 0.0, 0.0}, kWalk = {0.0, 0.0, 0.0, 1.0, 0.0};
/// One sample, steps of every lag, and steps of several lags at once.
constexpr std::size_t kLengths[] = {1, 2, 16, 64, 127, 128, 200, 1024};

double found(const Coefficients& terms, std::size_t m) { return noise::equivalent_freedom(terms, kReadings, m, 1.0); }

// Riley, NIST SP 1065, table 5 (empirical equations): they are within a tenth of the truth, from m = 1 within a
// seventh.
TEST(EquivalentFreedom, IsThatOfTheHandbookForEachTypeOfNoise) {
  const double n = kPhases;
  for (const std::size_t length : kLengths) {
    const auto m = static_cast<double>(length);
    const double white = (1.5 * (n - 1.0) / m - 2.0 * (n - 2.0) / n) * 4.0 * m * m / (4.0 * m * m + 5.0);
    const double phase = (n + 1.0) * (n - 2.0 * m) / (2.0 * (n - m));
    const double flicker =
        length == 1 ? 2.0 * (n - 2.0) * (n - 2.0) / (2.3 * n - 4.9) : 5.0 * n * n / (4.0 * m * (n + 3.0 * m));
    const double walk =
        (n - 2.0) / m * (std::pow(n - 1.0, 2) - 3.0 * m * (n - 1.0) + 4.0 * m * m) / std::pow(n - 3.0, 2);
    EXPECT_NEAR(found(kWhite, length) / white, 1.0, 0.01) << "m = " << m;
    EXPECT_NEAR(found(kQuantisation, length) / phase, 1.0, 0.04) << "m = " << m;
    EXPECT_NEAR(found(kFlicker, length) / flicker, 1.0, 0.1) << "m = " << m;
    EXPECT_NEAR(found(kWalk, length) / walk, 1.0, 0.13) << "m = " << m;
  }
}

// Quantisation correlates at three lags only; steps of several lags must neither pass them by nor count them twice.
TEST(EquivalentFreedom, OfQuantisationDoesNotFallWhereLagsAreTakenInSteps) {
  for (std::size_t m = 120; m < 400; m += 7)
    EXPECT_NEAR(found(kQuantisation, m + 1) / found(kQuantisation, m), 1.0, 1e-3) << "m = " << m;
}

TEST(EquivalentFreedom, IsOneWhereTheLogHoldsNothing) {
  EXPECT_EQ(noise::equivalent_freedom(kWhite, 9, 5, 1.0), 1.0);
  EXPECT_EQ(noise::equivalent_freedom(kWhite, 9, 0, 1.0), 1.0);
  EXPECT_EQ(noise::equivalent_freedom(Coefficients{}, 100, 2, 1.0), 1.0);
}

}  // namespace
}  // namespace equivalent_freedom_test
