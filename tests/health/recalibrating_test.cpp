// Recalibration inside the monitor: what aborts it, what it may and may not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "recalibration_support.hpp"

// Serves: REQ-130

namespace recalibrating_test {
namespace {

using namespace plumb;
using plumb_test::after_exclusion;
using plumb_test::direction_at;
using plumb_test::Tool;

TEST(Recalibrating, AfterAnExclusionTheSurvivorsAreCalibratedAnew) {
  for (int n = 5; n <= kCapacity; ++n) {
    Tool tool(n, after_exclusion(), static_cast<std::uint64_t>(n));
    tool.drift(2e-3);
    tool.rig.prove();
    tool.fault = [](int i, double r, int) { return i == 1 ? r + 0.3 : r; };
    tool.visit(8);
    ASSERT_EQ(tool.rig.monitor.verdict().excluded, SensorSet::of(1)) << n;
    ASSERT_EQ(tool.state(), HealthState::recalibrating) << n;
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::recalibrate);
    EXPECT_EQ(tool.rig.records.back().from, HealthState::isolated);
    EXPECT_EQ(tool.rig.records.back().cause, Cause::isolated_fault);
    EXPECT_EQ(tool.rig.monitor.verdict().validity, Validity::valid) << "as the state it came from";
    const SensorSet used = tool.rig.monitor.verdict().in_service;
    const double before = tool.bias_error(used);
    tool.visit(20);
    EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 1) << n;
    EXPECT_EQ(tool.state(), HealthState::isolated) << n;
    EXPECT_EQ(tool.rig.monitor.verdict().validity, Validity::valid);
    EXPECT_LT(tool.bias_error(used), 0.5 * before) << n;
    EXPECT_EQ(
        std::memcmp(&tool.rig.monitor.model().sensor[1], &tool.rig.setup.model.sensor[1], sizeof(SensorCoefficients)),
        0)
        << "the excluded sensor keeps its calibration";
    EXPECT_EQ(tool.count(HealthEvent::recalibrate), 1) << "once per exclusion";
    EXPECT_EQ(tool.rig.ever_blamed, SensorSet::of(1));
  }
}

TEST(Recalibrating, TheSurvivorsMustBeValidatedFirst) {
  MonitorConfig config = after_exclusion();
  config.assumed_faults = 1;
  Tool tool(6, config);
  tool.rig.prove();
  tool.fault = [](int i, double r, int) { return i == 4 ? r + 0.4 : r; };
  ASSERT_EQ(tool.rig.stay(direction_at(40, 300)).state, HealthState::isolated) << "excluded at once";
  EXPECT_EQ(tool.rig.stay(direction_at(40, 300), config.passed_blocks - 1).state, HealthState::isolated);
  EXPECT_EQ(tool.rig.stay(direction_at(40, 300), 2).state, HealthState::recalibrating);
}

TEST(Recalibrating, ByDefaultNoRecalibrationBeginsUnasked) {
  Tool tool(6);
  tool.drift(2e-3);
  tool.rig.prove();
  tool.fault = [](int i, double r, int) { return i == 1 ? r + 0.3 : r; };
  tool.visit(30);
  EXPECT_EQ(tool.state(), HealthState::isolated);
  EXPECT_EQ(tool.count(HealthEvent::recalibrate), 0);
  EXPECT_TRUE(tool.calibration_untouched());
}

// Negative: REQ-134
TEST(Recalibrating, DriftAloneStartsNothing) {
  Tool tool(6, after_exclusion());
  tool.rig.prove();
  tool.fault = [](int i, double r, int k) { return i == 2 ? r + 1e-6 * k : r; };
  for (int k = 0; k < 60; ++k) tool.visit(1);
  EXPECT_EQ(tool.state(), HealthState::nominal);
  EXPECT_GT(tool.rig.monitor.verdict().drift_mps2_per_h[2], 0.1) << "it is told";
  EXPECT_EQ(tool.count(HealthEvent::recalibrate), 0);
}

// Verifies: REQ-133
TEST(Recalibrating, AdoptionNeedsANewValidation) {
  Tool tool(6);
  tool.drift(2e-3);
  tool.begin();
  for (int k = 0; k < 30 && tool.count(HealthEvent::fit_accepted) == 0; ++k) {
    const Vec3 u = plumb_test::random_direction(tool.directions);
    for (int s = 0; s < 64; ++s) {
      const Verdict v = tool.rig.step(tool.rig.sample(u, kG0_mps2));
      if (v.transition.event != HealthEvent::fit_accepted) continue;
      EXPECT_EQ(v.state, HealthState::suspect);
      EXPECT_EQ(v.validity, Validity::invalid) << "no block has been seen through the new coefficients";
      EXPECT_TRUE(v.qualifiers & Qualifier::not_yet_validated);
      EXPECT_EQ(v.mae_all_mps2, 0.0);
      EXPECT_EQ(v.transition.sensors, SensorSet::first(6));
    }
  }
  ASSERT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  EXPECT_EQ(tool.rig.stay(direction_at(33, 44), 10).state, HealthState::suspect) << "one attitude proves nothing";
  tool.visit(6);
  EXPECT_EQ(tool.state(), HealthState::nominal);
}

/// S8: while the fit is made, what is published is that of a monitor that makes none, bit for bit.
// Negative: REQ-132
TEST(Recalibrating, NoShadowValueReachesAnOutput) {
  Tool tool(6, after_exclusion(), 5);
  tool.drift(2e-3);
  auto twin = std::make_unique<HealthMonitor>();
  MonitorSetup never = tool.rig.setup;
  never.config.recalibrate_after_exclusion = false;
  ASSERT_TRUE(twin->configure(never).has_value());
  int compared = 0;
  for (int k = 0; k < 60; ++k) {
    if (k == 10) tool.fault = [](int i, double r, int) { return i == 3 ? r + 0.3 : r; };
    const Vec3 u = plumb_test::random_direction(tool.directions);
    for (int s = 0; s < 64; ++s) {
      const Sample sample = tool.rig.sample(u, kG0_mps2);
      const Verdict& v = tool.rig.step(sample);
      const Verdict& w = twin->step(sample);
      if (tool.count(HealthEvent::fit_accepted) > 0) break;
      compared += v.state == HealthState::recalibrating ? 1 : 0;
      ASSERT_EQ(std::memcmp(&v.gravity_mps2, &w.gravity_mps2, sizeof(Vec3)), 0);
      ASSERT_EQ(std::memcmp(&v.covariance, &w.covariance, sizeof(Mat3)), 0);
      ASSERT_EQ(v.protection_level_calibrated_axes_rad, w.protection_level_calibrated_axes_rad);
      ASSERT_EQ(v.validity, w.validity);
      ASSERT_EQ(v.alert, w.alert);
    }
  }
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  EXPECT_GT(compared, 300);
}

/// S16 and S8: an alarm aborts; the calibration stays bit for bit, and no later step adopts what was aborted.
// Verifies: REQ-132
TEST(Recalibrating, AnAlarmAbortsAndChangesNothing) {
  Tool tool(4);
  tool.drift(2e-3);
  tool.begin();
  tool.visit(8);
  EXPECT_GT(tool.rig.monitor.verdict().recalibration.stations, 0);
  tool.fault = [](int i, double r, int) { return i == 2 ? r + 0.2 : r; };
  tool.rig.stay(direction_at(45, 200));
  EXPECT_EQ(tool.state(), HealthState::suspect);
  EXPECT_EQ(tool.rig.records.back().event, HealthEvent::alarm);
  EXPECT_EQ(tool.rig.monitor.verdict().recalibration.phase, RecalibrationPhase::idle);
  EXPECT_EQ(tool.rig.monitor.recalibration().store().size(), 0);
  EXPECT_TRUE(tool.calibration_untouched());
  tool.visit(20);
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 0);
  EXPECT_TRUE(tool.calibration_untouched());
}

TEST(Recalibrating, EveryOtherEventOfTheTableDoesWhatItSays) {
  const auto silent = [](int which) {
    return [which](int i, double r, int) { return i == which ? std::numeric_limits<double>::quiet_NaN() : r; };
  };
  {  // channel lost: suspect, absent
    Tool tool(6);
    tool.begin();
    tool.fault = silent(0);
    tool.rig.stay(direction_at(70, 70));
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::channel_lost);
    EXPECT_EQ(tool.state(), HealthState::suspect);
    EXPECT_EQ(tool.rig.monitor.verdict().absent, SensorSet::of(0));
    EXPECT_TRUE(tool.calibration_untouched());
  }
  {  // channel back: stays, towards probation; reset and a second request: ignored, refused
    MonitorConfig config;
    config.probation_stations = 3;
    Tool tool(6, config);
    tool.rig.prove();
    tool.fault = silent(0);
    tool.visit(2);
    tool.begin();
    tool.fault = [](int, double r, int) { return r; };
    tool.rig.stay(direction_at(70, 70));
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::channel_back);
    EXPECT_EQ(tool.state(), HealthState::recalibrating);
    EXPECT_EQ(tool.rig.monitor.verdict().excluded, SensorSet::of(0));
    ASSERT_TRUE(tool.rig.monitor.reset(tool.rig.setup.config.reset_key, SensorSet::first(6)).has_value());
    tool.rig.stay(direction_at(70, 70));
    EXPECT_EQ(tool.state(), HealthState::recalibrating);
    EXPECT_EQ(tool.rig.monitor.verdict().excluded, SensorSet::of(0));
    EXPECT_EQ(tool.rig.monitor.request_recalibration().error().code, Errc::wrong_state);
    tool.visit(4);  // more attitudes than probation asks for
    EXPECT_EQ(tool.state(), HealthState::recalibrating);
    EXPECT_EQ(tool.rig.monitor.verdict().excluded, SensorSet::of(0)) << "probation passed is held";
    tool.visit(30);
    EXPECT_EQ(tool.state(), HealthState::nominal) << "adopted, proven, reinstated";
    EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  }
  {  // isolated: excluded, by size
    MonitorConfig config;
    config.assumed_faults = 1;
    Tool tool(6, config);
    tool.begin();
    tool.fault = [](int i, double r, int) { return i == 4 ? r + 0.4 : r; };
    tool.rig.stay(direction_at(40, 300));
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::exclusion);
    EXPECT_EQ(tool.state(), HealthState::isolated);
    EXPECT_TRUE(tool.calibration_untouched());
  }
  {  // provisionally excluded: suspect
    Tool tool(7);
    tool.begin();
    tool.fault = [](int i, double r, int) { return i == 4 ? r + 0.4 : r; };
    tool.rig.stay(direction_at(40, 300));
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::provisional_exclusion);
    EXPECT_EQ(tool.state(), HealthState::suspect);
    EXPECT_EQ(tool.rig.monitor.verdict().recalibration.phase, RecalibrationPhase::idle);
  }
  {  // contradiction: suspect ("never more than no fault", and here is one)
    MonitorConfig config;
    config.assumed_faults = 0;
    Tool tool(4, config);
    tool.begin();
    tool.fault = [](int i, double r, int) { return i == 1 ? r + 0.4 : r; };
    tool.rig.stay(direction_at(40, 300));
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::no_consistent_hypothesis);
    EXPECT_EQ(tool.state(), HealthState::suspect);
  }
  {  // reference: suspect
    Tool tool(6);
    tool.begin();
    tool.rig.stay(direction_at(40, 300), 1, kG0_mps2 * 1.005);
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::norm_mismatch);
    EXPECT_EQ(tool.state(), HealthState::suspect);
    EXPECT_EQ(tool.rig.monitor.verdict().recalibration.phase, RecalibrationPhase::idle);
  }
}

TEST(Recalibrating, MotionNeitherAbortsNorCollects) {
  Tool tool(6);
  tool.begin();
  tool.visit(5);
  const int before = tool.rig.monitor.recalibration().store().size();
  for (int k = 0; k < 20; ++k) tool.rig.shake(direction_at(30, 10.0 * k), 0.5);
  EXPECT_EQ(tool.state(), HealthState::recalibrating);
  EXPECT_EQ(tool.rig.monitor.verdict().validity, Validity::held);
  EXPECT_EQ(tool.rig.monitor.recalibration().store().size(), before);
}

// Negative: REQ-133
TEST(Recalibrating, ARefusedFitLeavesEverythingAndSaysWhy) {
  Tool tool(plumb_test::cone_array(6, 5e-5 * kG0_mps2), {});
  tool.rig.setup.stability.fill({3e-4, 0.0, 0.0, 0.0});  // the drift of this tool is far more than is stated
  plumb_test::leave_uncertainty(tool.rig.setup.array, 5e-4, 1e-6);
  tool.rig.restart();
  tool.bias[2] = 2e-3;
  tool.begin();
  for (int k = 0; k < 20 && tool.state() == HealthState::recalibrating; ++k) tool.visit(1);
  ASSERT_EQ(tool.count(HealthEvent::fit_rejected), 1);
  const TransitionRecord record = tool.rig.records.back();
  EXPECT_EQ(record.to, HealthState::nominal);
  EXPECT_GT(record.statistic, record.limit);
  const RecalibrationProgress& progress = tool.rig.monitor.verdict().recalibration;
  EXPECT_EQ(progress.last_refusal.code, Errc::implausible);
  EXPECT_EQ(progress.last_refusal.index, 2);
  EXPECT_TRUE(tool.calibration_untouched());
  EXPECT_LT(tool.rig.monitor.recalibration().store().size(), 3) << "no station is tried twice";
}

/// A calibration may leave open more than gravity: then sensors that all read zero are within every limit, and still
/// say no attitude that a fit could be made from.
// Negative: REQ-163
TEST(Recalibrating, ZerosAreNoStationHoweverLooseTheCalibration) {
  plumb_test::Tool tool(4);
  plumb_test::leave_uncertainty(tool.rig.setup.array, 20.0, 1e-4);
  tool.rig.restart();
  tool.begin();
  tool.visit(3);
  const int before = tool.rig.monitor.verdict().recalibration.stations;
  EXPECT_GT(before, 0);
  tool.fault = [](int, double, int) { return 0.0; };
  tool.rig.stay(direction_at(10, 10), 4);
  EXPECT_EQ(tool.state(), HealthState::recalibrating) << "the zeros are within the limits";
  EXPECT_EQ(tool.rig.monitor.verdict().recalibration.stations, before);
}

}  // namespace
}  // namespace recalibrating_test
