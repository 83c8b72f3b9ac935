// Six skewed gyro axes in motion: one sticks and is excluded, and the rate of the others has a bound.
#include <cstdio>

#include "plumb/array/named.hpp"
#include "plumb/motion/rate_monitor.hpp"

int main() {
  const char* const names[] = {"g1", "g2", "g3", "g4", "g5", "g6"};
  plumb::AxisList axes{};
  plumb::SensorRow rows[6];
  plumb::cone(axes, 6);
  for (std::size_t i = 0; i < 6; ++i) rows[i] = {plumb::make_id(names[i]), axes[i], 0.002};  // rad/s of noise
  plumb::RateSetup setup;
  setup.errors.fill({0.01, 0.005, 0.005, 50e-6, 0.0});  // scale, axis, bias, lag, g-sensitivity
  static plumb::RateMonitor monitor;
  if (!monitor.configure(*plumb::SensorArray::make(rows, 6), setup)) return 1;
  plumb::RateSample s;
  s.delivered = plumb::SensorSet::first(6);
  for (int k = 0; k < 3000 && monitor.step(s).excluded.empty(); s.time_s = 0.001 * ++k)
    for (std::size_t i = 0; i < 6; ++i)  // the fourth sticks after a second
      if (i != 3 || k < 1000) s.rate_radps[i] = plumb::dot(axes[i], plumb::Vec3{2.0 * s.time_s, 1.0, -1.5});
  std::printf("axis 4 excluded: %s, %.3f s after it stuck; the rate of the others is off by at most %.3f rad/s\n",
              monitor.verdict().excluded.has(3) ? "yes" : "no", s.time_s - 1.0, monitor.verdict().sample.bound_radps);
}
