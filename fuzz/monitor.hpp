/// The monitor that the harnesses of snapshot and step start from: the paper's four axes, trusted by 12 stations.
#pragma once

#include <vector>

#include "common.hpp"
#include "plumb/array/named.hpp"

namespace fuzz {

inline plumb::MonitorSetup four_sensors() {
  plumb::MonitorSetup setup;
  plumb::AxisList axes{};
  plumb::SensorRow rows[4];
  const int n = plumb::paper_tetrahedron(axes);
  const char* const ids[] = {"a1", "a2", "a3", "a4"};
  for (std::size_t i = 0; i < 4; ++i) rows[i] = {plumb::make_id(ids[i]), axes[i], 2e-3};
  const auto array = plumb::SensorArray::make(rows, n);
  demand(array.has_value(), "the paper's axes make an array");
  setup.array = *array;
  setup.model.size = n;
  setup.config.window = 4;  // blocks end often
  setup.config.recalibrate_after_exclusion = true;
  return setup;
}

inline plumb::Sample sample_at(const plumb::MonitorSetup& setup, double time_s, const plumb::Vec3& g_mps2) {
  plumb::Sample s;
  s.time_s = time_s;
  s.delivered = setup.array.all();
  s.temperature_degc = 25.0;
  for (int i = 0; i < setup.array.size(); ++i)
    s.raw[static_cast<std::size_t>(i)] = plumb::dot(setup.array.axis(i), g_mps2);
  return s;
}

/// Trusted: it has agreed with itself at a dozen attitudes.
inline const plumb::HealthMonitor& trusted_monitor() {
  static const plumb::HealthMonitor trusted = [] {
    const plumb::MonitorSetup setup = four_sensors();
    plumb::HealthMonitor monitor;
    demand(monitor.configure(setup).has_value(), "the setup is taken");
    double time_s = 0.0;
    for (int station = 0; station < 12; ++station) {
      const double turn = 0.7 * station, tilt = 0.4 + 0.2 * station;
      const plumb::Vec3 g = {9.80665 * std::sin(tilt) * std::cos(turn), 9.80665 * std::sin(tilt) * std::sin(turn),
                             9.80665 * std::cos(tilt)};
      for (int k = 0; k < 16; ++k) demand_sound(monitor.step(sample_at(setup, time_s += 0.01, g)));
    }
    demand(monitor.verdict().state == plumb::HealthState::nominal, "the harness starts from trust");
    return monitor;
  }();
  return trusted;
}

}  // namespace fuzz
