// Edges of recalibration: a state that was read back or damaged, a calibration in force that is none, and what a first
// calibration refuses by its own figures.
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "health/first_calibration_support.hpp"
#include "health/recalibration_support.hpp"
#include "support/member.hpp"

// Serves: REQ-135

namespace recalibration_edges_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::member;
using plumb_test::random_direction;
using plumb_test::Shadow;
using plumb_test::UncalibratedTool;
using Outcome = Recalibration::Outcome;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

StationStore& store_of(Recalibration& r) { return member<0, StationStore>(r); }
std::array<StationMean, StationStore::kMax>& stations_of(Recalibration& r) {
  return member<3, std::array<StationMean, StationStore::kMax>>(store_of(r));
}
DriftSigmas& drift_of(Recalibration& r) { return member<1, DriftSigmas>(r); }
double& inflation_of(Recalibration& r) { return member<6, double>(r); }
bool& adopted_by(Recalibration& r) { return member<8, bool>(r); }
RecalibrationPhase& phase_of(Recalibration& r) { return member<11, RecalibrationPhase>(r); }
int& offered_sensors_of(Recalibration& r) { return member<16, int>(r); }

SensorArray with_misfit(SensorArray array, double misfit_mps2) {
  RowUncertainty u = array.uncertainty();
  u.misfit_mps2[0] = misfit_mps2;
  array.set_uncertainty(u);
  return array;
}

/// In the middle of a fit, which the first step begins.
std::unique_ptr<Shadow> fitting(int n, std::uint64_t seed) {
  auto s = std::make_unique<Shadow>(n, seed);
  s->start();
  for (int k = 0; k < 16; ++k) s->offer(random_direction(s->noise));
  EXPECT_EQ(s->step(0.0), Outcome::none);
  EXPECT_EQ(s->fit->progress(s->array).phase, RecalibrationPhase::fitting);
  return s;
}

Outcome finish(Shadow& s) {
  Outcome outcome = Outcome::none;
  for (int k = 0; k < 60 && outcome == Outcome::none; ++k) outcome = s.step(0.0);
  return outcome;
}

Error refusal_of(const Shadow& s) { return s.fit->progress(s.array).last_refusal; }

/// As many stations as asked for, of which the last is not entered.
void refill(Shadow& s, int stations, double spread_deg) {
  Shadow other(s.array.size(), 77);
  other.start();
  for (int k = 0; k < stations + 2; ++k) other.offer(direction_at(spread_deg * k, 77.0 * k));
  store_of(*s.fit) = other.fit->store();
  ASSERT_EQ(s.fit->store().size(), stations);
}

// Negative: REQ-163
TEST(RecalibrationEdge, WhatNoBoundHasLetPassIsNotTakenUp) {
  Shadow s(5, 21);
  s.drift(5e-4 * kG0_mps2, 1e-4);
  s.start();
  ASSERT_EQ(s.roam(24), Outcome::accepted);
  const auto taken = [&s](const auto& damage) {
    Recalibration twin = *s.fit;
    SensorModel model = s.model;
    damage(twin, model);
    return twin.resume({model, s.array, s.gravity, s.limits});
  };
  EXPECT_TRUE(taken([](Recalibration&, SensorModel&) {}));
  EXPECT_FALSE(taken([](Recalibration& r, SensorModel&) { inflation_of(r) = kNan; }));
  EXPECT_FALSE(taken([](Recalibration& r, SensorModel&) { inflation_of(r) = 0.5; }));
  EXPECT_FALSE(taken([&s](Recalibration&, SensorModel& m) { m.sensor[2].bias[0] += 6.0 * s.drift_sigmas.bias_mps2; }));
  EXPECT_FALSE(taken([&s](Recalibration&, SensorModel& m) { m.sensor[2].scale[0] += 6.0 * s.drift_sigmas.scale; }));
  EXPECT_FALSE(taken([](Recalibration& r, SensorModel&) { offered_sensors_of(r) = 4; })) << "of another array";
}

// Negative: REQ-163
TEST(RecalibrationEdge, AnOfferIsNotTakenUpInTheMiddleOfAFit) {
  Shadow s(5, 22);
  SensorArray offered = s.array;
  ASSERT_TRUE(s.fit->offer({s.model, s.array, s.gravity, s.limits}, s.model, offered, s.array.all(), 0.0).has_value());
  EXPECT_TRUE(s.fit->resume({s.model, s.array, s.gravity, s.limits}));
  phase_of(*s.fit) = RecalibrationPhase::fitting;
  EXPECT_FALSE(s.fit->resume({s.model, s.array, s.gravity, s.limits}));
}

TEST(RecalibrationEdge, NothingIsWithinABoundOfWhatIsNoNumber) {
  Shadow s(5, 22);
  member<2, std::array<double, kCapacity>>(*s.fit)[1] = kNan;
  const SensorArray offered = s.array;
  const auto made = s.fit->offer({s.model, s.array, s.gravity, s.limits}, s.model, offered, s.array.all(), 0.0);
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, Errc::implausible);
  EXPECT_EQ(made.error().index, 1);
  EXPECT_NE(made.error().value, made.error().value);
}

// Negative: REQ-163
TEST(RecalibrationEdge, WithoutACalibrationThereIsNoOfferAndNoFitInFlight) {
  UncalibratedTool tool(4, 3);
  TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  Recalibration r;
  r.configure(tool.setup.model, {}, rad_from_deg(2.0), true);
  const Recalibration::InForce in_force = {tool.setup.model, tool.setup.array, tool.setup.gravity, limits};
  EXPECT_TRUE(r.resume(in_force));
  adopted_by(r) = true;
  EXPECT_FALSE(r.resume(in_force));
  adopted_by(r) = false;
  offered_sensors_of(r) = 4;
  EXPECT_FALSE(r.resume(in_force));
}

// Negative: REQ-131
TEST(RecalibrationEdge, StationsThatTellTooLittleRefuseTheFit) {
  auto few = fitting(5, 23);
  refill(*few, 7, 50.0);
  EXPECT_EQ(finish(*few), Outcome::rejected);
  EXPECT_EQ(refusal_of(*few).code, Errc::too_few_stations) << describe(refusal_of(*few).code);
  EXPECT_EQ(refusal_of(*few).value, 1.0);
  EXPECT_EQ(refusal_of(*few).limit, 1.0 * Recalibration::kHeldOutNeeded);
  auto exact = fitting(3, 24);
  refill(*exact, 8, 40.0);  // six of them in the fit, for six parameters: nothing is left over
  finish(*exact);
  EXPECT_EQ(inflation_of(*exact->fit), 1.0);
  auto alike = fitting(5, 25);
  for (StationMean& station : stations_of(*alike->fit)) station = alike->fit->store().station(0);
  EXPECT_EQ(finish(*alike), Outcome::rejected);
  EXPECT_EQ(refusal_of(*alike).code, Errc::unobservable) << describe(refusal_of(*alike).code);
  EXPECT_LT(refusal_of(*alike).value, refusal_of(*alike).limit);
}

/// A calibration of which nothing is known in numbers: no fit is begun over it, none is accepted, and what had been
/// accepted is adopted without a word about it.
// Negative: REQ-131
TEST(RecalibrationEdge, AnUncertaintyThatIsNoNumberAcceptsNothing) {
  Shadow s(5, 26);
  s.start();
  for (int k = 0; k < 16; ++k) s.offer(random_direction(s.noise));
  const SensorArray broken = with_misfit(s.array, kNan);
  EXPECT_EQ(s.fit->step({s.model, broken, s.gravity, s.limits}, 0.0), Outcome::none);
  EXPECT_EQ(s.fit->progress(s.array).phase, RecalibrationPhase::collecting);
  s.offer(random_direction(s.noise));
  stations_of(*s.fit)[0].direction = {1e153, 1e153, 1e153};
  EXPECT_EQ(s.step(0.0), Outcome::none);
  EXPECT_EQ(s.fit->progress(s.array).phase, RecalibrationPhase::collecting);

  auto begun = fitting(5, 27);
  begun->array = with_misfit(begun->array, kNan);
  EXPECT_EQ(finish(*begun), Outcome::rejected);
  auto damaged = fitting(5, 27);
  stations_of(*damaged->fit)[0].direction = {1e153, 1e153, 1e153};
  EXPECT_EQ(finish(*damaged), Outcome::rejected);
  EXPECT_EQ(refusal_of(*damaged).code, Errc::diverged) << describe(refusal_of(*damaged).code);

  auto done = fitting(5, 28);
  ASSERT_EQ(finish(*done), Outcome::accepted);
  const Recalibration accepted = *done->fit;
  for (const bool doubted : {false, true}) {
    Recalibration r = accepted;
    drift_of(r).scale = kNan;
    SensorModel model = done->model;
    SensorArray array = done->array;
    r.apply(model, array, done->gravity, 0.0, doubted);
    EXPECT_TRUE(r.adopted());
    EXPECT_NE(model.sensor[1].bias[0], done->model.sensor[1].bias[0]);
    const double before = done->array.uncertainty().covariance[9], after = array.uncertainty().covariance[9];
    EXPECT_EQ(after > before, doubted) << "the old uncertainty, and the whole change on top where it is in doubt";
  }
}

/// Of axes that determine no vector nothing is unseen by parity: the whole change is in doubt.
TEST(RecalibrationEdge, AnOfferOverSensorsWithoutAVectorIsDoubtedWhole) {
  Shadow s(4, 29);
  SensorModel model = s.model;
  model.sensor[0].bias[0] += 0.5 * s.drift_sigmas.bias_mps2;
  const Recalibration::InForce in_force = {s.model, s.array, s.gravity, s.limits};
  ASSERT_TRUE(s.fit->offer(in_force, model, s.array, s.array.all(), 0.0).has_value());
  s.start();
  s.drifted_bias[0] = 0.5 * s.drift_sigmas.bias_mps2;
  ASSERT_EQ(s.roam(24), Outcome::accepted) << describe(refusal_of(s).code);
  std::array<SensorRow, 4> loud{};
  for (int i = 0; i < 4; ++i) {
    loud[static_cast<std::size_t>(i)] = s.array.row(i);
    loud[static_cast<std::size_t>(i)].sigma_mps2 = 1e200;
  }
  SensorArray no_vector = s.array;
  ASSERT_TRUE(no_vector.set_rows(loud.data()).has_value());
  double left[2] = {};
  for (const bool sees : {false, true}) {
    Recalibration r = *s.fit;
    SensorModel applied = s.model;
    SensorArray array = sees ? s.array : no_vector;
    r.apply(applied, array, s.gravity, 0.0, false);
    left[sees ? 1 : 0] = array.uncertainty().covariance[9];
  }
  const double change = 0.5 * s.drift_sigmas.bias_mps2;
  EXPECT_GT(left[0], change * change);
  EXPECT_LT(left[1], left[0]);
}

// Negative: REQ-137
TEST(FirstCalibrationEdge, AParameterThatThePriorSettlesIsNotCalibrated) {
  UncalibratedTool tool(5, 51, 0.0);
  tool.sheet.sensor[2].prior.bias_mps2 = 3e-5;
  ASSERT_TRUE(set_datasheet(tool.sheet, tool.setup).has_value());
  tool.start();
  const RecalibrationProgress& p = tool.monitor.verdict().recalibration;
  Vec3 u{};
  for (int k = 0; k < 24 * 32 && p.last_refusal.code == Errc::ok; ++k) {
    if (k % 32 == 0) u = norm(p.wanted_direction) > 0.5 ? p.wanted_direction : random_direction(tool.noise);
    tool.step(tool.sample(u));
  }
  EXPECT_FALSE(tool.calibrated());
  EXPECT_EQ(p.last_refusal.code, Errc::unobservable) << describe(p.last_refusal.code);
  EXPECT_EQ(p.last_refusal.index, 2);
  EXPECT_LT(p.last_refusal.value, p.last_refusal.limit);
  EXPECT_TRUE(p.lacking.has(2));
}

// Negative: REQ-137
TEST(FirstCalibrationEdge, AScaleBeyondTheDatasheetIsRefused) {
  UncalibratedTool tool(6, 52, 0.0);
  tool.truth(1).w = scaled(tool.truth(1).w, 1.0 + 7.0 * tool.sheet.sensor[1].prior.scale);
  tool.start();
  Error refusal;
  for (int k = 0; k < 40 && refusal.code == Errc::ok; ++k) {
    tool.follow(1);
    refusal = tool.monitor.verdict().recalibration.last_refusal;
  }
  EXPECT_FALSE(tool.calibrated());
  EXPECT_EQ(refusal.code, Errc::implausible) << describe(refusal.code);
  EXPECT_EQ(refusal.index, 1);
  EXPECT_EQ(refusal.limit, Recalibration::kFirstSigmas);
}

/// A sensor that has fallen silent is asked for nothing, and a sensor behind it keeps its own place.
// Negative: REQ-137
TEST(FirstCalibrationEdge, AttitudesInOnePlaneAskNothingOfASilentSensor) {
  UncalibratedTool tool(6, 53);
  tool.start();
  tool.silent = SensorSet::of(1);
  for (int k = 0; k < 40; ++k) tool.stay(direction_at(90, 6.0 * k + 0.3 * tool.noise.normal()));
  EXPECT_FALSE(tool.calibrated());
  const RecalibrationProgress& p = tool.monitor.verdict().recalibration;
  EXPECT_FALSE(p.lacking.empty());
  EXPECT_FALSE(p.lacking.has(1));
}

/// "No more faults" is said of a calibrated tool: by a datasheet nothing refutes it.
// Negative: REQ-136
TEST(FirstCalibrationEdge, AnAlarmByTheDatasheetRefutesNoAssertion) {
  MonitorConfig config;
  config.asserted_faults = 0;
  UncalibratedTool tool(5, 37, 1.0, config);
  tool.start();
  for (int k = 0; k < 10; ++k) tool.stay(random_direction(tool.noise));
  tool.distort = [](int i, double r, int) { return i == 3 ? r + 5.0 : r; };
  tool.stay(direction_at(50, 50));
  EXPECT_EQ(tool.monitor.mode(), Mode::initial);
  EXPECT_EQ(tool.monitor.verdict().cause, Cause::parity);
  tool.distort = [](int, double r, int) { return r; };
  EXPECT_LT(tool.follow(60), 60);
  EXPECT_EQ(tool.count(HealthEvent::contradiction), 0);
}

/// By hand, with the truth of the datasheet.
struct FirstByHand {
  explicit FirstByHand(std::uint64_t seed) : tool(4, seed, 0.0), noise(seed) {
    limits = TestLimits::from_rates(4, 1e-5, 1e-6);
    r->configure(tool.setup.model, {}, rad_from_deg(2.0), true);
    r->start(SensorSet::first(4));
    for (int k = 0; k < 22; ++k) {
      StationMean mean;
      mean.direction = random_direction(noise);
      mean.samples = 32.0;
      mean.temperature_degc = 25.0;
      for (int i = 0; i < 4; ++i) {
        const double felt = dot(tool.truth(i).w, mean.direction) * kG0_mps2 + 3e-4 * noise.normal();
        mean.raw[static_cast<std::size_t>(i)] = 0.3 * felt;
      }
      r->add_block(mean, true);
    }
  }
  Outcome step(const SensorModel& model) { return r->step({model, tool.setup.array, tool.setup.gravity, limits}, 0.0); }
  Outcome finish(const SensorModel& model) {
    Outcome outcome = Outcome::none;
    for (int k = 0; k < 80 && outcome == Outcome::none; ++k) outcome = step(model);
    return outcome;
  }
  Error refusal() const { return r->progress(tool.setup.array).last_refusal; }

  UncalibratedTool tool;
  plumb_test::Noise noise;
  TestLimits limits;
  std::unique_ptr<Recalibration> r = std::make_unique<Recalibration>();
};

/// A scale of the model in force that memory has damaged: there are no rows with such a fit, so nothing is accepted and
/// nothing adopted.
// Negative: REQ-136
TEST(FirstCalibrationEdge, AFitThatMakesNoArrayIsNeitherAcceptedNorAdopted) {
  FirstByHand late(54);
  ASSERT_EQ(late.finish(late.tool.setup.model), Outcome::accepted) << describe(late.refusal().code);
  SensorModel damaged = late.tool.setup.model;
  damaged.sensor[1].scale[0] = 1e-306;

  FirstByHand early(54);
  ASSERT_EQ(early.step(early.tool.setup.model), Outcome::none);
  EXPECT_EQ(early.finish(damaged), Outcome::rejected);
  EXPECT_EQ(early.refusal().code, Errc::diverged) << describe(early.refusal().code);

  SensorArray array = late.tool.setup.array;
  SensorModel model = damaged;
  late.r->apply(model, array, late.tool.setup.gravity, 0.0, false);
  EXPECT_TRUE(late.r->first()) << "there is still none";
  EXPECT_TRUE(plumb_test::same_model(model, damaged));
  EXPECT_EQ(array.axis(1), late.tool.setup.array.axis(1));
}

// Negative: REQ-136
TEST(FirstCalibrationEdge, AFitWhoseStationsAreGoneIsNeitherAcceptedNorAdopted) {
  FirstByHand early(55);
  ASSERT_EQ(early.step(early.tool.setup.model), Outcome::none);
  ASSERT_EQ(early.r->progress(early.tool.setup.array).phase, RecalibrationPhase::fitting);
  store_of(*early.r).clear();
  EXPECT_EQ(early.finish(early.tool.setup.model), Outcome::rejected);
  EXPECT_EQ(early.refusal().code, Errc::too_few_stations) << describe(early.refusal().code);
  EXPECT_EQ(early.r->progress(early.tool.setup.array).lacking, SensorSet::first(4));

  FirstByHand late(55);
  ASSERT_EQ(late.finish(late.tool.setup.model), Outcome::accepted);
  store_of(*late.r).clear();
  SensorModel model = late.tool.setup.model;
  SensorArray array = late.tool.setup.array;
  late.r->apply(model, array, late.tool.setup.gravity, 0.0, false);
  EXPECT_TRUE(late.r->first());
  EXPECT_TRUE(plumb_test::same_model(model, late.tool.setup.model));
}

/// A calibration may leave open more than gravity: then sensors that all read zero are within every limit, and still
/// say no attitude that a fit could be made from.
// Negative: REQ-163
TEST(RecalibrationEdge, ZerosAreNoStationHoweverLooseTheCalibration) {
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
}  // namespace recalibration_edges_test
