// A calibration that was offered, tried by hand: what is taken of it, and when its trial ends.
#include <gtest/gtest.h>

#include <cmath>

#include "recalibration_support.hpp"

// Serves: REQ-135

namespace offer_trial_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Shadow;
using Outcome = Recalibration::Outcome;

/// Coefficients that a laboratory hands in for some of the sensors: the others keep theirs, and their uncertainty.
// Verifies: REQ-135
TEST(OfferTrial, OnlyTheSensorsThatItIsForAreTaken) {
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
  ASSERT_EQ(shadow.roam(40), Outcome::accepted);
  EXPECT_EQ(shadow.step(0.0), Outcome::accepted) << "as long as nobody takes it over";
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
TEST(OfferTrial, OneThatIsTakenBackInTimeIsGone) {
  Shadow shadow(4, 14);
  const Recalibration::InForce in_force = {shadow.model, shadow.array, shadow.gravity, shadow.limits};
  shadow.fit->withdraw_offer();
  EXPECT_EQ(shadow.step(0.0), Outcome::none) << "there was none";
  ASSERT_TRUE(shadow.fit->offer(in_force, shadow.model, shadow.array, shadow.used, 0.0).has_value());
  shadow.fit->withdraw_offer();
  EXPECT_FALSE(shadow.fit->offered());
  EXPECT_EQ(shadow.step(0.0), Outcome::rejected);
}

// Negative: REQ-135
TEST(OfferTrial, OneOfAnotherArrayIsRefused) {
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
TEST(OfferTrial, StationsAlikeTryNothingAndItsTimeRunsOut) {
  for (const double later_s : {2.0 * OfferedCalibration::kLife_s, -1.0}) {
    Shadow shadow(4, 13);
    const Recalibration::InForce in_force = {shadow.model, shadow.array, shadow.gravity, shadow.limits};
    SensorArray array = shadow.array;
    plumb_test::leave_uncertainty(array, 3e-4, 3e-5);
    ASSERT_TRUE(shadow.fit->offer(in_force, shadow.model, array, shadow.used, 0.0).has_value());
    EXPECT_EQ(shadow.step(0.0), Outcome::none) << "nothing has been started";
    shadow.start();
    for (int k = 0; k < 30; ++k) {
      ASSERT_EQ(shadow.visit(direction_at(10.0, 12.0 * k), 1.0), Outcome::none) << k;
    }
    EXPECT_EQ(shadow.step(later_s), Outcome::rejected);
    EXPECT_FALSE(shadow.fit->offered());
    EXPECT_EQ(shadow.step(later_s), Outcome::rejected) << "as long as nobody has heard it";
  }
}

/// A commissioning calibration that is no number has no bound within which anything could lie.
TEST(OfferTrial, NothingIsWithinABoundOfWhatIsNoNumber) {
  Shadow s(5, 22);
  SensorModel none = s.model;
  none.sensor[1].scale[0] = std::nan("");
  s.fit->configure(none, alike(s.drift_sigmas), rad_from_deg(2.0));
  const auto made = s.fit->offer({s.model, s.array, s.gravity, s.limits}, s.model, s.array, s.array.all(), 0.0);
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, Errc::implausible);
  EXPECT_EQ(made.error().index, 1);
  EXPECT_TRUE(std::isnan(made.error().value));
}

/// Of axes that determine no vector nothing is unseen by parity: the whole change is in doubt.
TEST(OfferTrial, OverSensorsWithoutAVectorTheWholeChangeIsInDoubt) {
  Shadow s(4, 29);
  SensorModel model = s.model;
  model.sensor[0].bias[0] += 0.5 * s.drift_sigmas.bias_mps2;
  const Recalibration::InForce in_force = {s.model, s.array, s.gravity, s.limits};
  ASSERT_TRUE(s.fit->offer(in_force, model, s.array, s.array.all(), 0.0).has_value());
  s.start();
  s.drifted_bias[0] = 0.5 * s.drift_sigmas.bias_mps2;
  ASSERT_EQ(s.roam(24), Outcome::accepted) << describe(s.fit->progress(s.array).last_refusal.code);
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

}  // namespace
}  // namespace offer_trial_test
