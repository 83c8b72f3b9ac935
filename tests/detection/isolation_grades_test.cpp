// Isolation over any evidence: silent channels, blocks without samples, several faults, free fall. What it says keeps
// to its grades, whatever it is asked.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "plumb/detection/isolation.hpp"
#include "support/simulated_tool.hpp"

namespace isolation_grades_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

constexpr double kSigma = 2e-4 * kG0_mps2;

/// Three pairs of parallel axes: whole planes are lost with two sensors.
SensorArray pairs() {
  AxisList axes{};
  for (int i = 0; i < 6; ++i)
    axes[static_cast<std::size_t>(i)][static_cast<std::size_t>(i / 2)] = i % 2 == 0 ? 1.0 : -1.0;
  return plumb_test::make_array(axes, 6, kSigma);
}

/// Three axes in a plane and two that leave it a little: sets of rank 3 whose members are checked badly.
SensorArray flat() {
  AxisList axes{};
  for (int i = 0; i < 5; ++i) {
    const double a = 2.0 * kPi * i / 5, lift = i < 3 ? 0.0 : 0.02;
    axes[static_cast<std::size_t>(i)] = {std::cos(a) * std::sqrt(1.0 - lift * lift),
                                         std::sin(a) * std::sqrt(1.0 - lift * lift), lift};
  }
  return plumb_test::make_array(axes, 5, kSigma);
}

SensorArray uncertain(SensorArray array, double bias_mps2, double axis_rad) {
  RowUncertainty u;
  for (int a = 0; a < 4 * array.size(); ++a) {
    const double sigma = a % 4 == 3 ? bias_mps2 : axis_rad;
    u.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = sigma * sigma;
  }
  array.set_uncertainty(u);
  return array;
}

struct Asked {
  Noise& luck;
  SensorArray array;
  BlockEvidence block;

  int whole(int from, int to) { return from + static_cast<int>(luck.uniform() * (to - from + 1)); }
  SensorSet some(double share) {
    SensorSet out;
    for (int i = 0; i < array.size(); ++i) {
      if (luck.uniform() < share) out = out.with(i);
    }
    return out;
  }
  /// One attitude, none in free fall; up to three faults of any size; a channel may be silent.
  void next() {
    const double g = luck.uniform() < 0.05 ? 0.0 : luck.uniform() < 0.2 ? 1.01 * kG0_mps2 : kG0_mps2;
    const Vec3 u = plumb_test::random_direction(luck);
    block = BlockEvidence{};
    block.usable = luck.uniform() < 0.6 ? array.all() : some(0.8);
    block.samples = luck.uniform() < 0.03 ? 0.0 : 32.0;
    const bool noisy = luck.uniform() < 0.9;
    const int faults = whole(0, 3);
    const SensorSet faulty = some(0.2 * faults);
    for (int i = 0; i < array.size(); ++i) {
      const double fault = faulty.has(i) ? std::pow(10.0, 4.0 * luck.uniform() - 3.0) * (luck.uniform() - 0.5) : 0.0;
      block.mean_mps2[static_cast<std::size_t>(i)] =
          dot(array.axis(i), u) * g + fault + (noisy ? kSigma / std::sqrt(32.0) * luck.normal() : 0.0);
    }
  }
};

void expect_kept_to_grades(const Isolation& isolation, const IsolationAnswer& answer) {
  const SensorSet monitored = isolation.monitored();
  ASSERT_TRUE(monitored.contains(answer.strict | answer.parity));
  ASSERT_LE(answer.strict.size(), isolation.confirmed_grade());
  ASSERT_LE(answer.parity.size(), isolation.provisional_grade());
  ASSERT_GE(answer.live, 0);
  ASSERT_LE(answer.live, answer.voting);
  ASSERT_FALSE(answer.no_consistent_hypothesis && !answer.strict.empty());
}

void run(const SensorArray& array, std::uint64_t seed, int rounds) {
  Noise luck(seed);
  const TestLimits limits = TestLimits::from_rates(array.size(), 1e-5, 1e-6);
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  Asked asked{luck, array, {}};
  Isolation isolation;
  isolation.pose(array, array.all());
  for (int k = 0; k < rounds; ++k) {
    if (k % 40 == 0) {
      isolation.clear();
      isolation.pose(array, k % 80 == 0 ? array.all() : asked.some(0.85));
    }
    asked.next();
    const BlockTests tests(array, gravity, limits, asked.block);
    const SensorSet corroborating = luck.uniform() < 0.7 ? array.all() : asked.some(0.7);
    if (luck.uniform() < 0.5) expect_kept_to_grades(isolation, isolation.vote(tests, corroborating));
    const int asserted = asked.whole(-1, 4);
    const ProtectionTerms protect = {asked.whole(0, 4), 5.0};
    const FaultSetScan scan = isolation.scan(tests, luck.uniform() < 0.6 ? array.all() : asked.some(0.9),
                                             asked.whole(-1, 5), asserted, protect, corroborating);
    ASSERT_TRUE(array.all().contains(scan.asserted | scan.suspects));
    ASSERT_LE(scan.asserted.size(), std::max(asserted, 0));
    ASSERT_TRUE(std::isfinite(scan.protection_rad));
    if (asked.block.samples == 0.0) {
      ASSERT_FALSE(scan.protection_available);
    }
    if (testing::Test::HasFatalFailure()) return;
  }
}

// Negative: REQ-070
TEST(IsolationGrades, AnyEvidenceIsAnsweredWithinThem) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const int n : {3, 4, 5, 8}) {
      AxisList axes{};
      const SensorArray array = n == 3   ? plumb_test::make_array(axes, orthogonal_triad(axes), kSigma)
                                : n == 4 ? plumb_test::tetrahedron(kSigma)
                                         : plumb_test::cone_array(n, kSigma);
      run(array, seed, n == 8 ? 120 : 400);
      run(uncertain(array, 1e-3, 1e-4), seed + 10, n == 8 ? 120 : 400);
    }
    for (const SensorArray& array : {pairs(), flat(), uncertain(flat(), 1e-3, 1e-4), uncertain(pairs(), 1e-2, 1e-3)})
      run(array, seed + 20, 400);
  }
}

}  // namespace
}  // namespace isolation_grades_test
