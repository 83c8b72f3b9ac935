// Who may ask for a recalibration, and what it may not be used for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "recalibration_support.hpp"

// Serves: REQ-130

namespace recalibrating_request_test {
namespace {

using namespace plumb;
using plumb_test::after_exclusion;
using plumb_test::direction_at;
using plumb_test::Tool;

// Verifies: REQ-134
TEST(Recalibrating, WhoMayAskAndWhen) {
  EXPECT_EQ(HealthMonitor().request_recalibration().error().code, Errc::wrong_state) << "not configured";
  Tool tool(4);
  EXPECT_EQ(tool.rig.monitor.request_recalibration().error().code, Errc::wrong_state) << "not_yet_validated";
  tool.rig.prove();
  EXPECT_TRUE(tool.rig.monitor.request_recalibration().has_value()) << "nominal";
  Tool suspected(4);
  suspected.rig.prove();
  suspected.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  suspected.rig.stay(direction_at(45, 200));
  const Expected<void> refused = suspected.rig.monitor.request_recalibration();
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, Errc::wrong_state);
  EXPECT_EQ(refused.error().value, static_cast<double>(HealthState::suspect));
  suspected.visit(8);
  ASSERT_EQ(suspected.state(), HealthState::degraded_3_sensor);
  EXPECT_TRUE(suspected.rig.monitor.request_recalibration().has_value()) << "degraded: host only";
  Tool lost(4);
  lost.rig.prove();
  lost.fault = [](int i, double r, int) { return i < 2 ? std::numeric_limits<double>::quiet_NaN() : r; };
  lost.rig.stay(direction_at(60, 10));
  ASSERT_EQ(lost.state(), HealthState::failed);
  EXPECT_EQ(lost.rig.monitor.request_recalibration().error().code, Errc::wrong_state);
}

TEST(Recalibrating, RefusedDuringAnAlarmOrAProvisionalExclusion) {
  Tool spike(4);
  spike.rig.prove();
  spike.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  spike.rig.stay(direction_at(45, 200));
  spike.fault = [](int, double r, int) { return r; };
  for (int k = 0; k < 20 && spike.state() != HealthState::nominal; ++k) spike.rig.stay(direction_at(45, 200));
  ASSERT_EQ(spike.state(), HealthState::nominal);
  EXPECT_EQ(spike.rig.monitor.request_recalibration().error().code, Errc::wrong_state) << "the episode is open";
  spike.visit(8);
  EXPECT_TRUE(spike.rig.monitor.request_recalibration().has_value()) << "clean at several attitudes: it is over";
  Tool aside(7);
  aside.rig.prove();
  aside.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  aside.rig.stay(direction_at(45, 200), 5);
  ASSERT_EQ(aside.state(), HealthState::isolated);
  ASSERT_EQ(aside.rig.monitor.verdict().provisionally_excluded, SensorSet::of(2));
  EXPECT_EQ(aside.rig.monitor.request_recalibration().error().code, Errc::wrong_state);
}

TEST(Recalibrating, ThreeSensorsUnderSuspicionMayNotClearThemselves) {
  MonitorConfig config;
  config.assumed_faults = 1;
  Tool tool(4, config);
  tool.rig.prove();
  tool.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  tool.visit(8);
  ASSERT_EQ(tool.state(), HealthState::degraded_3_sensor);
  tool.fault = [](int, double r, int) { return 1.02 * r; };  // a second fault refutes the claim of one
  tool.rig.stay(direction_at(45, 200));
  ASSERT_EQ(tool.state(), HealthState::suspect);
  ASSERT_EQ(tool.rig.records.back().cause, Cause::no_consistent_hypothesis);
  EXPECT_EQ(tool.rig.monitor.request_recalibration().error().code, Errc::wrong_state);
}

TEST(Recalibrating, ARequestDoesNotOutliveTheStateThatTookIt) {
  Tool tool(4);
  tool.rig.prove();
  // The alarm's block ends with the very sample at which the request would be served.
  tool.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  const Vec3 u = direction_at(45, 200);
  for (int k = 0; k < 31; ++k) tool.rig.step(tool.rig.sample(u, kG0_mps2));
  ASSERT_TRUE(tool.rig.monitor.request_recalibration().has_value());
  tool.rig.step(tool.rig.sample(u, kG0_mps2));
  EXPECT_EQ(tool.state(), HealthState::suspect);
  tool.fault = [](int, double r, int) { return r; };
  tool.visit(20);
  EXPECT_EQ(tool.count(HealthEvent::recalibrate), 0);
}

/// A three-sensor fit has nobody to check it: whatever it says, the output stays unconfirmed.
TEST(Recalibrating, ThreeSensorsStayUnconfirmedAfterTheirFit) {
  Tool tool(4);
  tool.drift(1e-3);
  tool.rig.prove();
  tool.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  tool.visit(8);
  ASSERT_EQ(tool.state(), HealthState::degraded_3_sensor);
  ASSERT_TRUE(tool.rig.monitor.request_recalibration().has_value());
  tool.visit(1);
  EXPECT_EQ(tool.state(), HealthState::recalibrating);
  EXPECT_EQ(tool.rig.monitor.verdict().validity, Validity::degraded) << "as the state it came from";
  EXPECT_TRUE(tool.rig.monitor.verdict().alert);
  for (int k = 0; k < 40 && tool.count(HealthEvent::fit_accepted) == 0; ++k) tool.visit(1);
  ASSERT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  tool.visit(12);
  EXPECT_EQ(tool.state(), HealthState::degraded_3_sensor);
  EXPECT_EQ(tool.rig.monitor.verdict().validity, Validity::unconfirmed);
  EXPECT_TRUE(tool.rig.monitor.verdict().qualifiers & Qualifier::three_sensor_fit);
}

/// Common drift (heat): parity is silent, the length is off, nobody is suspected. The host may ask; the fit mends it.
TEST(Recalibrating, CommonDriftIsMendedOnRequestAndUnconfirmedMeanwhile) {
  Tool tool(6, {}, 3);
  tool.rig.prove();
  tool.bias.fill(2.5e-2);
  for (int k = 0; k < 10 && tool.state() == HealthState::nominal; ++k) tool.visit(1);
  ASSERT_EQ(tool.state(), HealthState::suspect);
  ASSERT_EQ(tool.rig.records.back().cause, Cause::norm_mismatch);
  ASSERT_TRUE(tool.rig.monitor.request_recalibration().has_value());
  for (int k = 0; k < 30 && tool.count(HealthEvent::fit_accepted) == 0; ++k) {
    tool.visit(1);
    EXPECT_NE(tool.rig.monitor.verdict().validity, Validity::valid);
  }
  ASSERT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  tool.visit(8);
  EXPECT_EQ(tool.state(), HealthState::nominal);
  EXPECT_LT(tool.bias_error(SensorSet::first(6)), 2e-3);
  EXPECT_TRUE(tool.rig.ever_blamed.empty());
}

TEST(Recalibrating, WrongGravityIsNotPutIntoTheScales) {
  Tool tool(6, {}, 4);
  tool.rig.prove();
  for (int k = 0; k < 10 && tool.state() == HealthState::nominal; ++k) tool.visit(1, kG0_mps2 * 1.003);
  ASSERT_EQ(tool.rig.records.back().cause, Cause::norm_mismatch);
  ASSERT_TRUE(tool.rig.monitor.request_recalibration().has_value());
  tool.visit(30, kG0_mps2 * 1.003);
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 0);
  EXPECT_EQ(tool.count(HealthEvent::fit_rejected), 1);
  const auto rejected = std::find_if(tool.rig.records.begin(), tool.rig.records.end(),
                                     [](const TransitionRecord& r) { return r.event == HealthEvent::fit_rejected; });
  ASSERT_NE(rejected, tool.rig.records.end());
  EXPECT_EQ(rejected->to, HealthState::suspect) << "back to where it came from";
  const Error refusal = tool.rig.monitor.verdict().recalibration.last_refusal;
  EXPECT_EQ(rejected->statistic, refusal.value) << "the record says by how much the fit was refused";
  EXPECT_EQ(rejected->limit, refusal.limit);
  EXPECT_GT(refusal.value, 0.0);
  EXPECT_TRUE(tool.calibration_untouched());
}

/// A sensor that goes on drifting is followed only as far as the bound against the commissioning calibration.
/// Seven sensors on a cone, attitudes within 60 deg of its axis: a common bias along it looks like another length of
/// gravity. A host that asks for a fit under that suspicion gets one, and must not get a false bound with it.
TEST(Recalibrating, AFitUnderSuspicionOfGravityCarriesTheDoubt) {
  const double g = kG0_mps2 * (1.0 - 2.2e-3);
  int adopted = 0;
  int accepted = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Tool tool(7, {}, seed);
    tool.rig.prove();
    for (int k = 0; k < 60; ++k) {
      const double inclination_deg = 60.0 * tool.directions.uniform();
      const double toolface_deg = 360.0 * tool.directions.uniform();
      const Vec3 down = plumb_test::direction_at(inclination_deg, toolface_deg);
      tool.rig.stay(down, 2, g);
      if (tool.rig.monitor.recalibration().progress(tool.rig.monitor.array()).phase == RecalibrationPhase::idle &&
          adopted < static_cast<int>(seed)) {
        (void)tool.rig.monitor.request_recalibration();
      }
      if (tool.count(HealthEvent::fit_accepted) > 0) adopted = static_cast<int>(seed);
      const Verdict& v = tool.rig.monitor.verdict();
      if (v.validity != Validity::valid || !v.protection_available) continue;
      if (tool.count(HealthEvent::fit_accepted) > 0) ++accepted;
      EXPECT_LE(angle_between_rad(v.gravity_mps2, down), v.protection_level_calibrated_axes_rad)
          << "seed " << seed << " station " << k;
    }
  }
  EXPECT_GT(adopted, 0);
  EXPECT_GT(accepted, 0);
}

TEST(Recalibrating, ASlowlyDriftingSensorIsNotFittedAway) {
  constexpr double kStability_mps2 = 2e-3;
  Tool tool(6, {}, 6);
  tool.rig.setup.stability.fill({kStability_mps2, 0.0, 0.0, 0.0});
  plumb_test::leave_uncertainty(tool.rig.setup.array, 5e-4, 1e-5);
  tool.rig.restart();
  tool.rig.prove();
  tool.fault = [](int i, double r, int k) { return i == 2 ? r + 4e-7 * k : r; };
  double farthest = 0.0;
  for (int k = 0; k < 2500 && tool.rig.ever_blamed.empty(); ++k) {
    tool.rig.monitor.request_recalibration();
    tool.visit(1);
    farthest = std::max(farthest, std::fabs(tool.rig.monitor.model().sensor[2].bias[0]));
    const Verdict& v = tool.rig.monitor.verdict();
    EXPECT_TRUE(v.protection_available || v.validity != Validity::valid);
  }
  EXPECT_LE(farthest, DriftBounds::kCommissioningSigmas * kStability_mps2);
  EXPECT_GT(tool.count(HealthEvent::fit_accepted) + tool.count(HealthEvent::fit_rejected), 0);
  EXPECT_EQ(tool.rig.ever_blamed, SensorSet::of(2)) << "in the end it is excluded, and it alone";
}

TEST(Recalibrating, OtherGravityOtherStations) {
  Tool tool(6);
  tool.rig.prove();
  tool.visit(8);
  ASSERT_GT(tool.rig.monitor.recalibration().store().size(), 0);
  GravityReference same = tool.rig.setup.gravity;
  same.g_mps2 += 0.5 * same.sigma_mps2;
  ASSERT_TRUE(tool.rig.monitor.set_gravity(same).has_value());
  EXPECT_GT(tool.rig.monitor.recalibration().store().size(), 0);
  same.g_mps2 += 0.7 * same.sigma_mps2;  // small steps add up
  ASSERT_TRUE(tool.rig.monitor.set_gravity(same).has_value());
  EXPECT_EQ(tool.rig.monitor.recalibration().store().size(), 0);
}

TEST(Recalibrating, AStepIsAtMostOneIterationAndStationsTakenBeforeTheRequestCount) {
  Tool tool(6);
  tool.rig.prove();
  tool.visit(14);
  ASSERT_TRUE(tool.rig.monitor.request_recalibration().has_value());
  std::uint32_t before = 0;
  int steps = 0;
  for (; steps < 40 && tool.count(HealthEvent::fit_accepted) == 0; ++steps) {
    tool.rig.step(tool.rig.sample(direction_at(50, 50), kG0_mps2));
    const std::uint32_t now = tool.rig.monitor.recalibration().iterations();
    EXPECT_LE(now, before + 1U);
    before = now;
  }
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  EXPECT_GE(steps, 3);
}

}  // namespace
}  // namespace recalibrating_request_test
