// A monitor that was given no calibration makes its own: what it asks for, what it publishes until then, what starts
// the collection anew, what it adopts.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "first_calibration_support.hpp"

// Serves: REQ-136

namespace first_calibration_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::random_direction;
using plumb_test::UncalibratedTool;

// Verifies: REQ-136
TEST(FirstCalibration, PowersOnInRecalibratingAndAsksForStations) {
  UncalibratedTool tool(4);
  tool.start();
  const Verdict& v = tool.monitor.verdict();
  EXPECT_EQ(v.state, HealthState::recalibrating);
  EXPECT_EQ(tool.monitor.mode(), Mode::initial);
  EXPECT_NE(v.qualifiers & Qualifier::initial_calibration, 0);
  EXPECT_EQ(v.validity, Validity::invalid);
  EXPECT_EQ(v.recalibration.phase, RecalibrationPhase::collecting);
  EXPECT_EQ(v.recalibration.stations_wanted, Recalibration::first_stations_needed(4));
  EXPECT_NEAR(norm(v.recalibration.wanted_direction), 1.0, 1e-12);
  EXPECT_TRUE(v.wants_rotation);
  EXPECT_TRUE(tool.monitor.calibrated().empty());
}

/// Where it asks to be taken is enough, for every number of sensors, and what it then says is right.
// Verifies: REQ-136
TEST(FirstCalibration, WhereItAsksToBeTakenIsEnough) {
  for (int n = 3; n <= kCapacity; ++n) {
    UncalibratedTool tool(n, static_cast<std::uint64_t>(n));
    tool.start();
    const int stations = tool.follow(40);
    ASSERT_TRUE(tool.calibrated()) << n << " " << describe(tool.monitor.verdict().recalibration.last_refusal.code);
    EXPECT_LE(stations, Recalibration::first_stations_needed(n) + 4) << n;
    EXPECT_FALSE(tool.usable_too_early);
    EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 1);
    const TransitionRecord& record = tool.records.back();
    EXPECT_EQ(record.from, HealthState::recalibrating);
    EXPECT_EQ(record.to, HealthState::suspect);
    EXPECT_EQ(record.cause, Cause::calibration);
    EXPECT_EQ(record.sensors, SensorSet::first(n));
    EXPECT_NE(tool.monitor.verdict().qualifiers & Qualifier::not_yet_validated, 0);
    EXPECT_EQ(tool.monitor.verdict().qualifiers & Qualifier::initial_calibration, 0);
    EXPECT_EQ(tool.monitor.verdict().validity, Validity::invalid) << "no block through the new coefficients yet";
    EXPECT_EQ(tool.monitor.calibrated(), SensorSet::first(n));
    tool.wander(8);
    EXPECT_EQ(tool.state(), n > 3 ? HealthState::nominal : HealthState::degraded_3_sensor) << n;
    const Vec3 u = direction_at(35, 120);
    const Verdict& v = tool.stay(u, 2);
    EXPECT_EQ(v.validity, n > 3 ? Validity::valid : Validity::unconfirmed) << "nobody has checked a fit of three";
    EXPECT_LT(angle_between_rad(v.gravity_mps2, tool.in_calibrated_frame(u)),
              n > 3 ? v.protection_level_calibrated_axes_rad : 1e-3);
    EXPECT_EQ(v.protection_level_calibrated_axes_rad<rad_from_deg(0.2), n> 3)
        << n << ": one of three at fault shows another vector";
  }
}

/// No common turn of the axes: the frame stays the datasheet's, so that nothing jumps.
// Verifies: REQ-136
TEST(FirstCalibration, TheAxesAreTurnedOntoThoseOfTheDatasheet) {
  UncalibratedTool tool(6, 4);
  tool.start();
  tool.follow(40);
  ASSERT_TRUE(tool.calibrated());
  Vec3 turn{};
  for (int i = 0; i < 6; ++i)
    turn = plus(turn, cross(tool.sheet.sensor[static_cast<std::size_t>(i)].row.axis, tool.monitor.array().axis(i)));
  EXPECT_LT(norm(turn) / 6.0, 1e-9);
}

/// S19 at every sample, with a tool that never says anything but "not yet".
// Negative: REQ-136
TEST(FirstCalibration, NothingIsUsableBefore) {
  UncalibratedTool tool(5, 9);
  tool.start();
  for (int k = 0; k < 12; ++k) tool.stay(random_direction(tool.noise), 3);
  EXPECT_FALSE(tool.calibrated());
  EXPECT_FALSE(tool.usable_too_early);
  EXPECT_EQ(tool.monitor.verdict().usable & (Usable::vector | Usable::calibration), 0);
  EXPECT_FALSE(tool.monitor.request_recalibration().has_value()) << "that is for a monitor with a calibration";
  EXPECT_FALSE(tool.monitor.offer_calibration(tool.setup.model, tool.setup.array).has_value());
  EXPECT_TRUE(tool.records.empty());
}

/// Attitudes in one plane (a drill string rolled at one inclination, or swung about one axis) leave directions open.
// Negative: REQ-137
TEST(FirstCalibration, AttitudesInOnePlaneAreRefused) {
  for (int n : {3, 4, 6}) {
    UncalibratedTool tool(n, static_cast<std::uint64_t>(20 + n));
    tool.start();
    for (int k = 0; k < 60; ++k) tool.stay(direction_at(90, 6.0 * k + 0.3 * tool.noise.normal()));
    EXPECT_FALSE(tool.calibrated()) << n;
    EXPECT_EQ(tool.state(), HealthState::recalibrating);
    const RecalibrationProgress& p = tool.monitor.verdict().recalibration;
    EXPECT_FALSE(p.lacking.empty());
    EXPECT_GE(p.stations_wanted, 1);
    EXPECT_GT(std::fabs(p.wanted_direction[2]), 0.5) << "out of the plane";
    EXPECT_EQ(tool.monitor.verdict().validity, Validity::invalid);
    EXPECT_LT(tool.follow(20), 20) << "and it is enough";
  }
}

// Negative: REQ-137
TEST(FirstCalibration, ASensorThatDriftsIsNotCalibrated) {
  UncalibratedTool tool(5, 31);
  // A milli-g an hour would do; here over the minutes of the test.
  tool.distort = [](int i, double r, int k) { return i == 2 ? r + 2e-5 * k : r; };
  tool.start();
  tool.roam(80);
  EXPECT_FALSE(tool.calibrated());
  EXPECT_EQ(tool.state(), HealthState::recalibrating);
  EXPECT_NE(tool.monitor.verdict().recalibration.last_refusal.code, Errc::ok) << "and says why";
}

// Negative: REQ-137
TEST(FirstCalibration, ASensorThatJumpsIsNotCalibratedOverTheJump) {
  for (int at = 4; at < 17; at += 4) {
    UncalibratedTool tool(5, 32);
    const int onset = at * 32;
    tool.distort = [onset](int i, double r, int k) { return i == 2 && k > onset ? r + 0.02 : r; };
    tool.start();
    const int needed = Recalibration::first_stations_needed(5);
    tool.follow(needed + 6);
    EXPECT_FALSE(tool.calibrated()) << at;
    EXPECT_TRUE(tool.monitor.verdict().recalibration.last_refusal.code == Errc::poor_fit ||
                tool.monitor.verdict().recalibration.last_refusal.code == Errc::not_confirmed);
    tool.follow(needed + 8);  // at rest since: what is constant is calibrated away
    EXPECT_TRUE(tool.calibrated()) << at;
  }
}

/// What it cannot see, and says so: a constant error is what a calibration takes off.
// Verifies: REQ-137
TEST(FirstCalibration, AConstantBiasIsCalibratedAway) {
  UncalibratedTool tool(4, 33);
  tool.truth(1).bias_mps2 += 0.3;
  tool.start();
  tool.follow(40);
  ASSERT_TRUE(tool.calibrated());
  const double scale = tool.monitor.model().sensor[1].scale[0];
  EXPECT_NEAR(tool.monitor.model().sensor[1].bias[0], tool.truth(1).bias_mps2 * 0.3 / scale, 2e-3);
}

/// Beyond what the datasheet allows it is not: five sigmas.
// Negative: REQ-137
TEST(FirstCalibration, WhatTheDatasheetRulesOutIsRefused) {
  UncalibratedTool tool(6, 34);
  tool.truth(1).bias_mps2 = 6.0 * tool.sheet.sensor[1].prior.bias_mps2;
  tool.start();
  tool.roam(60);
  EXPECT_FALSE(tool.calibrated());
  const Errc refusal = tool.monitor.verdict().recalibration.last_refusal.code;
  EXPECT_TRUE(refusal == Errc::implausible || refusal == Errc::ok) << describe(refusal);
}

/// A length of gravity that is wrong by more than the scales may be, all of them together.
// Negative: REQ-137
TEST(FirstCalibration, AWrongLengthOfGravityIsSeenWhereTheScalesTogetherCannotBeSoFarOff) {
  UncalibratedTool tool(8, 35, 0.2);
  tool.g_mps2 = 1.05 * kG0_mps2;
  tool.start();
  tool.roam(60);
  EXPECT_FALSE(tool.calibrated());
  EXPECT_EQ(tool.state(), HealthState::recalibrating);
}

// Negative: REQ-137
TEST(FirstCalibration, NothingIsCollectedWhileTheToolMoves) {
  UncalibratedTool tool(5, 36);
  tool.start();
  for (int k = 0; k < 40 * 32; ++k) tool.step(tool.sample(random_direction(tool.noise)));
  EXPECT_FALSE(tool.calibrated());
  EXPECT_EQ(tool.monitor.recalibration().store().size(), 0);
  tool.roam(60);
  EXPECT_TRUE(tool.calibrated()) << "as soon as it rests";
}

/// An alarm takes everything back: the stations may have been taken under the fault.
// Verifies: REQ-136
TEST(FirstCalibration, AnAlarmStartsTheCollectionAnew) {
  UncalibratedTool tool(5, 37);
  tool.start();
  for (int k = 0; k < 10; ++k) tool.stay(random_direction(tool.noise));
  ASSERT_GE(tool.monitor.recalibration().store().size(), 8);
  tool.distort = [](int i, double r, int) { return i == 3 ? r + 5.0 : r; };
  tool.stay(direction_at(50, 50));
  EXPECT_EQ(tool.monitor.recalibration().store().size(), 0);
  EXPECT_EQ(tool.state(), HealthState::recalibrating);
  EXPECT_EQ(tool.monitor.verdict().cause, Cause::parity);
  EXPECT_TRUE(tool.monitor.verdict().excluded.empty()) << "nobody is suspected by a datasheet";
  tool.roam(60);
  EXPECT_FALSE(tool.calibrated()) << "gross from then on";
  tool.distort = [](int, double r, int) { return r; };
  EXPECT_LT(tool.follow(60), 60);
}

/// The rest goes on without it; what was not calibrated does not come back.
// Verifies: REQ-136
TEST(FirstCalibration, ALostChannelStartsTheCollectionAnewWithoutIt) {
  UncalibratedTool tool(6, 38);
  tool.start();
  for (int k = 0; k < 10; ++k) tool.stay(random_direction(tool.noise));
  tool.silent = SensorSet::of(2);
  tool.stay(direction_at(50, 50));
  EXPECT_EQ(tool.monitor.verdict().absent, SensorSet::of(2));
  EXPECT_EQ(tool.monitor.mode(), Mode::initial);
  EXPECT_LE(tool.monitor.recalibration().store().size(), 1);
  EXPECT_EQ(tool.monitor.recalibration().sensors(), SensorSet::first(6).without(2));
  tool.follow(40);
  ASSERT_TRUE(tool.calibrated());
  EXPECT_EQ(tool.monitor.calibrated(), SensorSet::first(6).without(2));
  tool.silent = SensorSet{};
  for (int k = 0; k < 40; ++k) tool.stay(random_direction(tool.noise), 2);
  EXPECT_EQ(tool.state(), HealthState::isolated);
  EXPECT_FALSE(tool.monitor.verdict().in_service.has(2));
}

/// Fewer than three: failed, and by the key back to where it was, without a calibration.
// Verifies: REQ-136
TEST(FirstCalibration, AResetWithoutACalibrationLeadsBackToIt) {
  UncalibratedTool tool(4, 39);
  tool.start();
  tool.silent = SensorSet::first(2);
  tool.stay(direction_at(50, 50));
  ASSERT_EQ(tool.state(), HealthState::failed);
  EXPECT_EQ(tool.monitor.verdict().usable & Usable::calibration, 0);
  tool.silent = SensorSet{};
  tool.stay(direction_at(50, 50));
  ASSERT_TRUE(tool.monitor.reset(tool.setup.config.reset_key, SensorSet::first(4)).has_value());
  tool.stay(direction_at(50, 50));
  EXPECT_EQ(tool.monitor.mode(), Mode::initial);
  EXPECT_LT(tool.follow(40), 40);
  EXPECT_FALSE(tool.usable_too_early);
}

/// Who was not in service when the monitor calibrated itself does not come back by a reset either.
// Negative: REQ-136
TEST(FirstCalibration, AResetReturnsNoSensorWithoutACalibration) {
  UncalibratedTool tool(6, 40);
  tool.start();
  tool.silent = SensorSet::of(5);
  tool.follow(40);
  ASSERT_TRUE(tool.calibrated());
  tool.silent = SensorSet::first(4);
  tool.stay(direction_at(50, 50));
  ASSERT_EQ(tool.state(), HealthState::failed);
  tool.silent = SensorSet{};
  tool.stay(direction_at(50, 50));
  ASSERT_TRUE(tool.monitor.reset(tool.setup.config.reset_key, SensorSet::first(6)).has_value());
  tool.stay(direction_at(50, 50));
  EXPECT_EQ(tool.monitor.verdict().in_service, SensorSet::first(5));
  EXPECT_EQ(tool.state(), HealthState::suspect);
}

// Verifies: REQ-136
TEST(FirstCalibration, AnInhibitHoldsTheAdoptionBack) {
  UncalibratedTool tool(5, 41);
  tool.start();
  tool.monitor.inhibit(true);
  tool.roam(30);
  EXPECT_FALSE(tool.calibrated());
  EXPECT_EQ(tool.monitor.verdict().recalibration.phase, RecalibrationPhase::accepted);
  tool.monitor.inhibit(false);
  tool.stay(direction_at(50, 50));
  EXPECT_TRUE(tool.calibrated());
}

/// The bounds of later fits are about what was adopted, not about the datasheet.
// Verifies: REQ-136
TEST(FirstCalibration, LaterFitsAreBoundedByWhatWasAdopted) {
  UncalibratedTool tool(6, 42);
  tool.start();
  tool.follow(40);
  ASSERT_TRUE(tool.calibrated());
  tool.wander(8);
  ASSERT_EQ(tool.state(), HealthState::nominal);
  EXPECT_TRUE(tool.monitor.recalibration().bounds().commissioned_as(tool.monitor.model()));
  EXPECT_FALSE(tool.monitor.recalibration().adopted());
  ASSERT_TRUE(tool.monitor.request_recalibration().has_value());
  for (int k = 0; k < 30 && tool.count(HealthEvent::fit_accepted) < 2; ++k) tool.wander(1);
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 2);
  EXPECT_TRUE(tool.monitor.recalibration().adopted());
}

/// Where nobody says over which temperatures the coefficients hold, they hold where the stations were.
// Verifies: REQ-136
TEST(FirstCalibration, TheSpanIsThatOfTheStations) {
  UncalibratedTool tool(6, 43);
  tool.start();
  tool.follow(40);
  tool.wander(8);
  ASSERT_EQ(tool.stay(direction_at(40, 40), 2).validity, Validity::valid);
  tool.temperature_degc = 29.0;
  EXPECT_EQ(tool.stay(direction_at(40, 40), 2).validity, Validity::valid);
  tool.temperature_degc = 31.0;
  EXPECT_EQ(tool.stay(direction_at(40, 40), 2).validity, Validity::unconfirmed);
  EXPECT_EQ(tool.monitor.verdict().cause, Cause::temperature);
}

/// A limit given for a calibrated array, the paper's 0.05 g0, does not lock an uncalibrated one out.
TEST(FirstCalibration, AGivenLimitWaitsForTheCalibration) {
  MonitorConfig config;
  config.delta_f_mps2 = 0.02 * kG0_mps2;
  UncalibratedTool tool(4, 44, 1.0, config);
  tool.start();
  EXPECT_LT(tool.follow(40), 40);
}

// Negative: REQ-136
TEST(FirstCalibration, ASetupWhoseDatasheetLeavesNothingOrTooMuchOpenIsRefused) {
  UncalibratedTool tool(4, 45);
  const auto refusal = [&](const std::function<void(DatasheetSensor&)>& change) {
    Datasheet sheet = tool.sheet;
    change(sheet.sensor[2]);
    MonitorSetup setup = tool.setup;
    EXPECT_TRUE(set_datasheet(sheet, setup).has_value());
    const Expected<void> answer = tool.monitor.configure(setup);
    return answer ? Error{} : answer.error();
  };
  EXPECT_EQ(refusal([](DatasheetSensor&) {}).code, Errc::ok);
  for (const Error& e : {refusal([](DatasheetSensor& s) { s.prior.bias_mps2 = 0.0; }),
                         refusal([](DatasheetSensor& s) { s.prior.scale = 0.0; }),
                         refusal([](DatasheetSensor& s) { s.prior.axis_rad = 0.0; }),
                         refusal([](DatasheetSensor& s) { s.prior.bias_mps2 = 1.1; }),
                         refusal([](DatasheetSensor& s) { s.prior.scale = 0.11; }),
                         refusal([](DatasheetSensor& s) { s.prior.axis_rad = 0.11; })}) {
    EXPECT_EQ(e.code, Errc::implausible);
    EXPECT_EQ(e.index, 2);
  }
}

/// The fit itself is flawless here: only the stations that were kept out of it can contradict it.
// Negative: REQ-137
TEST(FirstCalibration, StationsHeldOutOfTheFitCanRefuseIt) {
  UncalibratedTool tool(5, 34);
  tool.distort = [](int i, double r, int k) { return i == 2 && StationStore::held_out(k / 32) ? r + 0.02 : r; };
  tool.start();
  const auto refusal = [&tool] { return tool.monitor.verdict().recalibration.last_refusal; };
  for (int k = 0; k < Recalibration::first_stations_needed(5) + 4 && refusal().code == Errc::ok; ++k) tool.roam(1);
  EXPECT_FALSE(tool.calibrated());
  EXPECT_EQ(refusal().code, Errc::not_confirmed) << describe(refusal().code);
  EXPECT_TRUE(StationStore::held_out(refusal().index)) << refusal().index;
}

/// A flag alone makes no datasheet: an array without uncertainty is a perfectly known one.
// Negative: REQ-136
TEST(FirstCalibration, AnArrayWithoutUncertaintyIsNoDatasheet) {
  plumb_test::Rig rig(plumb_test::tetrahedron());
  MonitorSetup setup = rig.setup;
  setup.calibrated = false;
  const Expected<void> answer = rig.monitor.configure(setup);
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().code, Errc::implausible);
}

}  // namespace
}  // namespace first_calibration_test
