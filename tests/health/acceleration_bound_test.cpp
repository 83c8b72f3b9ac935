// A steady acceleration and gravity are one vector to every accelerometer: the bound that the host states on it is part
// of the limits of the length, of the protection level and of the alert; where none is stated, every verdict says so.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include "plumb/detection/estimate_error.hpp"

#include <cmath>

#include "recalibration_support.hpp"

// Serves: REQ-129

namespace acceleration_bound_test {
namespace {

using namespace plumb;
using plumb_test::cone_array;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::random_direction;
using plumb_test::Rig;
using plumb_test::tetrahedron;
using plumb_test::Tool;

constexpr double kThirtyMg_mps2 = 0.03 * kG0_mps2;

MonitorConfig allowing(double bound_mps2) {
  MonitorConfig config;
  config.acceleration_bound_mps2 = bound_mps2;
  return config;
}

/// A unit vector across `u`, anywhere.
Vec3 across(const Vec3& u, Noise& noise) {
  const Vec3 any = cross(u, random_direction(noise));
  return scaled(any, 1.0 / norm(any));
}

/// Blocks at rest in themselves, of a tool that accelerates steadily by `a` under gravity along `u`.
const Verdict& pushed(Rig& rig, const Vec3& u, const Vec3& a, int blocks = 1) {
  const Vec3 felt = plus(scaled(u, kG0_mps2), a);
  return rig.stay(scaled(felt, 1.0 / norm(felt)), blocks, norm(felt));
}

/// The level of a vector of now is published, whether or not it is within the alert limit.
bool bounded(const Verdict& v) {
  return (v.validity == Validity::valid || v.validity == Validity::unconfirmed) && v.protection_available;
}

struct Attack {
  int bounded = 0, beyond = 0, silent = 0, alarms = 0;
  double worst_rad = 0.0, least_level_rad = kPi, most_level_rad = 0.0;
};

/// Four sensors in a tetrahedron, 1500 tools, 30 mg across gravity. `silent`: valid, no alert, and off by more than the
/// alert limit.
Attack attack(double bound_mps2, double alert_deg) {
  Attack out;
  MonitorConfig config = allowing(bound_mps2);
  config.alert_limit_rad = rad_from_deg(alert_deg);
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    Rig rig(tetrahedron(), config, seed);
    rig.setup.gravity.sigma_mps2 = kDefaultGravitySigma_mps2;
    rig.restart();
    rig.prove();
    Noise noise(seed);
    const Vec3 u = random_direction(noise);
    const Verdict& v = pushed(rig, u, scaled(across(u, noise), kThirtyMg_mps2));
    out.alarms += v.margin < 0.0 ? 1 : 0;
    if (!bounded(v)) continue;
    const double error = angle_between_rad(v.gravity_mps2, u);
    ++out.bounded;
    out.beyond += error > v.protection_level_calibrated_axes_rad ? 1 : 0;
    out.silent += !v.alert && error > config.alert_limit_rad ? 1 : 0;
    out.worst_rad = std::fmax(out.worst_rad, error);
    out.least_level_rad = std::fmin(out.least_level_rad, v.protection_level_calibrated_axes_rad);
    out.most_level_rad = std::fmax(out.most_level_rad, v.protection_level_calibrated_axes_rad);
  }
  std::printf(
      "bound %.0f mg0, alert limit %.1f deg: %d bounded, %d beyond their level of %.4f to %.4f deg, %d silent\n",
      1e3 * g0_from_mps2(bound_mps2), alert_deg, out.bounded, out.beyond, deg_from_rad(out.least_level_rad),
      deg_from_rad(out.most_level_rad), out.silent);
  return out;
}

// Negative: REQ-129
TEST(AccelerationBound, WithoutItThirtyMgTurnTheVectorUnseen) {
  const Attack out = attack(0.0, 1.0);
  EXPECT_GT(out.bounded, 1400) << "nothing shows";
  EXPECT_EQ(out.beyond, out.bounded);
  EXPECT_EQ(out.silent, out.bounded);
  EXPECT_NEAR(out.worst_rad, std::atan(0.03), 2e-3);
  EXPECT_LT(out.most_level_rad, rad_from_deg(0.1));
}

// Verifies: REQ-129
TEST(AccelerationBound, WithItTheLevelCoversThemAndTheAlertIsOn) {
  const Attack tight = attack(kThirtyMg_mps2, 1.0);
  EXPECT_GT(tight.bounded, 1400);
  EXPECT_EQ(tight.beyond, 0);
  EXPECT_EQ(tight.silent, 0);
  EXPECT_GT(tight.least_level_rad, std::asin(0.03));
  const Attack wide = attack(kThirtyMg_mps2, 2.0);
  EXPECT_EQ(wide.beyond, 0);
  EXPECT_LT(wide.most_level_rad, rad_from_deg(2.0)) << "and no wider than it must be: the alert is off again";
}

/// For every steady acceleration within the bound: nobody is blamed, nothing alarms beyond what noise does, and what is
/// valid is within its level.
// Verifies: REQ-129
RC_GTEST_PROP(AccelerationBoundLaw, EverySteadyAccelerationWithinItIsCovered, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Noise noise(seed);
  MonitorConfig config = allowing(std::pow(10.0, -3.0 + 3.0 * noise.uniform()));  // 0.1 mg0 to 0.1 g0
  config.false_alarm_rate = 1e-9;
  config.alarm_form = noise.uniform() < 0.5 ? AlarmForm::every_tool : AlarmForm::average_tool;
  Rig rig(n == 4 ? tetrahedron() : cone_array(n), config, seed);
  rig.prove();
  int told = 0;
  for (int k = 0; k < 8; ++k) {
    const Vec3 u = random_direction(noise);
    const bool all_of_it = noise.uniform() < 0.5;
    const double size = config.acceleration_bound_mps2 * (all_of_it ? 1.0 : noise.uniform());
    const Vec3 a = scaled(noise.uniform() < 0.5 ? across(u, noise) : random_direction(noise), size);
    const Verdict& v = pushed(rig, u, a);
    RC_ASSERT((v.qualifiers & Qualifier::standstill_assumed) == 0);
    RC_ASSERT(v.margin >= 0.0);
    RC_ASSERT(v.state != HealthState::failed);
    RC_ASSERT(v.norm_mismatch.kind != NormMismatchKind::common_scale &&
              v.norm_mismatch.kind != NormMismatchKind::common_bias);
    if (!bounded(v)) continue;
    ++told;
    RC_ASSERT(angle_between_rad(v.gravity_mps2, u) <= v.protection_level_calibrated_axes_rad);
    RC_ASSERT(v.alert == (v.protection_level_calibrated_axes_rad > config.alert_limit_rad));
    RC_ASSERT(v.alert == (v.validity != Validity::valid));
  }
  RC_ASSERT(rig.ever_blamed.empty());
  RC_ASSERT(told > 0);
}

/// The length shows all of an acceleration along gravity, and no more is forgiven than was stated.
// Negative: REQ-129
TEST(AccelerationBound, AlongGravityALittleMoreThanStatedIsANormMismatch) {
  for (const double share : {0.95, 1.1}) {
    MonitorConfig config = allowing(kThirtyMg_mps2);
    config.alert_limit_rad = rad_from_deg(3.0);
    Rig rig(cone_array(6), config);
    rig.prove();
    const Vec3 u = direction_at(40, 200);
    const Verdict& v = pushed(rig, u, scaled(u, share * kThirtyMg_mps2), 3);
    EXPECT_EQ(v.validity, share < 1.0 ? Validity::valid : Validity::unconfirmed) << share;
    EXPECT_EQ(v.cause, share < 1.0 ? Cause::passed_block : Cause::norm_mismatch) << share;
    EXPECT_TRUE(rig.ever_blamed.empty());
  }
}

/// A length that no acceleration within the bound explains is studied as before, and the direction that is then called
/// usable is so within what the acceleration may turn it too.
TEST(AccelerationBound, ANormMismatchIsReportedBeyondItOnly) {
  for (const AlarmForm form : {AlarmForm::every_tool, AlarmForm::average_tool}) {
    for (const double alert_deg : {6.0, 0.2}) {
      MonitorConfig config = allowing(5e-3 * kG0_mps2);
      config.alarm_form = form;
      config.alert_limit_rad = rad_from_deg(alert_deg);
      Rig rig(cone_array(6), config);
      rig.prove();
      Noise noise(4);
      for (int k = 0; k < 14; ++k) {
        const Vec3 u = random_direction(noise);
        pushed(rig, u, plus(scaled(u, 0.02 * kG0_mps2), scaled(random_direction(noise), 5e-3 * kG0_mps2)));
      }
      const NormMismatch& found = rig.monitor.verdict().norm_mismatch;
      EXPECT_EQ(found.kind, alert_deg > 1.0 ? NormMismatchKind::common_scale : NormMismatchKind::undecided);
      EXPECT_NEAR(found.length_mps2, 0.02 * kG0_mps2, 5e-3 * kG0_mps2);
      EXPECT_GT(found.turn_rad, std::asin(5e-3));
      EXPECT_TRUE(rig.ever_blamed.empty());
    }
  }
}

/// From one block to the next the length may change by twice the bound, and a healthy set must not be refuted by that
/// where another sensor is at fault and the norm decides.
// Verifies: REQ-129
TEST(AccelerationBound, AccelerationsThatChangeExcludeNoHealthySensorBesideAFault) {
  int told = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const int n = 4 + static_cast<int>(seed % 4);
    Rig rig(n == 4 ? tetrahedron() : cone_array(n), allowing(kThirtyMg_mps2), seed);
    rig.prove();
    rig.distort = [](int i, double r, int) { return i == 1 ? r + 0.5 * kG0_mps2 : r; };
    Noise noise(seed);
    for (int k = 0; k < 10; ++k) {
      const Vec3 u = random_direction(noise);
      pushed(rig, u, scaled(k % 2 == 0 ? u : random_direction(noise), (k % 4 < 2 ? 1.0 : -1.0) * kThirtyMg_mps2));
    }
    EXPECT_TRUE(SensorSet::of(1).contains(rig.ever_blamed)) << seed;
    told += rig.monitor.verdict().excluded == SensorSet::of(1) ? 1 : 0;
  }
  EXPECT_GT(told, 40);
}

// Verifies: REQ-129
TEST(AccelerationBound, WithoutOneEveryVerdictSaysThatAStandstillIsAssumed) {
  for (const double bound : {0.0, 1e-9, kThirtyMg_mps2}) {
    Rig rig(tetrahedron(), allowing(bound));
    const auto assumed = [&rig] { return (rig.monitor.verdict().qualifiers & Qualifier::standstill_assumed) != 0; };
    EXPECT_EQ(assumed(), bound == 0.0) << "before the first sample";
    rig.prove();
    EXPECT_EQ(assumed(), bound == 0.0);
    rig.shake(direction_at(20, 10), 0.5);
    EXPECT_EQ(assumed(), bound == 0.0) << "moving";
  }
}

TEST(AccelerationBound, BeyondGravityTheLevelIsHalfATurnAndTheAlertStays) {
  Rig rig(cone_array(6), allowing(10.0));
  const Verdict& v = rig.prove();
  EXPECT_EQ(v.state, HealthState::nominal);
  EXPECT_EQ(v.validity, Validity::unconfirmed);
  EXPECT_GE(v.protection_level_calibrated_axes_rad, kPi);
  EXPECT_EQ(v.toolface_protection_housing_rad, kPi);
  EXPECT_TRUE(v.alert);
}

// Verifies: REQ-129
TEST(AccelerationBound, TheTurnIsTheArcSineOfItsShareOfTheLeastGravity) {
  const GravityReference exact{kG0_mps2, 0.0, GravityModel::value}, unsure{kG0_mps2, 0.1, GravityModel::value};
  EXPECT_EQ(acceleration_turn_rad(exact, 0.0), 0.0);
  EXPECT_NEAR(acceleration_turn_rad(exact, kThirtyMg_mps2), std::asin(0.03), 1e-15);
  EXPECT_NEAR(acceleration_turn_rad(unsure, 1.0), std::asin(1.0 / (kG0_mps2 - 0.3)), 1e-15);
  EXPECT_LT(acceleration_turn_rad(exact, 0.999999 * kG0_mps2), 0.5 * kPi);
  EXPECT_EQ(acceleration_turn_rad(exact, kG0_mps2), kPi) << "g + a may vanish";
}

/// A fit takes the length at every station for gravity's, and what accelerates the tool for biases.
// Verifies: REQ-129
TEST(AccelerationBound, NoFitIsMadeFromStationsThatMayHaveBeenPushed) {
  Tool tool(5, allowing(kThirtyMg_mps2));
  tool.rig.prove();
  ASSERT_EQ(tool.state(), HealthState::nominal);
  const Expected<void> refused = tool.rig.monitor.request_recalibration();
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, Errc::may_accelerate);
  EXPECT_EQ(refused.error().value, kThirtyMg_mps2);
  MonitorConfig by_itself = allowing(kThirtyMg_mps2);
  by_itself.recalibrate_after_exclusion = true;
  EXPECT_EQ(checked(by_itself).error().code, Errc::out_of_range);
  EXPECT_EQ(checked(by_itself).error().value, kThirtyMg_mps2);
  by_itself.acceleration_bound_mps2 = 0.0;
  EXPECT_TRUE(checked(by_itself).has_value());
  MonitorSetup first = tool.rig.setup;
  first.calibrated = false;
  EXPECT_EQ(HealthMonitor().configure(first).error().code, Errc::may_accelerate);
}

/// What a bench found is not fitted to the length, only tried by it.
TEST(AccelerationBound, AnOfferIsTriedWithinTheWiderLimits) {
  Tool tool(5, allowing(kThirtyMg_mps2));
  tool.drift(2e-3);
  tool.rig.prove();
  ASSERT_EQ(tool.state(), HealthState::nominal);
  SensorModel model = tool.rig.setup.model;
  SensorArray array = tool.rig.setup.array;
  for (std::size_t i = 0; i < 5; ++i) model.sensor[i].bias[0] = tool.bias[i];
  plumb_test::leave_uncertainty(array, 3e-4, 3e-5);
  ASSERT_TRUE(tool.rig.monitor.offer_calibration(model, array).has_value());
  Noise noise(8);
  for (int k = 0; k < 30 && tool.count(HealthEvent::fit_accepted) == 0; ++k) {
    const Vec3 u = random_direction(noise);
    pushed(tool.rig, u, scaled(random_direction(noise), kThirtyMg_mps2));
  }
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  EXPECT_EQ(tool.count(HealthEvent::fit_rejected), 0);
}

}  // namespace
}  // namespace acceleration_bound_test
