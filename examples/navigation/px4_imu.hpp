// The force that plumb publishes in motion as the accelerometer half of PX4's uORB message VehicleImu: one more
// instance for EKF2, without the chips that are isolated. delta_angle and what belongs to it are yours, over the same
// interval.
#pragma once

#include "in_flight.hpp"

namespace plumb_px4 {

/// `out` is the message published last. False: do not publish; the force has no bound, no instant, or was there
/// before. EKF2 sees the gap in the stamps.
///
/// The mean of two samples (or blocks), times the time between them, is the velocity gained between them (the trapezoid
/// of PX4's integrator). Its end is `timestamp_sample`, as EKF2 takes it; the instant of the force is half of it
/// earlier. Sensors at full scale are never in the force: nothing in it is clipped.
template <class VehicleImu>
bool fill(VehicleImu& out, const plumb::SpecificForce& f) {
  const std::uint64_t end_us = plumb_flight::microseconds(f.time_s + 0.5 * f.span_s);
  const double span_us = f.span_s * 1e6 + 0.5;
  const bool bounded = f.validity == plumb::ForceValidity::bounded && std::isfinite(f.bound_mps2);
  if (!bounded || !plumb_flight::has_force(f) || !(span_us >= 1.0 && span_us < 65536.0)) return false;
  if (end_us <= out.timestamp_sample) return false;
  out.timestamp = out.timestamp_sample = end_us;
  for (std::size_t i = 0; i < 3; ++i) out.delta_velocity[i] = static_cast<float>(f.force_mps2[i] * f.span_s);
  out.delta_velocity_dt = static_cast<std::uint16_t>(span_us);
  out.delta_velocity_clipping = 0;
  return true;
}

}  // namespace plumb_px4
