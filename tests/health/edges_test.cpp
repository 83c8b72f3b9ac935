// Edges of the health room: setups that are none, names, requests at the wrong time, records of nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "health/recalibration_support.hpp"
#include "health/snapshot_support.hpp"
#include "plumb/calibration/datasheet.hpp"
#include "plumb/health/reference_study.hpp"

namespace health_edges_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;
using plumb_test::Shadow;
using plumb_test::snapshot_of;

// Serves: REQ-101
TEST(HealthEdge, EveryPhaseAndEveryFindingHasAName) {
  EXPECT_STREQ(to_string(RecalibrationPhase::idle), "idle");
  EXPECT_STREQ(to_string(RecalibrationPhase::collecting), "collecting");
  EXPECT_STREQ(to_string(RecalibrationPhase::fitting), "fitting");
  EXPECT_STREQ(to_string(RecalibrationPhase::accepted), "accepted");
  EXPECT_STREQ(to_string(static_cast<RecalibrationPhase>(9)), "?");
  EXPECT_STREQ(to_string(ReferenceKind::none), "none");
  EXPECT_STREQ(to_string(ReferenceKind::undecided), "undecided");
  EXPECT_STREQ(to_string(ReferenceKind::common_scale), "common_scale");
  EXPECT_STREQ(to_string(ReferenceKind::common_bias), "common_bias");
  EXPECT_STREQ(to_string(static_cast<ReferenceKind>(9)), "?");
}

/// A monitor that cannot be is refused by its first use, and a snapshot does not make it one.
// Negative: REQ-170
TEST(HealthEdge, ASetupThatIsNoneIsRefusedByConfigureAndByRestore) {
  Rig rig(plumb_test::tetrahedron());
  const plumb_test::Bytes bytes = snapshot_of(rig.monitor);
  const std::vector<std::function<void(MonitorSetup&)>> wrong = {
      [](MonitorSetup& s) { s.array = SensorArray{}; },
      [](MonitorSetup& s) { s.model.size = 3; },
      [](MonitorSetup& s) { s.config.window = kWindowCapacity + 1; },
      [](MonitorSetup& s) { s.config.window = 0; },
      [](MonitorSetup& s) { s.config.alert_limit_rad = std::numeric_limits<double>::quiet_NaN(); },
      [](MonitorSetup& s) {
        s.config.temperature_min_degc = 80.0;
        s.config.temperature_max_degc = 20.0;
      }};
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    MonitorSetup setup = rig.setup;
    wrong[k](setup);
    HealthMonitor monitor;
    const Expected<void> configured = monitor.configure(setup);
    ASSERT_FALSE(configured.has_value()) << k;
    const Expected<void> restored = monitor.restore(setup, bytes.data(), bytes.size());
    ASSERT_FALSE(restored.has_value()) << k;
    EXPECT_EQ(restored.error().code, configured.error().code) << k;
  }
  MonitorSetup setup;
  EXPECT_FALSE(set_datasheet(Datasheet{}, setup).has_value());
}

// Negative: REQ-163
TEST(HealthEdge, ASizeThatLeavesNoRoomForItsOwnHeaderIsDamage) {
  Rig rig(plumb_test::tetrahedron());
  plumb_test::Bytes bytes = snapshot_of(rig.monitor);
  for (std::size_t k = 24; k < 28; ++k) bytes[k] = 0;
  EXPECT_EQ(snapshot_header(bytes.data(), bytes.size()).error().code, Errc::snapshot_damaged);
}

/// A sensor that reads specific force has the other sign, and the same monitor comes of it.
// Verifies: REQ-010
TEST(HealthEdge, SpecificForceIsGravityTheOtherWayRound) {
  Rig gravity(plumb_test::tetrahedron()), force(plumb_test::tetrahedron());
  force.setup.model.reads = Reads::specific_force;
  force.restart();
  for (int k = 0; k < 300; ++k) {
    const Sample s = gravity.sample(direction_at(20.0 + 30.0 * (k / 64), 100.0 * (k / 64)), kG0_mps2);
    Sample other = s;
    for (double& r : other.raw) r = -r;
    const Verdict& v = gravity.step(s);
    const Verdict& w = force.step(other);
    ASSERT_EQ(v.gravity_mps2, w.gravity_mps2);
    ASSERT_EQ(v.state, w.state);
  }
}

/// Turning so slowly that nothing shows of it, and faster; known, and with a channel that is silent.
// Verifies: REQ-065
TEST(HealthEdge, ARateThatIsKnownAndSmallLocksNothing) {
  const auto locked_at = [](double rate_radps, bool arms) {
    Rig rig(plumb_test::cone_array(5));
    rig.setup.lever_arms_known = arms;
    rig.setup.lever_arm_m[2] = {0.01, 0.0, 0.02};
    rig.restart();
    rig.prove();
    EXPECT_TRUE(rig.monitor.set_rotation({true, true, {0.0, 0.0, rate_radps}}).has_value());
    bool turning = false;
    for (int k = 0; k < 2 * 32; ++k) {
      Sample s = rig.sample(direction_at(20, 30), kG0_mps2);
      if (k % 8 == 3) s.delivered = s.delivered.without(4);
      turning = turning || rig.step(s).cause == Cause::rotating;
    }
    return turning;
  };
  EXPECT_FALSE(locked_at(1e-6, false));
  EXPECT_TRUE(locked_at(1.0, false));
  EXPECT_FALSE(locked_at(1e-3, true));
}

// Negative: REQ-062
TEST(ReferenceStudyEdge, WhatIsNoAttitudeIsNotTaken) {
  ReferenceStudy study;
  study.add({0.0, 0.0, 0.0}, 0.01, 0.001, 0.1);
  study.add({0.0, 0.0, 1.0}, 0.01, 0.0, 0.1);
  study.add({0.0, 0.0, std::numeric_limits<double>::quiet_NaN()}, 0.01, 0.001, 0.1);
  EXPECT_TRUE(study.empty());
  study.add({0.0, 0.0, 1.0}, 0.01, 0.001, 0.1);
  EXPECT_FALSE(study.empty());
}

/// Lengths that are too short as well as too long, and such as are neither.
// Verifies: REQ-062
TEST(ReferenceStudyEdge, AShortLengthIsACommonScaleToo) {
  plumb_test::Noise noise(7);
  const auto found = [&noise](double off_mps2) {
    ReferenceStudy study;
    for (int k = 0; k < 100; ++k) study.add(plumb_test::random_direction(noise), off_mps2, 1e-3, 0.2);
    return study.find(kG0_mps2, 1e-3, rad_from_deg(2.0)).kind;
  };
  EXPECT_EQ(found(0.05), ReferenceKind::common_scale);
  EXPECT_EQ(found(-0.05), ReferenceKind::common_scale);
  EXPECT_EQ(found(0.0), ReferenceKind::undecided);
}

// Serves: REQ-131
TEST(RawBlockEdge, OfNoSamplesThereIsNoMean) {
  const RawBlock none;
  const StationMean mean = none.mean(SensorSet::first(4), {0.0, 0.0, 1.0}, 32.0);
  EXPECT_EQ(mean.raw[0], 0.0);
  EXPECT_TRUE(none.holds());
  RawBlock block;
  std::array<double, kCapacity> raw{};
  raw.fill(2.0);
  block.add(raw, SensorSet(~std::uint32_t{0}), 20.0);
  EXPECT_TRUE(block.holds());
  EXPECT_EQ(block.mean(SensorSet::first(4), {0.0, 0.0, 1.0}, 32.0).raw[3], 2.0);
}

/// Coefficients that a laboratory hands in for some of the sensors: the others keep theirs, and their uncertainty.
// Verifies: REQ-135
TEST(OfferEdge, OnlyTheSensorsThatItIsForAreTaken) {
  Shadow shadow(6, 11);
  shadow.drift(1e-3, 1e-5);
  shadow.used = shadow.array.all().without(4);
  SensorModel model = shadow.model;
  for (int i = 0; i < 6; ++i) {
    model.sensor[static_cast<std::size_t>(i)].bias[0] = shadow.bias_at(i);
    model.sensor[static_cast<std::size_t>(i)].scale[0] = shadow.scale_at(i);
  }
  SensorArray array = shadow.array;
  plumb_test::leave_uncertainty(array, 3e-4, 3e-5);
  const Recalibration::InForce in_force = {shadow.model, shadow.array, shadow.gravity, shadow.limits};
  ASSERT_TRUE(shadow.fit->offer(in_force, model, array, shadow.used, 0.0).has_value());
  shadow.start();
  shadow.fit->withdraw_offer();  // on trial: too late
  EXPECT_TRUE(shadow.fit->offered());
  ASSERT_EQ(shadow.roam(40), Recalibration::Outcome::accepted);
  EXPECT_EQ(shadow.step(0.0), Recalibration::Outcome::accepted) << "as long as nobody takes it over";
  SensorModel taken = shadow.model;
  SensorArray into = shadow.array;
  shadow.fit->apply(taken, into, shadow.gravity, 0.0, false);
  EXPECT_EQ(taken.sensor[4].bias, shadow.model.sensor[4].bias);
  EXPECT_NEAR(taken.sensor[0].bias[0], shadow.bias_at(0), 1e-12);
  const auto variance_of = [](const SensorArray& a, int p) {
    return a.uncertainty().covariance[static_cast<std::size_t>(p * (p + 1) / 2 + p)];
  };
  for (int p = 16; p < 20; ++p) EXPECT_EQ(variance_of(into, p), variance_of(shadow.array, p)) << p;
  EXPECT_TRUE(into.uncertainty().is_covariance());
  // And once more: there is nothing left to take.
  SensorModel again = taken;
  shadow.fit->apply(again, into, shadow.gravity, 0.0, false);
  EXPECT_TRUE(plumb_test::same_model(again, taken));
}

/// Taken back before it was tried: nothing is left of it but the word.
// Verifies: REQ-135
TEST(OfferEdge, OneThatIsTakenBackInTimeIsGone) {
  Shadow shadow(4, 14);
  const Recalibration::InForce in_force = {shadow.model, shadow.array, shadow.gravity, shadow.limits};
  shadow.fit->withdraw_offer();
  EXPECT_EQ(shadow.step(0.0), Recalibration::Outcome::none) << "there was none";
  ASSERT_TRUE(shadow.fit->offer(in_force, shadow.model, shadow.array, shadow.used, 0.0).has_value());
  shadow.fit->withdraw_offer();
  EXPECT_FALSE(shadow.fit->offered());
  EXPECT_EQ(shadow.step(0.0), Recalibration::Outcome::rejected);
}

// Negative: REQ-135
TEST(OfferEdge, OfAnotherArrayItIsRefused) {
  Shadow shadow(5, 12), other(6, 12);
  const Recalibration::InForce in_force = {shadow.model, shadow.array, shadow.gravity, shadow.limits};
  const auto code_of = [&](const SensorModel& model, const SensorArray& array) {
    const Expected<void> taken = shadow.fit->offer(in_force, model, array, shadow.array.all(), 0.0);
    return taken ? Errc::ok : taken.error().code;
  };
  EXPECT_EQ(code_of(other.model, other.array), Errc::not_calibrated);
  EXPECT_EQ(code_of(shadow.model, other.array), Errc::not_calibrated);
  EXPECT_EQ(code_of(shadow.model, shadow.array), Errc::ok);
}

/// Stations that move gravity along too few axes: asked once for each, and the trial ends with its time, whichever way
/// the clock goes.
// Negative: REQ-135
TEST(OfferEdge, StationsAlikeTryNothingAndTheTrialEnds) {
  for (const double later_s : {2.0 * Recalibration::kOfferLife_s, -1.0}) {
    Shadow shadow(4, 13);
    const Recalibration::InForce in_force = {shadow.model, shadow.array, shadow.gravity, shadow.limits};
    SensorArray array = shadow.array;
    plumb_test::leave_uncertainty(array, 3e-4, 3e-5);
    ASSERT_TRUE(shadow.fit->offer(in_force, shadow.model, array, shadow.used, 0.0).has_value());
    EXPECT_EQ(shadow.step(0.0), Recalibration::Outcome::none) << "nothing has been started";
    shadow.start();
    for (int k = 0; k < 30; ++k) {
      ASSERT_EQ(shadow.visit(direction_at(10.0, 12.0 * k), 1.0), Recalibration::Outcome::none) << k;
    }
    EXPECT_EQ(shadow.step(later_s), Recalibration::Outcome::rejected);
    EXPECT_FALSE(shadow.fit->offered());
    EXPECT_EQ(shadow.step(later_s), Recalibration::Outcome::rejected) << "as long as nobody has heard it";
  }
}

}  // namespace
}  // namespace health_edges_test
