/// A smooth motion with a monitor on board, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "motion/rigid_motion.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

/// A flight with a monitor on board; `distort` is what happens between the two.
struct Flight {
  plumb::SensorArray array;
  plumb::MotionSetup setup;
  RigidMotion motion;
  plumb::MotionMonitor monitor;
  std::function<void(plumb::MotionSample&)> distort = [](plumb::MotionSample&) {};
  plumb::SensorSet ever_isolated, ever_excluded;
  double isolated_at_s = -1.0;
  double worst_ratio = 0.0;  ///< of force error to bound
  int bounded = 0, samples = 0;

  Flight(const plumb::SensorArray& sensors, const plumb::MotionSetup& motion_setup_, std::uint64_t seed)
      : array(sensors), setup(motion_setup_), motion(array, setup, seed) {
    EXPECT_TRUE(monitor.configure(array, setup).has_value());
  }
  void check_force(const plumb::SpecificForce& force) {
    if (force.validity != plumb::ForceValidity::bounded) return;
    ++bounded;
    const double error = plumb::norm(plumb::minus(force.force_mps2, motion.force(force.time_s)));
    worst_ratio = std::max(worst_ratio, error / force.bound_mps2);
  }
  void fly(std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t k = from; k < to; ++k) {
      plumb::MotionSample s = motion.sample(k);
      distort(s);
      const plumb::MotionVerdict& v = monitor.step(s);
      ++samples;
      ever_isolated = ever_isolated | v.isolated;
      ever_excluded = ever_excluded | v.excluded;
      if (!v.isolated.empty() && isolated_at_s < 0.0) isolated_at_s = s.time_s;
      check_force(v.sample);
    }
  }
};

inline void add_bias_from(Flight& flight, double onset_s, int sensor, double bias_mps2) {
  flight.distort = [=](plumb::MotionSample& s) {
    if (s.time_s >= onset_s) s.reading_mps2[static_cast<std::size_t>(sensor)] += bias_mps2;
  };
}

/// Short arms: without a gyro the rotation adds little.
inline plumb::MotionSetup slow_setup(int n, std::uint64_t seed) {
  plumb::MotionSetup setup = motion_setup(n, seed);
  for (plumb::Vec3& arm : setup.lever_arm_m) arm = plumb::scaled(arm, 0.1);
  return setup;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_test
