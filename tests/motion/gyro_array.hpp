/// A rigid body that turns smoothly, and what gyro axes on it read, for tests.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

#include "motion/rigid_motion.hpp"
#include "plumb/motion/rate_monitor.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

inline plumb::RateSetup rate_setup() {
  plumb::RateSetup out;
  out.errors.fill({0.01, 0.005, 0.005, 50e-6, 1e-4});
  return out;
}

struct GyroArray {
  plumb::SensorArray array;
  plumb::RateSetup setup;
  Noise noise;
  SmoothVector turning;
  std::array<plumb::RateErrors, plumb::kCapacity> error{};  ///< signed
  std::array<plumb::Vec3, plumb::kCapacity> axis{};         ///< added to the axis
  plumb::RateMonitor monitor;
  bool at_rest = false;
  plumb::Vec3 creep_radps{};  ///< while it is said to be at rest
  std::function<void(plumb::RateSample&)> distort = [](plumb::RateSample&) {};
  plumb::SensorSet ever_isolated, ever_excluded;
  double worst_ratio = 0.0;  ///< of the error of the rate to its bound
  int bounded = 0, judged = 0;

  GyroArray(const plumb::SensorArray& axes, const plumb::RateSetup& stated, std::uint64_t seed, double rate_radps = 4.0)
      : array(axes), setup(stated), noise(seed), turning(noise, rate_radps, 0.5 * rate_radps, 0.2, 10.0) {
    EXPECT_TRUE(monitor.configure(array, setup).has_value());
    for (std::size_t k = 0; k < static_cast<std::size_t>(array.size()); ++k) {
      const plumb::RateErrors& e = setup.errors[k];
      error[k] = {drawn(e.scale), 0.0, drawn(e.bias_radps), drawn(e.lag_s), drawn(e.g_sensitivity_s_per_m)};
      const plumb::Vec3 across = plumb::cross(array.axis(static_cast<int>(k)), random_direction(noise));
      axis[k] = plumb::scaled(across, drawn(e.axis_rad) / plumb::norm(across));
    }
  }
  double drawn(double bound) { return bound * (2.0 * noise.uniform() - 1.0); }
  plumb::Vec3 rate(double t) const { return at_rest ? creep_radps : turning.at(t); }

  plumb::RateSample sample(std::uint64_t number) {
    plumb::RateSample out;
    out.time_s = static_cast<double>(number) * setup.sample_period_s;
    out.delivered = array.all();
    out.force_mps2 = at_rest ? 9.81 : 20.0;
    out.at_rest = at_rest;
    for (int i = 0; i < array.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double y = plumb::dot(plumb::plus(array.axis(i), axis[k]), rate(out.time_s + error[k].lag_s));
      out.rate_radps[k] = (1.0 + error[k].scale) * y + error[k].bias_radps +
                          error[k].g_sensitivity_s_per_m * out.force_mps2 + array.sigma_mps2(i) * noise.normal();
    }
    return out;
  }
  void check_rate(const plumb::AngularRate& found) {
    if (found.validity != plumb::ForceValidity::bounded) return;
    ++bounded;
    const double error_radps = plumb::norm(plumb::minus(found.rate_radps, rate(found.time_s)));
    worst_ratio = std::fmax(worst_ratio, error_radps / found.bound_radps);
  }
  void turn(std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t k = from; k < to; ++k) {
      plumb::RateSample s = sample(k);
      distort(s);
      const plumb::RateVerdict& v = monitor.step(s);
      ++judged;
      ever_isolated = ever_isolated | v.isolated;
      ever_excluded = ever_excluded | v.excluded;
      check_rate(v.sample);
    }
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb_test
