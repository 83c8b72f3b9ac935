// One gyro that may have failed, and two of which one may have: nobody is blamed for it, and it is told.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>

#include "motion/motion_flight.hpp"

// Serves: REQ-204, REQ-210

namespace motion_gyro_test {
namespace {

using namespace plumb;
using plumb_test::add_bias_from;
using plumb_test::cone_array;
using plumb_test::Flight;
using plumb_test::motion_setup;
using plumb_test::RigidMotion;
using plumb_test::slow_setup;

/// One gyro that nothing corroborates: a small fault is seen, and the gyro would explain it; a large one is isolated.
// Negative: REQ-204
TEST(MotionMonitor, BesideOneGyroALargeFaultIsIsolated) {
  Flight small(cone_array(6, 0.01), slow_setup(6, 3), 6), large(cone_array(6, 0.01), slow_setup(6, 3), 6);
  add_bias_from(small, 0.3, 2, 0.5);
  add_bias_from(large, 0.3, 2, 20.0);
  small.fly(0, 1200);
  large.fly(0, 1200);
  EXPECT_TRUE(small.ever_isolated.empty());
  EXPECT_EQ(small.monitor.verdict().cause, MotionCause::gyro_inconsistent);
  EXPECT_EQ(small.monitor.verdict().suspects, SensorSet::of(2));
  EXPECT_EQ(large.ever_excluded, SensorSet::of(2));
}

/// With long arms a gyro that died explains what a fault of a sensor would.
// Verifies: REQ-204
TEST(MotionMonitor, ADeadGyroIsolatesNoSensor) {
  int inconsistent = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Flight flight(cone_array(6, 0.01), motion_setup(6, seed), seed);
    flight.distort = [&](MotionSample& s) {
      if (s.time_s >= 0.3) s.rate_radps[0] = seed % 2 == 0 ? Vec3{} : scaled(s.rate_radps[0], 2.0);
    };
    flight.fly(0, 900);
    EXPECT_TRUE(flight.ever_isolated.empty()) << seed;
    inconsistent += flight.monitor.verdict().cause == MotionCause::gyro_inconsistent ? 1 : 0;
  }
  EXPECT_GT(inconsistent, 0);
}

/// Two healthy gyros, each with a scale of its own within the bound, and clocks and turns as stated.
// Verifies: REQ-210
RC_GTEST_PROP(MotionGyroLaw, HealthyGyrosAreNeverSaidToDisagree, ()) {
  const std::uint64_t seed = *rc::gen::arbitrary<std::uint32_t>();
  MotionSetup setup = motion_setup(6, seed);
  setup.gyros = 2;
  setup.gyro = {0.02, 0.01, 0.01, 2e-3, 0.0};
  Flight flight(cone_array(6, 0.01), setup, seed);
  flight.motion.draw_errors(true);
  const double scale = *rc::gen::element(-0.02, 0.0, 0.02), bias = *rc::gen::element(-0.01, 0.01);
  const double turn = *rc::gen::element(-0.01, 0.01);
  flight.distort = [&](MotionSample& s) {
    s.rate_radps[0] = scaled(s.rate_radps[0], (1.0 + scale) / (1.0 + flight.motion.errors.gyro_scale));
    const Vec3 w = s.rate_radps[1];
    s.rate_radps[1] = {w[0] - turn * w[1] + bias, w[1] + turn * w[0], w[2]};
  };
  for (std::uint64_t k = 0; k < 800; k += 50) {
    flight.fly(k, k + 50);
    RC_ASSERT(!flight.monitor.verdict().gyros_disagree);
  }
}

/// A tone of the rate about one axis, one sensor of six on an arm, and nothing wrong but the noise and the times of two
/// gyros.
struct Tone {
  double hz = 0.0, radps = 0.0, phase_rad = 0.0;
  std::array<double, kGyros> lag_s{};
};
struct Blame {
  bool alarm = false, disagree = false;
};

Blame blame_by(const Tone& tone, const GyroErrors& stated) {
  MotionSetup setup = motion_setup(6);
  for (Vec3& arm : setup.lever_arm_m) arm = {};
  setup.lever_arm_m[0] = {0.0, 0.1, 0.0};
  setup.errors.fill({0.0, 0.0, 0.0, 0.0, 0.0, 0.001});
  setup.gyros = 2;
  setup.gyro = stated;
  const SensorArray array = cone_array(6, 0.005);
  MotionMonitor monitor;
  EXPECT_TRUE(monitor.configure(array, setup).has_value());
  plumb_test::Noise noise(7);
  const double circular = 2.0 * kPi * tone.hz;
  const auto rate = [&](double t_s) { return tone.radps * std::sin(circular * t_s + tone.phase_rad); };
  Blame out;
  for (int k = 0; k < 1500; ++k) {
    MotionSample s;
    s.time_s = k * setup.sample_period_s;
    s.delivered = array.all();
    const double w = rate(s.time_s), change = tone.radps * circular * std::cos(circular * s.time_s + tone.phase_rad);
    for (int i = 0; i < 6; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Vec3& arm = setup.lever_arm_m[at];
      const Vec3 felt{-change * arm[1] - w * w * arm[0], change * arm[0] - w * w * arm[1], kG0_mps2};
      s.reading_mps2[at] = dot(array.axis(i), felt) + 0.005 * noise.normal();
    }
    for (std::size_t g = 0; g < s.rate_radps.size(); ++g) {
      s.rate_radps[g] = {0.0, 0.0, rate(s.time_s + tone.lag_s[g])};
      for (double& part : s.rate_radps[g]) part += stated.noise_radps * noise.normal();
      s.rate_given[g] = true;
    }
    const MotionVerdict& verdict = monitor.step(s);
    out.alarm = out.alarm || verdict.alarm;
    out.disagree = out.disagree || verdict.gyros_disagree;
  }
  return out;
}

/// Near one over twice the length of a block the angular acceleration of a pair of blocks is that of the pair before,
/// and what lag changes is largest.
// Negative: REQ-210
TEST(MotionGyro, LagWithinItsBoundBlamesNobodyWhateverTheToneIs) {
  for (const double hz : {15.0, 15.625, 60.0, 120.0, 125.0}) {
    for (const double lag_s : {20e-6, 250e-6, 1e-3}) {
      for (const double other_s : {-lag_s, lag_s}) {
        const Blame found =
            blame_by({hz, hz < 50.0 ? 0.5 : 1.5, 0.0, {lag_s, other_s}}, {0.01, 0.01, 0.006, 0.0017, lag_s});
        EXPECT_FALSE(found.alarm || found.disagree) << hz << " Hz, " << lag_s << " s, " << other_s << " s";
      }
    }
  }
}

/// Ideal gyros: readings sum the angular acceleration at the samples, rates between them.
// Negative: REQ-201
TEST(MotionGyro, IdealGyrosBlameNobodyWhateverTheToneIs) {
  for (const double hz : {40.0, 62.5, 80.0, 100.0, 125.0, 160.0, 200.0, 250.0, 318.0, 333.0, 400.0}) {
    for (const double radps : {0.05, 0.5, 1.5}) {
      for (const double phase_rad : {0.0, 0.8, 1.2}) {
        const Blame found = blame_by({hz, radps, phase_rad, {}}, {0.0, 0.0, 0.0, 0.0005, 0.0});
        EXPECT_FALSE(found.alarm || found.disagree) << hz << " Hz, " << radps << " rad/s, " << phase_rad;
      }
    }
  }
}

/// A rate that no gyro gives is none: its square would be infinite in every sum that it enters.
TEST(MotionGyro, ARateBeyondAllGyrosIsNone) {
  for (const double garbage : {2e4, 1e100, -1e308}) {
    MotionSetup setup = motion_setup(6, 3);
    setup.gyros = 2;
    Flight flight(cone_array(6, 0.01), setup, 4);
    flight.distort = [garbage](MotionSample& s) {
      if (s.time_s >= 0.3) s.rate_radps[1] = {0.0, garbage, 0.0};
    };
    flight.fly(0, 600);
    EXPECT_EQ(flight.monitor.verdict().sample.validity, ForceValidity::bounded) << garbage;
    EXPECT_LT(flight.monitor.verdict().sample.bound_mps2, 2e3) << garbage;
    EXPECT_TRUE(flight.ever_isolated.empty()) << garbage;
    EXPECT_LT(flight.worst_ratio, 1.0) << garbage;
  }
}

/// Whichever of the two it is: no sensor is blamed, the bound holds, and it is told.
// Negative: REQ-210
TEST(MotionGyro, AFaultyGyroOfTwoIsTold) {
  const std::function<void(Vec3&, Vec3&)> faults[] = {
      [](Vec3& w, Vec3&) { w = {}; }, [](Vec3& w, Vec3&) { w = scaled(w, 2.0); }, [](Vec3& w, Vec3&) { w[1] += 0.5; },
      [](Vec3& w, Vec3& held) {
        if (norm(held) == 0.0) held = w;
        w = held;
      }};
  for (std::size_t fault = 0; fault < 4; ++fault) {
    for (std::size_t gyro = 0; gyro < 2; ++gyro) {
      MotionSetup setup = motion_setup(6, 3);
      setup.gyros = 2;
      setup.gyro.bias_radps = 0.01;
      Flight flight(cone_array(6, 0.01), setup, 5 + fault);
      Vec3 held{};
      flight.distort = [&](MotionSample& s) {
        if (s.time_s >= 0.3) faults[fault](s.rate_radps[gyro], held);
      };
      flight.fly(0, 300);
      EXPECT_FALSE(flight.monitor.verdict().gyros_disagree) << fault;
      flight.fly(300, 900);
      EXPECT_TRUE(flight.monitor.verdict().gyros_disagree) << fault << " " << gyro;
      EXPECT_TRUE(flight.ever_isolated.empty()) << fault;
      EXPECT_LT(flight.worst_ratio, 1.0) << fault;
      EXPECT_FALSE(flight.monitor.verdict().alarm) << "an alarm is about the sensors";
      flight.distort = [](MotionSample&) {};
      flight.fly(900, 5800);
      EXPECT_TRUE(flight.monitor.verdict().gyros_disagree) << "for quiet_s";
      flight.fly(5800, 6600);
      EXPECT_FALSE(flight.monitor.verdict().gyros_disagree);
    }
  }
}

/// Rest judges sensors, not gyros.
TEST(MotionGyro, GyrosThatDisagreeOutlastWhatRestJudgesAndNotAClockThatBeginsAnew) {
  MotionSetup setup = motion_setup(6, 3);
  setup.gyros = 2;
  Flight flight(cone_array(6, 0.01), setup, 5);
  flight.distort = [](MotionSample& s) { s.rate_radps[1] = {}; };
  flight.fly(0, 600);
  ASSERT_TRUE(flight.monitor.verdict().gyros_disagree);
  flight.monitor.forget();
  EXPECT_TRUE(flight.monitor.verdict().gyros_disagree);
  flight.distort = [](MotionSample& s) { s.time_s -= 1000.0; };
  flight.fly(600, 6400);
  EXPECT_FALSE(flight.monitor.verdict().gyros_disagree) << "as old as the new clock says";
}

/// Where a faulty gyro explains what no fault set of sensors does, it is the cause, and not more faults than allowed.
TEST(MotionGyro, ADeadGyroAloneIsTheCauseThatIsNamed) {
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    MotionSetup setup = motion_setup(6, seed);
    setup.max_faults = 1;
    Flight flight(cone_array(6, 0.01), setup, seed);
    flight.distort = [](MotionSample& s) {
      if (s.time_s >= 0.3) s.rate_radps[0] = {};
    };
    flight.fly(0, 900);
    const MotionVerdict& verdict = flight.monitor.verdict();
    EXPECT_NE(verdict.cause, MotionCause::too_many_faults) << seed;
    if (verdict.least_faults <= 1) continue;
    EXPECT_EQ(verdict.cause, MotionCause::gyro_inconsistent) << seed;
    ++seen;
  }
  EXPECT_GT(seen, 0);
}

/// With two gyros of which one died the fault is isolated all the same, and nobody else.
TEST(MotionMonitor, WithOneOfTwoGyrosDeadTheFaultIsIsolated) {
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    MotionSetup setup = motion_setup(6, seed);
    setup.gyros = 2;
    Flight flight(cone_array(6, 0.01), setup, seed);
    flight.distort = [](MotionSample& s) {
      if (s.time_s >= 0.3) s.rate_radps[1] = {};
      if (s.time_s >= 0.6) s.reading_mps2[2] += 10.0;
    };
    flight.fly(0, 1200);
    EXPECT_TRUE(SensorSet::of(2).contains(flight.ever_isolated)) << seed;
    right += flight.ever_excluded == SensorSet::of(2) ? 1 : 0;
  }
  EXPECT_GE(right, 18);
}

/// A gyro that misses a sample now and then is no reason to reject a healthy set, whatever came just before the gap.
TEST(MotionMonitor, AGyroThatMissesSamplesRaisesNoAlarm) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    MotionSetup setup = motion_setup(6, seed);
    Flight flight(cone_array(6, 0.001), setup, seed);
    flight.motion = RigidMotion(flight.array, flight.setup, seed, 200.0, 6.0);
    flight.motion.draw_errors(true);
    plumb_test::Noise luck(seed);
    flight.distort = [&luck](MotionSample& s) { s.rate_given[0] = luck.uniform() > 0.3; };
    flight.fly(0, 400);
    EXPECT_FALSE(flight.monitor.verdict().alarm) << seed;
  }
}

}  // namespace
}  // namespace motion_gyro_test
