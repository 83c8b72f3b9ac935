// plumb's verdict in the three bit masks of MAVLink's SYS_STATUS. Only the accelerometer's bit is touched; those of
// other sensors stay as they are. Health is a subset of enabled, enabled of present: what is switched off is never
// healthy.
//
//   present  the array has sensors          enabled  at least three of them are in service
//   health   the vector is valid (or degraded, where you accept that nothing checks it), not held, not unconfirmed
#pragma once

#include <cmath>
#include <cstdint>

#include "plumb/health/verdict.hpp"

namespace plumb_mavlink {

inline constexpr std::uint32_t kAccelerometer = 0x02;  // MAV_SYS_STATUS_SENSOR_3D_ACCEL

template <class SysStatus>
void fill(SysStatus& out, const plumb::Verdict& v, bool accept_degraded = false) {
  const auto put = [](std::uint32_t& mask, bool on) { mask = on ? mask | kAccelerometer : mask & ~kAccelerometer; };
  bool healthy = v.validity == plumb::Validity::valid || (accept_degraded && v.validity == plumb::Validity::degraded);
  for (const double x : v.gravity_mps2) healthy = healthy && std::isfinite(x);
  const bool enabled = v.in_service.size() >= 3;
  put(out.onboard_control_sensors_present, !v.configured.empty());
  put(out.onboard_control_sensors_enabled, enabled);
  put(out.onboard_control_sensors_health, enabled && healthy);
}

}  // namespace plumb_mavlink
