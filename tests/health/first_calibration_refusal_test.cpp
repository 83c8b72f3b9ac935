// What a first calibration refuses by its own figures, and what refutes it.
#include <gtest/gtest.h>

#include <memory>

#include "first_calibration_support.hpp"
#include "recalibration_support.hpp"

// Serves: REQ-136

namespace first_calibration_refusal_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::random_direction;
using plumb_test::UncalibratedTool;
using Outcome = Recalibration::Outcome;

// Negative: REQ-137
TEST(FirstCalibrationRefusal, AParameterThatThePriorSettlesIsNotCalibrated) {
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
TEST(FirstCalibrationRefusal, AScaleBeyondTheDatasheetIsRefused) {
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
TEST(FirstCalibrationRefusal, AttitudesInOnePlaneAskNothingOfASilentSensor) {
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
TEST(FirstCalibrationRefusal, AnAlarmByTheDatasheetRefutesNoAssumption) {
  MonitorConfig config;
  config.assumed_faults = 0;
  UncalibratedTool tool(5, 37, 1.0, config);
  tool.start();
  for (int k = 0; k < 10; ++k) tool.stay(random_direction(tool.noise));
  tool.distort = [](int i, double r, int) { return i == 3 ? r + 5.0 : r; };
  tool.stay(direction_at(50, 50));
  EXPECT_EQ(tool.monitor.mode(), Mode::initial);
  EXPECT_EQ(tool.monitor.verdict().cause, Cause::parity);
  tool.distort = [](int, double r, int) { return r; };
  EXPECT_LT(tool.follow(60), 60);
  EXPECT_EQ(tool.count(HealthEvent::no_consistent_hypothesis), 0);
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

/// Over a model whose scale all but vanishes: there are no rows with such a fit, so nothing is accepted and
/// nothing adopted.
// Negative: REQ-136
TEST(FirstCalibrationRefusal, AFitThatMakesNoArrayIsNeitherAcceptedNorAdopted) {
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

}  // namespace
}  // namespace first_calibration_refusal_test
