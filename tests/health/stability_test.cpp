// Drift since the calibration: what is stated of it is in every limit, in isolation and in the protection level.
#include "plumb/health/stability.hpp"
#include "plumb/detection/estimate_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/simulated_tool.hpp"

namespace stability_test {
namespace {

using namespace plumb;
using plumb_test::Noise;
using plumb_test::random_direction;
using plumb_test::Rig;

constexpr double kMilligee_mps2 = 1e-3 * kG0_mps2;

struct Outcome {
  int tools = 0, blamed = 0, beyond = 0, valid = 0, blocks = 0, failed = 0;
};

/// Tools whose every bias has moved by N(0, drift), with so much stated. `shared`: all by the same amount.
Outcome run(double stated_mps2, double drift_mps2, bool shared, int tools) {
  Outcome out;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(tools); ++seed) {
    const int n = 4 + static_cast<int>(seed % 5);
    Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), {}, seed);
    rig.setup.stability.fill({stated_mps2, 0.0, 0.0, 0.0});
    rig.restart();
    Noise noise(seed);
    std::array<double, kCapacity> moved{};
    moved.fill(drift_mps2 * noise.normal());
    for (double& m : moved) m = shared ? moved[0] : drift_mps2 * noise.normal();
    rig.distort = [moved](int i, double r, int) { return r + moved[static_cast<std::size_t>(i)]; };
    rig.prove();
    for (int k = 0; k < 12; ++k) {
      const Vec3 u = random_direction(noise);
      const Verdict& v = rig.stay(u, 2);
      ++out.blocks;
      if (v.validity != Validity::valid || !v.protection_available) continue;
      ++out.valid;
      if (angle_between_rad(v.gravity_mps2, u) > v.protection_level_calibrated_axes_rad) ++out.beyond;
    }
    ++out.tools;
    if (!rig.ever_blamed.empty()) ++out.blamed;
    if (rig.monitor.verdict().state == HealthState::failed) ++out.failed;
  }
  return out;
}

// Verifies: REQ-123
TEST(Stability, DriftWithinTheStatedStabilityExcludesNoSensorAndStaysWithinTheProtectionLevel) {
  for (const bool shared : {false, true}) {
    const Outcome out = run(0.5 * kMilligee_mps2, 0.5 * kMilligee_mps2, shared, 100);
    EXPECT_EQ(out.blamed, 0) << "shared " << shared;
    EXPECT_EQ(out.beyond, 0) << "shared " << shared;
    EXPECT_EQ(out.failed, 0) << "shared " << shared;
    EXPECT_GT(out.valid, out.blocks * 9 / 10) << "shared " << shared;
  }
}

// Negative: REQ-123
TEST(Stability, WhereNothingIsStatedTheSameDriftIsBeyondBound) {
  const Outcome out = run(0.0, 0.5 * kMilligee_mps2, false, 100);
  EXPECT_EQ(out.blamed, 0) << "the first attitudes contradict the calibration, and nobody is excluded by it";
  EXPECT_LT(out.valid, out.blocks * 9 / 10);
  const Outcome shared = run(0.0, 2.0 * kMilligee_mps2, true, 100);
  EXPECT_GT(out.beyond + shared.beyond, 0) << "what comes before the contradiction is not bounded";
}

/// A cone along z under a tolerance of one sensor, by hand: nothing else is uncertain.
// Verifies: REQ-123
TEST(Stability, ToleranceEntersParityAndNormAsABound) {
  const SensorArray array = plumb_test::tetrahedron();
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  const GravityReference gravity{kG0_mps2, 0.0, GravityModel::value};
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 16.0;
  const Vec3 u = {0.6, 0.0, 0.8};
  for (std::size_t i = 0; i < 4; ++i) block.mean_mps2[i] = kG0_mps2 * dot(array.axis(static_cast<int>(i)), u);
  const SetTest sharp = test_set(array, gravity, limits, block, array.all());
  const float tau = 1e-3F;
  block.tolerance_mps2.fill(tau);
  const SetTest wide = test_set(array, gravity, limits, block, array.all());
  const double sigma = array.sigma_mps2(0), root_n = 4.0;
  // A tetrahedron has one parity row, (1, 1, 1, 1) / 2: four errors of tau make 2 tau of it.
  EXPECT_NEAR(wide.parity_systematic - sharp.parity_systematic, root_n * 2.0 * static_cast<double>(tau) / sigma, 1e-9);
  // H^+ of a tetrahedron is 3/4 H': the length moves by 3/4 sum |h_i.u| tau.
  double reach = 0.0;
  for (int i = 0; i < 4; ++i) reach += 0.75 * std::fabs(dot(array.axis(i), u)) * static_cast<double>(tau);
  // ... and by the square of what goes across over twice the length.
  double most = 0.0;
  for (int i = 0; i < 4; ++i) most += 0.75 * norm(cross(array.axis(i), u)) * static_cast<double>(tau);
  const double curved = most * most / (2.0 * (kG0_mps2 - reach));
  const double norm_unit = wide.norm_sigma_mps2 / root_n;
  EXPECT_NEAR((wide.norm_systematic - sharp.norm_systematic) * norm_unit, reach + curved, 1e-9);
  const double across = tolerance_turn_rad(array, block, array.all(), wide);
  EXPECT_NEAR(across, std::atan2(most, kG0_mps2 - reach), 1e-12);
}

/// No errors within the tolerances, at whatever signs, make a healthy set inconsistent or leave the bound.
// Verifies: REQ-123
TEST(Stability, NoErrorsWithinTheTolerancesRejectAHealthySet) {
  Noise noise(77);
  for (int n = 4; n <= kCapacity; ++n) {
    const SensorArray array = n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n);
    const TestLimits limits = TestLimits::from_rates(n, 1e-5, 1e-6);
    const GravityReference gravity{kG0_mps2, 0.0, GravityModel::value};
    for (int trial = 0; trial < 400; ++trial) {
      BlockEvidence block;
      block.usable = array.all();
      block.samples = 32.0;
      const Vec3 u = random_direction(noise);
      for (int i = 0; i < n; ++i) {
        const auto a = static_cast<std::size_t>(i);
        block.tolerance_mps2[a] = static_cast<float>(5e-2 * noise.uniform());
        const double sign = noise.uniform() < 0.5 ? -1.0 : 1.0;
        const double error = trial % 2 == 0 ? sign : 2.0 * noise.uniform() - 1.0;
        block.mean_mps2[a] = kG0_mps2 * dot(array.axis(i), u) + error * static_cast<double>(block.tolerance_mps2[a]);
      }
      for (SensorSet set = SensorSet::first(3); array.all().contains(set); set = next_of_same_size(set)) {
        const SetTest t = test_set(array, gravity, limits, block, set);
        if (!t.tested) continue;
        EXPECT_LE(std::fabs(t.norm), t.norm_systematic * (1.0 + 1e-9) + 1e-6) << n;
        EXPECT_LE(angle_between_rad(t.x_mps2, u), tolerance_turn_rad(array, block, set, t) + 1e-12) << n;
      }
      const SetTest all = test_set(array, gravity, limits, block, array.all());
      EXPECT_LE(all.parity, all.parity_systematic + 1e-9) << n;
      EXPECT_TRUE(all.consistent(limits)) << n;
    }
  }
}

// Verifies: REQ-123
TEST(Stability, GrowsWithDaysDegreesAndDegreesAMinute) {
  const Stability s{1e-3, 2e-5, 3e-4, 4e-4};
  EXPECT_FLOAT_EQ(StabilityNow::of(s, 0.0).tolerance_mps2(0.0, 0.0), static_cast<float>(kStabilitySigmas * 1e-3));
  EXPECT_FLOAT_EQ(StabilityNow::of(s, 100.0).tolerance_mps2(-10.0, 5.0),
                  static_cast<float>(kStabilitySigmas * (1e-3 + 2e-3 + 3e-3 + 2e-3)));
  EXPECT_EQ(StabilityNow::of({10.0, 10.0, 10.0, 10.0}, kMostDaysSinceCalibration).tolerance_mps2(1e9, 1e6),
            kMostTolerance_mps2);
}

/// What is no stability is refused with the sensor at fault.
// Negative: REQ-170
TEST(Stability, RefusesWhatIsNoStability) {
  Rig rig(plumb_test::tetrahedron());
  const auto refused = [&rig](const Stability& s, double days) {
    rig.setup.stability[2] = s;
    rig.setup.days_since_calibration = days;
    HealthMonitor monitor;
    const Expected<void> done = monitor.configure(rig.setup);
    return done ? Error{} : done.error();
  };
  EXPECT_EQ(refused({1e-3, 1e-6, 1e-5, 1e-4}, 30.0).code, Errc::ok);
  EXPECT_EQ(refused({-1e-3, 0.0, 0.0, 0.0}, 0.0).code, Errc::out_of_range);
  EXPECT_EQ(refused({0.0, 0.0, 20.0, 0.0}, 0.0).index, 2);
  EXPECT_EQ(refused({0.0, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, 0.0).code, Errc::not_finite);
  EXPECT_EQ(refused({}, -1.0).code, Errc::out_of_range);
  EXPECT_EQ(refused({}, 40000.0).limit, kMostDaysSinceCalibration);
}

// Verifies: REQ-123
TEST(Stability, AVerdictSaysWhereACalibrationStatesNoUncertainty) {
  RowUncertainty left;
  for (std::size_t a = 0; a < 16; ++a) left.covariance[a * (a + 1) / 2 + a] = 1e-8;
  const auto unstated = [](const RowUncertainty& uncertainty) {
    SensorArray array = plumb_test::tetrahedron();
    array.set_uncertainty(uncertainty);
    Rig rig(array);
    rig.stay(plumb_test::direction_at(20, 10));
    return (rig.monitor.verdict().qualifiers & Qualifier::uncertainty_unstated) != 0;
  };
  EXPECT_FALSE(unstated(left));
  EXPECT_TRUE(unstated(RowUncertainty{}));
  for (std::size_t a = 4; a < 8; ++a) left.covariance[a * (a + 1) / 2 + a] = 0.0;
  EXPECT_TRUE(unstated(left)) << "of one sensor";
  left.covariance[7 * 8 / 2 + 7] = 1e-8;
  EXPECT_TRUE(unstated(left)) << "its bias alone is uncertain, scale and axis are not";
  left.covariance[7 * 8 / 2 + 7] = 0.0;
  left.covariance[4 * 5 / 2 + 4] = 1e-8;
  EXPECT_TRUE(unstated(left)) << "its scale and axis are uncertain, its bias is not";
  left.misfit_mps2[1] = 1e-4;
  EXPECT_TRUE(unstated(left)) << "a misfit is noise at an attitude, and says nothing of bias and axis";
}

// Verifies: REQ-123
TEST(Stability, AVerdictSaysWhereNoneIsStated) {
  Rig rig(plumb_test::tetrahedron());
  const auto unstated = [&rig] { return (rig.monitor.verdict().qualifiers & Qualifier::stability_unstated) != 0; };
  rig.stay(plumb_test::direction_at(20, 10));
  EXPECT_TRUE(unstated());
  rig.setup.stability.fill({1e-3, 0.0, 0.0, 0.0});
  rig.setup.stability[1] = {};
  rig.restart();
  rig.stay(plumb_test::direction_at(20, 10));
  EXPECT_TRUE(unstated()) << "of one sensor";
  rig.setup.stability[1].per_degc_mps2 = 1e-5;
  rig.restart();
  rig.stay(plumb_test::direction_at(20, 10));
  EXPECT_FALSE(unstated());
}

}  // namespace
}  // namespace stability_test
