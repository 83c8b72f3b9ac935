// Recalibration inside the monitor: who may ask, what aborts it, what it may and may not change.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "recalibration_support.hpp"

namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::Rig;

/// A tool whose biases have moved since it was calibrated, by what its calibration leaves room for.
struct Tool {
  explicit Tool(const SensorArray& array, MonitorConfig config = {}, std::uint64_t seed = 1)
      : rig(array, config, seed), directions(seed + 100) {
    plumb_test::leave_uncertainty(rig.setup.array);
    rig.restart();
    rig.distort = [this](int i, double r, int k) { return fault(i, r + bias[static_cast<std::size_t>(i)], k); };
  }
  explicit Tool(int n, MonitorConfig config = {}, std::uint64_t seed = 1)
      : Tool(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), config, seed) {}

  void drift(double size_mps2) {
    for (double& b : bias) b = size_mps2 * (2.0 * directions.uniform() - 1.0);
  }
  void visit(int stations, double g_mps2 = kG0_mps2) {
    for (int k = 0; k < stations; ++k) rig.stay(plumb_test::random_direction(directions), 2, g_mps2);
  }
  /// Proven, asked and taken.
  void begin() {
    rig.prove();
    ASSERT_TRUE(rig.monitor.request_recalibration().has_value());
    rig.stay(direction_at(70, 70));
    ASSERT_EQ(state(), HealthState::recalibrating);
  }
  HealthState state() const { return rig.monitor.verdict().state; }
  double bias_error(SensorSet set) const {
    double sum = 0.0;
    for (int i = 0; i < rig.setup.array.size(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      const double e = rig.monitor.model().sensor[a].bias[0] - bias[a];
      if (set.has(i)) sum += e * e;
    }
    return std::sqrt(sum / set.size());
  }
  int count(HealthEvent event) const {
    return static_cast<int>(std::count_if(rig.records.begin(), rig.records.end(),
                                          [event](const TransitionRecord& r) { return r.event == event; }));
  }
  bool calibration_untouched() const {
    return std::memcmp(&rig.monitor.model(), &rig.setup.model, sizeof(SensorModel)) == 0 &&
           std::memcmp(&rig.monitor.array(), &rig.setup.array, sizeof(SensorArray)) == 0;
  }

  Rig rig;
  Noise directions;
  std::array<double, kCapacity> bias{};
  Rig::Distort fault = [](int, double r, int) { return r; };
};

MonitorConfig after_exclusion() {
  MonitorConfig config;
  config.recalibrate_after_exclusion = true;
  return config;
}

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

TEST(Recalibrating, ByDefaultNobodyRecalibratesUnasked) {
  Tool tool(6);
  tool.drift(2e-3);
  tool.rig.prove();
  tool.fault = [](int i, double r, int) { return i == 1 ? r + 0.3 : r; };
  tool.visit(30);
  EXPECT_EQ(tool.state(), HealthState::isolated);
  EXPECT_EQ(tool.count(HealthEvent::recalibrate), 0);
  EXPECT_TRUE(tool.calibration_untouched());
}

TEST(Recalibrating, DriftAloneStartsNothing) {
  Tool tool(6, after_exclusion());
  tool.rig.prove();
  tool.fault = [](int i, double r, int k) { return i == 2 ? r + 1e-6 * k : r; };
  for (int k = 0; k < 60 && tool.state() == HealthState::nominal; ++k) tool.visit(1);
  EXPECT_EQ(tool.count(HealthEvent::recalibrate), 0);
}

TEST(Recalibrating, AdoptionMustBeEarnedAnew) {
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
      EXPECT_TRUE(v.qualifiers & Qualifier::unproven);
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
      ASSERT_EQ(v.protection_level_rad, w.protection_level_rad);
      ASSERT_EQ(v.validity, w.validity);
      ASSERT_EQ(v.alert, w.alert);
    }
  }
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  EXPECT_GT(compared, 300);
}

/// S16 and S8: an alarm aborts; the calibration stays bit for bit, and no later step adopts what was aborted.
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
  {  // culprit: excluded, by size
    MonitorConfig config;
    config.asserted_faults = 1;
    Tool tool(6, config);
    tool.begin();
    tool.fault = [](int i, double r, int) { return i == 4 ? r + 0.4 : r; };
    tool.rig.stay(direction_at(40, 300));
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::culprit);
    EXPECT_EQ(tool.state(), HealthState::isolated);
    EXPECT_TRUE(tool.calibration_untouched());
  }
  {  // set aside: suspect
    Tool tool(7);
    tool.begin();
    tool.fault = [](int i, double r, int) { return i == 4 ? r + 0.4 : r; };
    tool.rig.stay(direction_at(40, 300));
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::set_aside);
    EXPECT_EQ(tool.state(), HealthState::suspect);
    EXPECT_EQ(tool.rig.monitor.verdict().recalibration.phase, RecalibrationPhase::idle);
  }
  {  // contradiction: suspect ("never more than no fault", and here is one)
    MonitorConfig config;
    config.asserted_faults = 0;
    Tool tool(4, config);
    tool.begin();
    tool.fault = [](int i, double r, int) { return i == 1 ? r + 0.4 : r; };
    tool.rig.stay(direction_at(40, 300));
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::contradiction);
    EXPECT_EQ(tool.state(), HealthState::suspect);
  }
  {  // reference: suspect
    Tool tool(6);
    tool.begin();
    tool.rig.stay(direction_at(40, 300), 1, kG0_mps2 * 1.005);
    EXPECT_EQ(tool.rig.records.back().event, HealthEvent::reference);
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

TEST(Recalibrating, ARefusedFitLeavesEverythingAndSaysWhy) {
  MonitorConfig config;
  config.drift_bias_mps2 = 3e-4;  // the drift of this tool is far more than its datasheet admits
  Tool tool(plumb_test::cone_array(6, 5e-5 * kG0_mps2), config);
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

TEST(Recalibrating, WhoMayAskAndWhen) {
  EXPECT_EQ(HealthMonitor().request_recalibration().error().code, Errc::wrong_state) << "not configured";
  Tool tool(4);
  EXPECT_EQ(tool.rig.monitor.request_recalibration().error().code, Errc::wrong_state) << "unproven";
  tool.rig.prove();
  EXPECT_TRUE(tool.rig.monitor.request_recalibration().has_value()) << "nominal";
  Tool accused(4);
  accused.rig.prove();
  accused.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  accused.rig.stay(direction_at(45, 200));
  const Expected<void> refused = accused.rig.monitor.request_recalibration();
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, Errc::wrong_state);
  EXPECT_EQ(refused.error().value, static_cast<double>(HealthState::suspect));
  accused.visit(8);
  ASSERT_EQ(accused.state(), HealthState::degraded_3_sensor);
  EXPECT_TRUE(accused.rig.monitor.request_recalibration().has_value()) << "degraded: host only";
  Tool lost(4);
  lost.rig.prove();
  lost.fault = [](int i, double r, int) { return i < 2 ? std::numeric_limits<double>::quiet_NaN() : r; };
  lost.rig.stay(direction_at(60, 10));
  ASSERT_EQ(lost.state(), HealthState::failed);
  EXPECT_EQ(lost.rig.monitor.request_recalibration().error().code, Errc::wrong_state);
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
  EXPECT_FALSE(tool.rig.monitor.verdict().protection_available);
  for (int k = 0; k < 40 && tool.count(HealthEvent::fit_accepted) == 0; ++k) tool.visit(1);
  ASSERT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  tool.visit(12);
  EXPECT_EQ(tool.state(), HealthState::degraded_3_sensor);
  EXPECT_EQ(tool.rig.monitor.verdict().validity, Validity::unconfirmed);
  EXPECT_TRUE(tool.rig.monitor.verdict().qualifiers & Qualifier::three_sensor_fit);
}

/// Common drift (heat): parity is silent, the length is off, nobody is accused. The host may ask; the fit mends it.
TEST(Recalibrating, CommonDriftIsMendedOnRequestAndUnconfirmedMeanwhile) {
  Tool tool(6, {}, 3);
  tool.rig.prove();
  tool.bias.fill(2.5e-2);
  for (int k = 0; k < 10 && tool.state() == HealthState::nominal; ++k) tool.visit(1);
  ASSERT_EQ(tool.state(), HealthState::suspect);
  ASSERT_EQ(tool.rig.records.back().cause, Cause::reference);
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
  ASSERT_EQ(tool.rig.records.back().cause, Cause::reference);
  ASSERT_TRUE(tool.rig.monitor.request_recalibration().has_value());
  tool.visit(30, kG0_mps2 * 1.003);
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 0);
  EXPECT_EQ(tool.count(HealthEvent::fit_rejected), 1);
  EXPECT_EQ(tool.state(), HealthState::suspect) << "back to where it came from";
  EXPECT_TRUE(tool.calibration_untouched());
}

/// A sensor that goes on drifting is followed only as far as the bound against the commissioning calibration.
TEST(Recalibrating, ASlowlyDriftingSensorIsNotLaundered) {
  MonitorConfig config;
  config.drift_bias_mps2 = 2e-3;
  config.drift_scale = 1e-4;
  Tool tool(6, config, 6);
  plumb_test::leave_uncertainty(tool.rig.setup.array, 5e-4, 1e-5);
  tool.rig.restart();
  tool.rig.prove();
  tool.fault = [](int i, double r, int k) { return i == 2 ? r + 4e-7 * k : r; };
  double farthest = 0.0;
  for (int k = 0; k < 900 && tool.rig.ever_blamed.empty(); ++k) {
    tool.rig.monitor.request_recalibration();
    tool.visit(1);
    farthest = std::max(farthest, std::fabs(tool.rig.monitor.model().sensor[2].bias[0]));
    const Verdict& v = tool.rig.monitor.verdict();
    EXPECT_TRUE(v.protection_available || v.validity != Validity::valid);
  }
  EXPECT_LE(farthest, Recalibration::kCommissioningSigmas * config.drift_bias_mps2);
  EXPECT_GT(tool.count(HealthEvent::fit_accepted) + tool.count(HealthEvent::fit_rejected), 0);
  EXPECT_EQ(tool.rig.ever_blamed, SensorSet::of(2)) << "in the end it is convicted, and it alone";
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

/// S18 and replay: a copy taken at any step goes on as the original does, fit and adoption included.
TEST(Recalibrating, ReplayIsExactThroughFitAndAdoption) {
  Tool tool(6, after_exclusion(), 9);
  tool.drift(2e-3);
  auto copy = std::make_unique<HealthMonitor>(tool.rig.monitor);
  for (int k = 0; k < 50; ++k) {
    if (k == 10) tool.fault = [](int i, double r, int) { return i == 3 ? r + 0.3 : r; };
    const Vec3 u = plumb_test::random_direction(tool.directions);
    for (int s = 0; s < 64; ++s) {
      const Sample sample = tool.rig.sample(u, kG0_mps2);
      const Verdict& v = tool.rig.step(sample);
      const Verdict& w = copy->step(sample);
      ASSERT_EQ(std::memcmp(&v.gravity_mps2, &w.gravity_mps2, sizeof(Vec3)), 0);
      ASSERT_EQ(v.state, w.state);
      ASSERT_EQ(v.recalibration.phase, w.recalibration.phase);
      if ((k * 64 + s) % 7 == 0) *copy = HealthMonitor(tool.rig.monitor);
    }
  }
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  EXPECT_EQ(std::memcmp(&tool.rig.monitor.model(), &copy->model(), sizeof(SensorModel)), 0);
}

/// S1, S13, S17 with drift, faults and recalibration all at once.
RC_GTEST_PROP(RecalibratingLaw, NobodyHealthyIsBlamedAndValidOutputIsWithinItsBound, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const bool faulty = *rc::gen::arbitrary<bool>();
  Tool tool(n, after_exclusion(), seed);
  tool.drift(2e-3);
  tool.rig.prove();
  const int which = static_cast<int>(tool.directions.uniform() * n);
  const double size = 0.05 * std::pow(20.0, tool.directions.uniform());
  const int onset = 3000 + static_cast<int>(3000.0 * tool.directions.uniform());
  if (faulty) tool.fault = [=](int i, double r, int k) { return i == which && k > onset ? r + size : r; };
  for (int station = 0; station < 60; ++station) {
    if (station == 20) tool.rig.monitor.request_recalibration();
    const Vec3 u = plumb_test::random_direction(tool.directions);
    for (int s = 0; s < 64; ++s) {
      const Verdict& v = tool.rig.step(tool.rig.sample(u, kG0_mps2));
      if (!v.tick || v.validity != Validity::valid) continue;
      RC_ASSERT(v.protection_available);
      RC_ASSERT(angle_between_rad(v.gravity_mps2, u) <= v.protection_level_rad);
    }
    RC_ASSERT((faulty ? SensorSet::of(which) : SensorSet{}).contains(tool.rig.ever_blamed));
  }
  RC_CLASSIFY(tool.count(HealthEvent::fit_accepted) > 0, "accepted");
  RC_CLASSIFY(tool.count(HealthEvent::fit_rejected) > 0, "rejected");
}

}  // namespace
