// What a monitor refuses to be built from, whoever fills in the setup: no door but this one stands before every host.
#include "plumb/health/monitor_setup.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "plumb/calibration/datasheet.hpp"
#include "snapshot_support.hpp"

namespace monitor_setup_test {
namespace {

using namespace plumb;
using plumb_test::random_direction;
using plumb_test::Rig;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Change>
Error refusal(const Change& change) {
  const Rig rig(plumb_test::tetrahedron());
  MonitorSetup setup = rig.setup;
  change(setup);
  const auto monitor = std::make_unique<HealthMonitor>();
  const Expected<void> taken = monitor->configure(setup);
  if (taken) return Error{};
  EXPECT_EQ(monitor->step(Sample{}).validity, Validity::invalid);
  return taken.error();
}

// Verifies: REQ-170
TEST(MonitorSetup, RefusesWhatItCannotWatch) {
  EXPECT_EQ(refusal([](MonitorSetup& s) { s.config.window = 0; }).code, Errc::out_of_range);
  EXPECT_EQ(refusal([](MonitorSetup& s) { s.model.misalignment[1] = 0.1; }).code, Errc::not_calibrated);
  EXPECT_EQ(refusal([](MonitorSetup& s) { s.config.false_alarm_rate = kNaN; }).code, Errc::not_finite);
  EXPECT_EQ(refusal([](MonitorSetup& s) { s.gravity.g_mps2 = kInfinity; }).code, Errc::implausible_gravity);
  const Error range = refusal([](MonitorSetup& s) { s.full_scale_raw[3] = 9.9; });
  EXPECT_EQ(range.code, Errc::range_too_small);
  EXPECT_EQ(range.index, 3);
}

// Verifies: REQ-170
TEST(MonitorSetup, RefusesASensorThatIsDescribedByNoNumber) {
  for (const double none : {kNaN, kInfinity, -kInfinity}) {
    for (const auto& error : {
             refusal([none](MonitorSetup& s) { s.model.sensor[2].scale[0] = none; }),
             refusal([none](MonitorSetup& s) { s.model.sensor[2].scale[3] = none; }),
             refusal([none](MonitorSetup& s) { s.model.sensor[2].bias[1] = none; }),
             refusal([none](MonitorSetup& s) { s.model.sensor[2].reference_degc = none; }),
             refusal([none](MonitorSetup& s) { s.full_scale_raw[2] = none; }),
             refusal([none](MonitorSetup& s) { s.resolution_raw[2] = none; }),
             refusal([none](MonitorSetup& s) { s.lever_arm_m[2][1] = none; }),
         }) {
      EXPECT_EQ(error.code, Errc::not_finite);
      EXPECT_EQ(error.index, 2);
    }
  }
  for (const auto& error : {
           refusal([](MonitorSetup& s) { s.model.sensor[1].scale[0] = 0.0; }),
           refusal([](MonitorSetup& s) { s.full_scale_raw[1] = -20.0; }),
           refusal([](MonitorSetup& s) { s.resolution_raw[1] = -1e-3; }),
       }) {
    EXPECT_EQ(error.code, Errc::out_of_range);
    EXPECT_EQ(error.index, 1);
  }
}

// A frame of zeros, of a host that forgot it, would publish a vector of no length as valid.
// Verifies: REQ-170
TEST(MonitorSetup, RefusesAnOutputFrameThatBends) {
  const auto refused = [](const Mat3& frame, int row) {
    const Error error = refusal([&frame](MonitorSetup& s) { s.output_frame = frame; });
    EXPECT_EQ(error.code, Errc::frame_not_orthogonal);
    EXPECT_EQ(error.index, row);
  };
  refused({}, 0);
  refused({1, 0, 0, 0, 2, 0, 0, 0, 1}, 1);
  refused({1, 0, 0, 0, 1, 0, 0, 1, 0}, 1);
  refused({1, 0, 0, 0, 1, 0, 0, 0, kNaN}, 0);
  refused({1, 0, 0, 0, 1, 0, 1e-5, 0, 1}, 0);
  const Error mirrored = refusal([](MonitorSetup& s) { s.output_frame = {0, 1, 0, 1, 0, 0, 0, 0, 1}; });
  EXPECT_EQ(mirrored.code, Errc::ok) << "left-handed conventions are taken";
}

// Verifies: REQ-170
TEST(MonitorSetup, RefusesAnUncertaintyThatIsNoCovariance) {
  const auto with = [](std::size_t at, double value) {
    return refusal([at, value](MonitorSetup& s) {
             RowUncertainty u;
             u.covariance[0] = u.covariance[2] = 1e-6;
             u.covariance[at] = value;
             s.array.set_uncertainty(u);
           })
        .code;
  };
  EXPECT_EQ(with(1, 0.9e-6), Errc::ok);
  EXPECT_EQ(with(1, 1.1e-6), Errc::implausible) << "beyond what the variances allow";
  EXPECT_EQ(with(2, -1e-6), Errc::implausible);
  for (const double none : {kNaN, kInfinity, 1e13}) EXPECT_EQ(with(0, none), Errc::implausible) << none;
}

/// What the readings of four sensors may be off by together without that any vector fits better: the signed volumes of
/// the triples that leave one out.
std::array<double, 4> parity_of(const SensorArray& array) {
  std::array<double, 4> out{};
  for (int i = 0; i < 4; ++i) {
    const Vec3 a = array.axis((i + 1) % 4), b = array.axis((i + 2) % 4), c = array.axis((i + 3) % 4);
    out[static_cast<std::size_t>(i)] = (i % 2 == 0 ? 1.0 : -1.0) * dot(a, cross(b, c));
  }
  return out;
}

// Calibrations that know next to nothing of what no vector shows: rounding leaves variances below zero, which no host
// may be given as valid.
// Verifies: REQ-170
TEST(MonitorSetup, WhatIsUsableHasVariances) {
  int below_zero = 0, usable = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Rig rig(plumb_test::tetrahedron(), {}, seed);
    plumb_test::Noise noise(seed);
    const std::array<double, 4> parity = parity_of(rig.setup.array);
    const double size_mps2 = std::pow(10.0, 8.0 * noise.uniform() - 2.0);
    RowUncertainty u;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const std::size_t row = 4 * i + 3, column = 4 * j + 3;  // the biases
        u.covariance[row * (row + 1) / 2 + column] = size_mps2 * size_mps2 * parity[i] * parity[j];
      }
    }
    rig.setup.array.set_uncertainty(u);
    rig.restart();
    for (int station = 0; station < 4; ++station) {
      const Verdict& v = rig.stay(random_direction(noise));
      bool variances = true;
      for (std::size_t k = 0; k < 9; k += 4) variances = variances && v.covariance[k] >= 0.0;
      below_zero += variances ? 0 : 1;
      usable += v.validity != Validity::invalid ? 1 : 0;
      EXPECT_TRUE(variances || v.validity == Validity::invalid) << seed;
      EXPECT_TRUE(variances || (v.usable & (Usable::vector | Usable::inclination | Usable::toolface)) == 0) << seed;
      EXPECT_TRUE(variances || v.alert) << seed;
    }
  }
  EXPECT_GT(below_zero, 10);
  EXPECT_GT(usable, 100);
}

// Negative: REQ-170
TEST(MonitorSetup, WithoutOneNoRequestIsTakenAndNothingIsSaid) {
  HealthMonitor none;
  none.inhibit(true);
  EXPECT_FALSE(none.request_recalibration().has_value());
  EXPECT_EQ(none.step(Sample{}).validity, Validity::invalid);
  EXPECT_EQ(none.verdict().cause, HealthMonitor().verdict().cause);
}

/// A monitor that cannot be is refused by its first use, and a snapshot does not make it one.
// Negative: REQ-170
TEST(MonitorSetup, OneThatIsRefusedIsRefusedWithASnapshotToo) {
  Rig rig(plumb_test::tetrahedron());
  const plumb_test::Bytes bytes = plumb_test::snapshot_of(rig.monitor);
  const std::vector<std::function<void(MonitorSetup&)>> wrong = {
      [](MonitorSetup& s) { s.array = SensorArray{}; },
      [](MonitorSetup& s) { s.model.size = 3; },
      [](MonitorSetup& s) { s.config.window = kWindowCapacity + 1; },
      [](MonitorSetup& s) { s.config.window = 0; },
      [](MonitorSetup& s) { s.config.alert_limit_rad = kNaN; },
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

}  // namespace
}  // namespace monitor_setup_test
