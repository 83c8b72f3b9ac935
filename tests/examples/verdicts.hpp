/// Verdicts for the adapters: every one of a run through a failure, and one made by hand.
#pragma once

#include <memory>
#include <vector>

#include "navigation/body.hpp"

namespace example_test {

/// The run of examples/navigation: a body moves by steps, the second accelerometer dies at 30 s.
inline const std::vector<plumb::Verdict>& run() {
  static const std::vector<plumb::Verdict> all = [] {
    std::vector<plumb::Verdict> out;
    const auto monitor = std::make_unique<plumb::HealthMonitor>();
    Body body(30.0);
    if (!monitor->configure(body.setup())) return out;
    for (int k = 0; k < 6000; ++k) out.push_back(monitor->step(body.next()));
    return out;
  }();
  return all;
}

/// Nominal, valid, four sensors, gravity along +z: what is at fault in a test is set there.
inline plumb::Verdict good() {
  plumb::Verdict v;
  v.time_s = 12.25;
  v.age_s = 0.0;
  v.state = plumb::HealthState::nominal;
  v.validity = plumb::Validity::valid;
  v.cause = plumb::Cause::passed_block;
  v.tick = true;
  v.configured = v.in_service = plumb::SensorSet::first(4);
  v.gravity_mps2 = {0.1, -0.2, 9.8};
  v.covariance = {1e-6, 1e-7, 0, 1e-7, 2e-6, 0, 0, 0, 3e-6};
  v.usable = 0x1FF;
  v.protection_available = true;
  v.alert = false;
  v.protection_level_housing_rad = 1e-3;
  return v;
}

inline constexpr plumb::Validity kAllValidities[] = {plumb::Validity::valid, plumb::Validity::degraded,
                                                     plumb::Validity::unconfirmed, plumb::Validity::held,
                                                     plumb::Validity::invalid};

}  // namespace example_test
