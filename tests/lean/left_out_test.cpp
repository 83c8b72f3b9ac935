// Monitors that leave something out (PLUMB_FIRST_CALIBRATION, PLUMB_RECALIBRATION): what is left does what it did, and
// what is not is refused. This file is compiled once for each of them.
#include <gtest/gtest.h>

#include "full_run.hpp"
#include "plumb/health/snapshot.hpp"
#include "short_run.hpp"

namespace left_out_test {
namespace {

using namespace plumb;

static_assert(!kCalibratesItself, "these are the builds that leave it out");

constexpr unsigned state_bit(HealthState state) { return 1U << static_cast<unsigned>(state); }

/// Two minutes of a healthy tool: time enough to earn trust.
std::unique_ptr<HealthMonitor> trusted(const MonitorSetup& setup, ShortRun& run) {
  auto monitor = std::make_unique<HealthMonitor>();
  EXPECT_TRUE(monitor->configure(setup).has_value());
  for (int k = 0; k < 2900; ++k) monitor->step(run.sample(setup.array, k));
  EXPECT_EQ(monitor->verdict().state, HealthState::nominal);
  return monitor;
}

TEST(LeftOut, EveryVerdictIsThatOfTheWholeMonitor) {
  unsigned states = 0, full_states = 0;
  const std::vector<std::uint64_t> lean = short_run(states), full = lean_test::full_run(full_states);
  ASSERT_EQ(lean.size(), static_cast<std::size_t>(kRunSteps));
  ASSERT_EQ(full.size(), lean.size());
  for (std::size_t k = 0; k < lean.size(); ++k) ASSERT_EQ(lean[k], full[k]) << "step " << k;
  EXPECT_EQ(states, full_states);
  for (const HealthState seen : {HealthState::nominal, HealthState::suspect, HealthState::degraded_3_sensor}) {
    EXPECT_TRUE(states & state_bit(seen)) << to_string(seen);
  }
}

TEST(LeftOut, ASetupWithoutCalibrationIsRefused) {
  MonitorSetup setup = four_sensors();
  setup.calibrated = false;
  const Expected<void> sound = checked(setup);
  ASSERT_FALSE(sound.has_value());
  EXPECT_EQ(sound.error().code, Errc::not_calibrated);
  HealthMonitor monitor;
  const Expected<void> ready = monitor.configure(setup);
  ASSERT_FALSE(ready.has_value());
  EXPECT_EQ(ready.error().code, Errc::not_calibrated);
  ShortRun run;
  EXPECT_EQ(monitor.step(run.sample(setup.array, 0)).validity, Validity::invalid);
}

TEST(LeftOut, RecalibrationIsMadeOrRefused) {
  const MonitorSetup setup = four_sensors();
  ShortRun run;
  const auto monitor = trusted(setup, run);
  const Expected<void> offered = monitor->offer_calibration(monitor->model(), monitor->array());
  if (!kRecalibrates) {
    ASSERT_FALSE(offered.has_value());
    EXPECT_EQ(offered.error().code, Errc::wrong_state);
  }
  const Expected<void> asked = monitor->request_recalibration();
  EXPECT_EQ(asked.has_value(), kRecalibrates);
  if (!asked) {
    EXPECT_EQ(asked.error().code, Errc::wrong_state);
  }
  monitor->step(run.sample(setup.array, 2900));
  EXPECT_EQ(monitor->verdict().state == HealthState::recalibrating, kRecalibrates);
}

TEST(LeftOut, AnExclusionAsksForNoRecalibrationThatThereIsNot) {
  MonitorSetup setup = four_sensors();
  setup.config.recalibrate_after_exclusion = true;
  HealthMonitor monitor;
  ASSERT_TRUE(monitor.configure(setup).has_value());
  ShortRun run;
  bool excluded = false;
  for (int k = 0; k < 5500; ++k) {
    const Verdict& v = monitor.step(run.sample(setup.array, k));
    excluded = excluded || !v.excluded.empty();
    if (!kRecalibrates) {
      ASSERT_NE(v.state, HealthState::recalibrating) << "step " << k;
    }
  }
  EXPECT_TRUE(excluded);
}

TEST(LeftOut, ASnapshotIsTakenUp) {
  const MonitorSetup setup = four_sensors();
  ShortRun run;
  const auto monitor = trusted(setup, run);
  static_cast<void>(monitor->request_recalibration());
  monitor->step(run.sample(setup.array, 2900));
  std::vector<std::uint8_t> bytes(HealthMonitor::snapshot_size_max());
  const Expected<std::size_t> size = monitor->snapshot(bytes.data(), bytes.size());
  ASSERT_TRUE(size.has_value());
  const auto back = std::make_unique<HealthMonitor>();
  ASSERT_TRUE(back->restore(setup, bytes.data(), *size).has_value());
  ShortRun other = run;
  for (int k = 2901; k < 3600; ++k) {
    ASSERT_EQ(digest_of(monitor->step(run.sample(setup.array, k))), digest_of(back->step(other.sample(setup.array, k))))
        << "step " << k;
  }
}

}  // namespace
}  // namespace left_out_test
