// Read a verdict: what the vector is worth first, then the vector and its bound.
#include <cstdio>

#include "plumb/health/health_monitor.hpp"

int main() {
  const plumb::Vec3 axes[] = {{0.8, 0.0, 0.6}, {0.0, 0.8, 0.6}, {-0.8, 0.0, 0.6}, {0.0, -0.8, 0.6}};
  const char* const ids[] = {"a1", "a2", "a3", "a4"};
  plumb::SensorRow rows[4];
  for (std::size_t i = 0; i < 4; ++i) rows[i] = {plumb::make_id(ids[i]), axes[i], 0.002};  // noise [m/s^2]
  static plumb::MonitorSetup setup;
  static plumb::HealthMonitor monitor;
  setup.array = *plumb::SensorArray::make(rows, 4);
  setup.model.size = 4;  // scale 1, bias 0: raw values are m/s^2 along the axes
  if (!monitor.configure(setup)) return 1;
  for (int k = 0; k < 32; ++k) {  // one block at rest: gravity along z
    plumb::Sample sample{0.01 * k, {}, setup.array.all()};
    for (std::size_t i = 0; i < 4; ++i) sample.raw[i] = 9.80665 * axes[i][2] + (k % 2 == 0 ? 0.002 : -0.002);
    monitor.step(sample);
  }
  const plumb::Verdict& v = monitor.verdict();
  std::printf("%s, %s: %.3f m/s^2 along z\n", to_string(v.validity), to_string(v.cause), v.gravity_mps2[2]);
}
