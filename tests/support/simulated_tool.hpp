/// A small tool for tests of the run-time floors: known axes, known noise, faults by hand.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "plumb/array/named.hpp"
#include "plumb/health/health_monitor.hpp"
#include "support/noise.hpp"

namespace plumb_test {

/// Gravity direction in the tool frame (ISCWSA axes) at inclination and toolface in deg.
inline plumb::Vec3 direction_at(double inclination_deg, double toolface_deg) {
  const double i = plumb::rad_from_deg(inclination_deg), t = plumb::rad_from_deg(toolface_deg);
  return {-std::sin(i) * std::sin(t), -std::sin(i) * std::cos(t), std::cos(i)};
}

inline plumb::SensorArray make_array(const plumb::AxisList& axes, int n, double sigma_mps2) {
  std::array<plumb::SensorRow, plumb::kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    auto& row = rows[static_cast<std::size_t>(i)];
    row.id = plumb::make_id(("a" + std::to_string(i + 1)).c_str());
    row.axis = axes[static_cast<std::size_t>(i)];
    row.sigma_mps2 = sigma_mps2;
  }
  const auto made = plumb::SensorArray::make(rows.data(), n);
  EXPECT_TRUE(made.has_value());
  return made ? *made : plumb::SensorArray{};
}

inline plumb::SensorArray tetrahedron(double sigma_mps2 = 2e-4 * plumb::kG0_mps2) {
  plumb::AxisList axes{};
  const int n = plumb::paper_tetrahedron(axes);
  return make_array(axes, n, sigma_mps2);
}

inline plumb::SensorArray cone_array(int n, double sigma_mps2 = 2e-4 * plumb::kG0_mps2) {
  plumb::AxisList axes{};
  return make_array(axes, plumb::cone(axes, n), sigma_mps2);
}

/// A model whose raw values are already m/s^2.
inline plumb::SensorModel identity_model(int n) {
  plumb::SensorModel model;
  model.size = n;
  return model;
}

/// Steps a monitor through attitudes; `distort(i, reading, sample index)` is what sensor i says.
class Rig {
 public:
  using Distort = std::function<double(int sensor, double reading_mps2, int sample)>;

  explicit Rig(const plumb::SensorArray& array, plumb::MonitorConfig config = {}, std::uint64_t seed = 1)
      : noise_(seed) {
    setup.array = array;
    setup.model = identity_model(array.size());
    setup.gravity = {plumb::kG0_mps2, 1e-4 * plumb::kG0_mps2, plumb::GravityModel::value};
    setup.config = config;
    distort = [](int, double reading, int) { return reading; };
    restart();
  }
  void restart() { ASSERT_TRUE(monitor.configure(setup).has_value()); }

  plumb::Sample sample(const plumb::Vec3& direction, double g_mps2) {
    plumb::Sample s;
    s.time_s = time_s_ += 0.01;
    s.delivered = setup.array.all();
    s.temperature_degc = 25.0;
    for (int i = 0; i < setup.array.size(); ++i) {
      const double truth = plumb::dot(setup.array.axis(i), direction) * g_mps2;
      s.raw[static_cast<std::size_t>(i)] = distort(i, truth + setup.array.sigma_mps2(i) * noise_.normal(), index_);
    }
    ++index_;
    return s;
  }
  const plumb::Verdict& step(const plumb::Sample& s) {
    const plumb::Verdict& v = monitor.step(s);
    if (v.transition.sequence != 0) records.push_back(v.transition);
    ever_blamed = ever_blamed | v.excluded | v.provisionally_excluded;
    return v;
  }
  /// `blocks` quiet blocks at one attitude.
  const plumb::Verdict& stay(const plumb::Vec3& direction, int blocks = 1, double g_mps2 = plumb::kG0_mps2) {
    for (int k = 0; k < blocks * setup.config.window; ++k) step(sample(direction, g_mps2));
    return monitor.verdict();
  }
  /// Vibration of the whole body, rms per axis, for one block.
  const plumb::Verdict& shake(const plumb::Vec3& direction, double rms_mps2) {
    for (int k = 0; k < setup.config.window; ++k) {
      const plumb::Vec3 v = {rms_mps2 * noise_.normal(), rms_mps2 * noise_.normal(), rms_mps2 * noise_.normal()};
      const plumb::Vec3 a = plumb::plus(plumb::scaled(direction, plumb::kG0_mps2), v);
      step(sample(plumb::scaled(a, 1.0 / plumb::norm(a)), plumb::norm(a)));
    }
    return monitor.verdict();
  }
  /// Earns trust: passed blocks at three very different attitudes.
  const plumb::Verdict& prove() {
    // A healthy block is now and then above 0.7 of its limit and starts the count anew: hence the loop.
    for (int round = 0; round < 5; ++round) {
      stay(direction_at(20, 10));
      stay(direction_at(80, 130));
      stay(direction_at(60, 250));
      stay(direction_at(100, 340));
      const plumb::HealthState state = monitor.verdict().state;
      if (state == plumb::HealthState::nominal || state == plumb::HealthState::degraded_3_sensor) break;
    }
    return monitor.verdict();
  }

  plumb::MonitorSetup setup;
  plumb::HealthMonitor monitor;
  Distort distort;
  std::vector<plumb::TransitionRecord> records;
  plumb::SensorSet ever_blamed;

 private:
  Noise noise_;
  double time_s_ = 0.0;
  int index_ = 0;
};

}  // namespace plumb_test
