// A healthy tool that shakes: 1 mg to 1 g in steps of 1 dB, along fixed and random directions, broadband and
// sinusoidal, with frequencies that fit the block, beat with it or hide behind the sampling. The whole monitor; nobody
// is ever excluded, nothing fails. By default every sixth step and few directions; the long run (PLUMB_LONG=1) takes
// the grid. Serves: REQ-059
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include "support/binomial_interval.hpp"
#include "support/long_run.hpp"
#include "support/simulated_tool.hpp"

namespace vibration_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::Rig;

constexpr int kSteps = 60;  ///< 1 dB each: 1 mg to 1 g

/// Acceleration of the housing at a sample, rms of one [in the unit of the amplitude].
struct Shape {
  const char* name;
  double cycles_per_sample;  ///< 0: broadband, a fresh value at every sample
  bool swings;               ///< at least a quarter of a cycle within a block: motion that a block can show
};

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> list = {
      {"broadband", 0.0, true},
      {"one cycle a block", 1.0 / 32.0, true},
      {"seven cycles a block", 7.0 / 32.0, true},
      {"half a cycle a block", 0.5 / 32.0, true},
      {"a third of the rate", 1.0 / 3.0, true},
      {"near the Nyquist rate", 0.5 - 1.0 / 320.0, true},
      {"aliased to a cycle in two blocks", 1.0 + 0.5 / 32.0, true},
      {"aliased to a cycle in ten blocks", 3.0 + 0.1 / 32.0, false},
      {"aliased to a cycle in a hundred blocks", 1.0 - 0.01 / 32.0, false},
      {"aliased to rest", 2.0, false},
  };
  return list;
}

std::vector<Vec3> directions(const SensorArray& array, int random, Noise& noise) {
  std::vector<Vec3> out = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double a = std::sqrt(0.5), b = std::sqrt(1.0 / 3.0);
  for (const Vec3& v : {Vec3{a, a, 0}, Vec3{a, 0, -a}, Vec3{0, a, a}, Vec3{b, b, b}, Vec3{-b, b, b}}) out.push_back(v);
  for (int i = 0; i < array.size(); ++i) out.push_back(array.axis(i));
  for (int k = 0; k < random; ++k) out.push_back(plumb_test::random_direction(noise));
  return out;
}

struct Outcome {
  std::int64_t ticks = 0, excluded = 0, failed = 0;
  int told = 0, asked = 0;                     ///< faults after the vibration
  std::int64_t strong = 0, strong_moving = 0;  ///< at 1 g rms and a shape that swings
};

/// One run up the ladder of amplitudes; the tool stands, or creeps by a degree a block.
void climb(Rig& rig, const Shape& shape, const Vec3& along, int step_db, int blocks, bool creeps, Noise& noise,
           Outcome& out) {
  const int window = rig.setup.config.window;
  double phase = 2.0 * kPi * noise.uniform();
  double inclination = 15.0 + 60.0 * noise.uniform();
  const double toolface = 360.0 * noise.uniform();
  for (int step = 0; step <= kSteps; step += step_db) {
    const double rms = 1e-3 * kG0_mps2 * std::pow(10.0, step / 20.0);
    for (int block = 0; block < blocks; ++block) {
      inclination += creeps ? 1.0 : 0.0;
      const Vec3 g = scaled(direction_at(inclination, toolface), kG0_mps2);
      for (int s = 0; s < window; ++s) {
        phase += 2.0 * kPi * shape.cycles_per_sample;
        const double now = shape.cycles_per_sample > 0.0 ? std::sqrt(2.0) * std::sin(phase) : noise.normal();
        const Vec3 a = plus(g, scaled(along, rms * now));
        rig.step(rig.sample(scaled(a, 1.0 / norm(a)), norm(a)));
      }
      const Verdict& v = rig.monitor.verdict();
      ++out.ticks;
      out.failed += v.state == HealthState::failed ? 1 : 0;
      if (step == kSteps && shape.swings) {
        ++out.strong;
        out.strong_moving += (v.qualifiers & Qualifier::moving) != 0 ? 1 : 0;
      }
    }
  }
  out.excluded += rig.ever_blamed.empty() ? 0 : 1;
}

/// The monitor is as good as before: a fault after all that is told.
bool tells_a_fault(Rig& rig, Noise& noise) {
  rig.distort = [](int i, double r, int) { return i == 1 ? r + 1.0 : r; };
  for (int k = 0; k < 8; ++k) rig.stay(plumb_test::random_direction(noise));
  return rig.monitor.verdict().excluded == SensorSet::of(1);
}

Outcome shake(const SensorArray& array, std::uint64_t seed) {
  const bool full = plumb_test::long_run();
  Noise noise(seed);
  Outcome out;
  for (const Vec3& along : directions(array, full ? 100 : 3, noise)) {
    for (const Shape& shape : shapes()) {
      Rig rig(array, {}, seed + static_cast<std::uint64_t>(1e9 * noise.uniform()));
      rig.prove();
      climb(rig, shape, along, full ? 1 : 6, full ? 8 : 3, noise.uniform() < 0.5, noise, out);
      EXPECT_TRUE(rig.ever_blamed.empty()) << shape.name << ", " << array.size() << " sensors";
      EXPECT_NE(rig.monitor.verdict().state, HealthState::failed) << shape.name << ", " << array.size() << " sensors";
      out.told += tells_a_fault(rig, noise) ? 1 : 0;
      ++out.asked;
    }
  }
  return out;
}

void expect_borne(const char* name, const Outcome& o) {
  std::cout << "[ measured ] " << name << ": " << o.ticks << " blocks, runs with an exclusion " << o.excluded
            << ", failed blocks " << o.failed << ", at 1 g " << o.strong_moving << " of " << o.strong
            << " moving (95 %: " << plumb_test::clopper_pearson(o.strong_moving, o.strong, 0.95).low << " ..)\n";
  EXPECT_EQ(o.excluded, 0) << name;
  EXPECT_EQ(o.failed, 0) << name;
  EXPECT_GE(100 * o.told, 99 * o.asked) << name << ": a fault after the vibration";
  EXPECT_GT(o.strong, 100) << name;
  EXPECT_GE(1000 * o.strong_moving, 999 * o.strong) << name;
}

// Verifies: REQ-059
TEST(Vibration, OfFourSensorsItExcludesNone) { expect_borne("four sensors", shake(plumb_test::tetrahedron(), 11)); }

// Verifies: REQ-059
TEST(Vibration, OfSixSensorsItExcludesNone) { expect_borne("six sensors", shake(plumb_test::cone_array(6), 12)); }

// Verifies: REQ-059
TEST(Vibration, OfEightSensorsItExcludesNone) { expect_borne("eight sensors", shake(plumb_test::cone_array(8), 13)); }

// Verifies: REQ-059
TEST(Vibration, OfTwoTriadsItExcludesNone) {
  AxisList axes{};
  for (std::size_t i = 0; i < 6; ++i) axes[i][i % 3] = 1.0;
  expect_borne("two triads", shake(plumb_test::make_array(axes, 6, 2e-4 * kG0_mps2), 14));
}

/// Three sensors have no parity: a reading off the length of gravity cannot be told from a fault, and motion that hides
/// behind the sampling looks like one. Nobody is excluded all the same.
// Verifies: REQ-059
TEST(Vibration, OfThreeSensorsItExcludesNone) {
  AxisList axes{};
  for (std::size_t i = 0; i < 3; ++i) axes[i][i] = 1.0;
  const SensorArray array = plumb_test::make_array(axes, 3, 2e-4 * kG0_mps2);
  Noise noise(15);
  Outcome out;
  for (const Vec3& along : directions(array, plumb_test::long_run() ? 20 : 3, noise)) {
    for (const Shape& shape : shapes()) {
      if (!shape.swings) continue;
      Rig rig(array, {}, static_cast<std::uint64_t>(1e9 * noise.uniform()));
      rig.prove();
      climb(rig, shape, along, plumb_test::long_run() ? 1 : 6, 3, false, noise, out);
    }
  }
  expect_borne("three sensors", out);
}

/// Blocks too short to show slow motion, or any: what looks like another length of gravity excludes nobody either.
// Verifies: REQ-059
TEST(Vibration, InShortBlocksItExcludesNoSensor) {
  Noise noise(16);
  for (const int window : {1, 4}) {
    for (const int n : {4, 6}) {
      const SensorArray array = n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n);
      Outcome out;
      for (const Vec3& along : directions(array, plumb_test::long_run() ? 40 : 3, noise)) {
        for (const Shape& shape : shapes()) {
          MonitorConfig config;
          config.window = window;
          Rig rig(array, config, static_cast<std::uint64_t>(1e9 * noise.uniform()));
          rig.prove();
          climb(rig, shape, along, plumb_test::long_run() ? 1 : 6, plumb_test::long_run() ? 16 : 4,
                noise.uniform() < 0.5, noise, out);
        }
      }
      EXPECT_EQ(out.excluded, 0) << window << ", " << n;
      EXPECT_EQ(out.failed, 0) << window << ", " << n;
    }
  }
}

/// A tool as it comes from a stand: scales and offsets a little off, by what its calibration says of itself, and
/// gravity by two of its sigmas. Vibration times a scale error is a parity residual.
// Verifies: REQ-059
TEST(Vibration, WithAnImperfectCalibrationItExcludesNoSensor) {
  const double s_scale = 2e-4, s_offset_mps2 = 1e-3;
  Noise noise(17);
  Outcome out;
  for (const int n : {4, 6, 8}) {
    SensorArray array = n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n);
    auto u = std::make_unique<RowUncertainty>();
    for (int i = 0; i < n; ++i) {
      for (int p = 0; p < 4; ++p) {
        const int a = 4 * i + p;
        for (int q = 0; q <= p; ++q) {
          const double both = p < 3 ? array.axis(i)[static_cast<std::size_t>(p)] *
                                          array.axis(i)[static_cast<std::size_t>(q)] * s_scale * s_scale
                                    : 0.0;
          u->covariance[static_cast<std::size_t>(a * (a + 1) / 2 + 4 * i + q)] =
              p == 3 && q == 3 ? s_offset_mps2 * s_offset_mps2 : both;
        }
      }
    }
    array.set_uncertainty(*u);
    for (const Vec3& along : directions(array, plumb_test::long_run() ? 40 : 3, noise)) {
      for (const Shape& shape : shapes()) {
        Rig rig(array, {}, static_cast<std::uint64_t>(1e9 * noise.uniform()));
        rig.setup.gravity.g_mps2 += (noise.uniform() < 0.5 ? 2.0 : -2.0) * rig.setup.gravity.sigma_mps2;
        rig.restart();
        std::array<double, kCapacity> scale{}, offset{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
          scale[i] = 1.0 + s_scale * noise.normal();
          offset[i] = s_offset_mps2 * noise.normal();
        }
        rig.distort = [&](int i, double r, int) {
          return r * scale[static_cast<std::size_t>(i)] + offset[static_cast<std::size_t>(i)];
        };
        rig.prove();
        climb(rig, shape, along, plumb_test::long_run() ? 1 : 6, 3, noise.uniform() < 0.5, noise, out);
      }
    }
  }
  expect_borne("imperfect calibration", out);
}

/// Quiet and the length off: the reference is wrong, or faults that parity cannot see. An alarm, never valid.
// Verifies: REQ-060
TEST(AtRestWithNormOff, GravityWrongByOnePercentIsNeverValid) {
  for (const int n : {4, 6, 8}) {
    for (const double share : {0.99, 1.01}) {
      for (const bool from_the_start : {true, false}) {
        Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n));
        Noise noise(static_cast<std::uint64_t>(n));
        if (!from_the_start) rig.prove();
        const int stations = plumb_test::long_run() ? 2000 : 60;
        for (int k = 0; k < stations; ++k) {
          const Verdict& v = rig.stay(plumb_test::random_direction(noise), 2, share * kG0_mps2);
          EXPECT_EQ(v.cause, Cause::norm_mismatch);
          EXPECT_EQ(v.state, HealthState::suspect);
          EXPECT_EQ(v.validity, Validity::unconfirmed);
          EXPECT_TRUE(v.alert);
        }
        EXPECT_TRUE(rig.ever_blamed.empty());
      }
    }
  }
}

/// +0.2 g and -0.2 g on two sensors of the paper's tool cancel in parity (1, 1, 1, -1)/2.
// Verifies: REQ-060
TEST(AtRestWithNormOff, TwoFaultsThatParityCannotSeeAreNeverValidWhereTheLengthIsOff) {
  const int stations = plumb_test::long_run() ? 20000 : 300;
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  const double fault = 0.2 * kG0_mps2;
  rig.distort = [fault](int i, double r, int) { return i == 0 ? r + fault : i == 1 ? r - fault : r; };
  const LeastSquares map = least_squares(rig.setup.array, rig.setup.array.all());
  const Vec3 off = scaled(minus(map.column[0], map.column[1]), fault);
  Noise noise(21);
  int alarms = 0, blind = 0;
  for (int k = 0; k < stations; ++k) {
    const Vec3 u = plumb_test::random_direction(noise);
    const double error = norm(plus(scaled(u, kG0_mps2), off)) - kG0_mps2;
    const Verdict& v = rig.stay(u);
    EXPECT_NE(v.validity, Validity::valid) << k;
    if (std::fabs(error) < 0.006) {  // within noise and three sigmas of gravity: no test of one attitude sees it
      ++blind;
      continue;
    }
    ++alarms;
    EXPECT_EQ(v.state, HealthState::suspect) << k;
    EXPECT_EQ(v.validity, Validity::unconfirmed) << k;
    EXPECT_LT(v.margin, 0.0) << k;
  }
  EXPECT_GT(alarms, 50 * (blind + 1) / 2);
  EXPECT_TRUE(rig.ever_blamed.empty());
}

/// A sensor that scatters from power-on on, before the noise of all has been learned, is named as soon as the others
/// show that theirs is as stated.
// Verifies: REQ-143
// Negative: REQ-143
TEST(Vibration, ASensorThatScattersFromPowerOnIsFoundAtRest) {
  for (const int n : {5, 6}) {
    for (const double times : {4.0, 6.0, 20.0}) {
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Rig rig(plumb_test::cone_array(n), {}, seed);
        Noise own(seed + 5), noise(seed + 13);
        const double extra_mps2 = times * rig.setup.array.sigma_mps2(2);
        rig.distort = [&](int i, double y, int) { return i == 2 ? y + extra_mps2 * own.normal() : y; };
        for (int k = 0; k < 20; ++k) rig.stay(plumb_test::random_direction(noise), 3);
        EXPECT_EQ(rig.ever_blamed, SensorSet::of(2)) << n << " sensors, " << times << " sigmas, seed " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace vibration_test
