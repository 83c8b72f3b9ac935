// A recalibration that a snapshot feigns: whichever small figure was exchanged, an alarm ends it, and when it is over
// the monitor is in a state that a calibrated one can be in.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "snapshot_support.hpp"

namespace forged_recalibration_test {
namespace {

using namespace plumb;
using plumb_test::Bytes;
using plumb_test::Places;
using plumb_test::snapshot_of;
using plumb_test::Tool;

/// Calls `after` with the monitor that took up the snapshot with one of its figures of a byte exchanged, for every one
/// of them and every value that an enumeration may have, where that monitor is still being recalibrated.
int taken_up_with_any_small_figure(HealthMonitor& monitor, const MonitorSetup& setup,
                                   const std::function<void(HealthMonitor&, const std::string&)>& after) {
  const Bytes good = snapshot_of(monitor);
  const auto victim = std::make_unique<HealthMonitor>();
  int taken = 0;
  for (const Places::Place& place : Places(monitor).list) {
    if (place.width != 1) continue;
    for (int value = 0; value <= static_cast<int>(kLastCause); ++value) {
      Bytes bytes = good;
      bytes[place.at] = static_cast<std::uint8_t>(value);
      if (!plumb_test::is_taken_up(*victim, setup, bytes) || victim->mode() != Mode::recalibrating) continue;
      ++taken;
      after(*victim, "byte " + std::to_string(place.at) + " = " + std::to_string(value));
    }
  }
  return taken;
}

/// Asked for because the length of gravity was off, so that more of the same is no news. What the monitor says that it
/// was suspicious of must not make it deaf to an alarm.
// Negative: REQ-163
TEST(ForgedRecalibration, NoFigureHidesAnAlarm) {
  Tool tool(4, {}, 5);
  tool.rig.prove();
  HealthMonitor& monitor = tool.rig.monitor;
  tool.visit(2, 1.01 * kG0_mps2);
  ASSERT_TRUE(monitor.request_recalibration().has_value());
  tool.visit(1, 1.01 * kG0_mps2);
  ASSERT_EQ(tool.state(), HealthState::recalibrating);
  const auto before = std::make_unique<HealthMonitor>(monitor);
  tool.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  std::vector<Sample> samples;
  const Vec3 u = plumb_test::random_direction(tool.directions);
  for (int k = 0; k < 2 * tool.rig.setup.config.window; ++k) {
    samples.push_back(tool.rig.sample(u, kG0_mps2));
    monitor.step(samples.back());
  }
  ASSERT_EQ(monitor.mode(), Mode::suspect);
  const int taken = taken_up_with_any_small_figure(
      *before, tool.rig.setup, [&samples](HealthMonitor& victim, const std::string& forged) {
        for (const Sample& sample : samples) victim.step(sample);
        const bool blind = victim.verdict().cause == Cause::rotating;  // the host is said to have told so
        EXPECT_TRUE(blind || victim.mode() != Mode::recalibrating) << forged;
      });
  EXPECT_GT(taken, 100);
}

/// A calibration is on trial, and a day later its time is over: the monitor goes back to where it came from.
// Negative: REQ-163
TEST(ForgedRecalibration, NoFigureLeadsBackToWhereACalibratedMonitorCannotBe) {
  Tool tool(4, {}, 7);
  tool.rig.prove();
  SensorArray array = tool.rig.setup.array;
  plumb_test::leave_uncertainty(array, 3e-4, 3e-5);
  HealthMonitor& monitor = tool.rig.monitor;
  ASSERT_TRUE(monitor.offer_calibration(tool.rig.setup.model, array).has_value());
  tool.visit(1);
  ASSERT_EQ(tool.state(), HealthState::recalibrating);
  const auto before = std::make_unique<HealthMonitor>(monitor);
  std::vector<Sample> samples;
  for (int k = 0; k < 2 * tool.rig.setup.config.window; ++k) {
    samples.push_back(tool.rig.sample(plumb_test::direction_at(33, 71), kG0_mps2));
    samples.back().time_s += 2.0 * OfferedCalibration::kLife_s;
  }
  const int taken = taken_up_with_any_small_figure(*before, tool.rig.setup,
                                                   [&samples](HealthMonitor& victim, const std::string& forged) {
                                                     for (const Sample& sample : samples) victim.step(sample);
                                                     EXPECT_NE(victim.mode(), Mode::recalibrating) << forged;
                                                     EXPECT_NE(victim.mode(), Mode::initial) << forged;
                                                     EXPECT_NE(victim.mode(), Mode::failed) << forged;
                                                   });
  EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace forged_recalibration_test
