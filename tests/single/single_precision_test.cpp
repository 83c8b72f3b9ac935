// PLUMB_SCALAR=float beside double: the same verdicts, and how far the figures are apart (docs/embedding.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <tuple>

#include "recorded_run.hpp"

namespace single_precision_test {
namespace {

using namespace plumb;
using single_test::Told;

static_assert(kSingle && sizeof(Scalar) == 4, "these tests are of the build in single precision");

double apart(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::fabs(a[k] - b[k]));
  return most;
}

struct Gap {
  double gravity_mps2 = 0.0, healthy_mps2 = 0.0, latest_mps2 = 0.0, protection_rad = 0.0, mae_mps2 = 0.0;
};

class SinglePrecision : public testing::TestWithParam<std::tuple<double, bool>> {};

/// States, masks, causes, validity, usable figures and transitions at every step, so every time to alarm too.
TEST_P(SinglePrecision, DecidesAtEveryStepWhatDoubleDecides) {
  const auto [sigma_mps2, rough] = GetParam();
  std::uint64_t states = 0;
  Gap gap;
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const std::vector<Told> single = recorded_run(sigma_mps2, seed, rough),
                            twice = single_test::double_run(sigma_mps2, seed, rough);
    ASSERT_EQ(single.size(), static_cast<std::size_t>(kRunSteps));
    ASSERT_EQ(twice.size(), single.size());
    for (std::size_t k = 0; k < single.size(); ++k) {
      const Told &a = single[k], &b = twice[k];
      ASSERT_EQ(a.words, b.words) << "seed " << seed << ", step " << k;
      states |= std::uint64_t{1} << a.words[0];
      gap.gravity_mps2 = std::max(gap.gravity_mps2, apart(a.gravity_mps2, b.gravity_mps2));
      const bool healthy = !rough && k < static_cast<std::size_t>(kFirstFault);
      if (healthy) gap.healthy_mps2 = std::max(gap.healthy_mps2, apart(a.gravity_mps2, b.gravity_mps2));
      gap.latest_mps2 = std::max(gap.latest_mps2, apart(a.latest_mps2, b.latest_mps2));
      gap.protection_rad = std::max(gap.protection_rad, std::fabs(a.protection_rad - b.protection_rad));
      for (std::size_t m = 0; m < 2; ++m)
        gap.mae_mps2 = std::max(gap.mae_mps2, std::fabs(a.mae_mps2[m] - b.mae_mps2[m]));
    }
  }
  for (const HealthState seen : {HealthState::nominal, HealthState::suspect, HealthState::degraded_3_sensor}) {
    // Among spikes too few attitudes in a row speak for the calibration, and nobody is excluded by it.
    if (rough && seen == HealthState::degraded_3_sensor) continue;
    EXPECT_TRUE((states >> static_cast<unsigned>(seen)) & 1U) << to_string(seen);
  }
  std::printf(
      "figure: sigma %g m/s^2%s: vector %.1e (healthy %.1e), latest %.1e, mae %.1e m/s^2, protection level %.1e rad\n",
      sigma_mps2, rough ? ", with spikes" : "", gap.gravity_mps2, gap.healthy_mps2, gap.latest_mps2, gap.mae_mps2,
      gap.protection_rad);
  // A spike of 40 m/s^2 that a block's sums are about is rounded by 1.9e-6 of itself; in double it shifts them by 1
  // m/s^2.
  EXPECT_LT(gap.healthy_mps2, 1e-4 * sigma_mps2 + 1e-9);
  EXPECT_LT(gap.gravity_mps2, 2e-5);
  EXPECT_LT(gap.latest_mps2, 1e-6);
  EXPECT_LT(gap.mae_mps2, 1e-6);
  EXPECT_LT(gap.protection_rad, 2e-6);
}

INSTANTIATE_TEST_SUITE_P(Noise, SinglePrecision,
                         testing::Combine(testing::Values(1e-5, 1e-4, 2e-3, 2e-2), testing::Bool()));

TEST(SinglePrecisionSnapshot, GoesOnWhereItStoppedBitForBit) {
  const MonitorSetup setup = four_sensors(2e-3);
  auto monitor = std::make_unique<HealthMonitor>(), back = std::make_unique<HealthMonitor>();
  ASSERT_TRUE(monitor->configure(setup).has_value());
  RecordedRun run(setup, 3, true);
  std::vector<std::uint8_t> bytes(HealthMonitor::snapshot_size_max());
  for (int k = 0; k < 3500; ++k) monitor->step(run.sample(k));
  RecordedRun other = run;
  const auto size = monitor->snapshot(bytes.data(), bytes.size());
  ASSERT_TRUE(size.has_value());
  ASSERT_TRUE(back->restore(setup, bytes.data(), *size).has_value());
  for (int k = 3500; k < 6500; ++k) {
    const Told a = told_by(monitor->step(run.sample(k))), b = told_by(back->step(other.sample(k)));
    ASSERT_EQ(a.words, b.words) << "step " << k;
    ASSERT_EQ(a.gravity_mps2, b.gravity_mps2) << "step " << k;
    ASSERT_EQ(a.latest_mps2, b.latest_mps2) << "step " << k;
    ASSERT_EQ(a.mae_mps2, b.mae_mps2) << "step " << k;
  }
}

}  // namespace
}  // namespace single_precision_test
