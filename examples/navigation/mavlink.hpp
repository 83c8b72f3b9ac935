// plumb's verdict in the three bit masks of MAVLink's SYS_STATUS, and the force in motion as HIGHRES_IMU. Only what is
// the accelerometers' is touched; bits and fields of other sensors stay as they are. Health is a subset of enabled,
// enabled of present: what is switched off is never healthy.
//
//   present  the array has sensors          enabled  at least three of them are in service
//   health   the vector is valid (or degraded, where you accept that nothing checks it), not held, not unconfirmed;
//            in motion: the force is bounded (or unchecked, where you accept that)
#pragma once

#include "in_flight.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb_mavlink {

inline constexpr std::uint32_t kAccelerometer = 0x02;      // MAV_SYS_STATUS_SENSOR_3D_ACCEL
inline constexpr std::uint16_t kAccelerationFields = 0x7;  // HIGHRES_IMU_UPDATED_XACC, YACC, ZACC

template <class SysStatus>
void put(SysStatus& out, bool present, bool enabled, bool healthy) {
  const auto set = [](std::uint32_t& mask, bool on) { mask = on ? mask | kAccelerometer : mask & ~kAccelerometer; };
  set(out.onboard_control_sensors_present, present);
  set(out.onboard_control_sensors_enabled, present && enabled);
  set(out.onboard_control_sensors_health, present && enabled && healthy);
}

template <class SysStatus>
void fill(SysStatus& out, const plumb::Verdict& v, bool accept_degraded = false) {
  bool healthy = v.validity == plumb::Validity::valid || (accept_degraded && v.validity == plumb::Validity::degraded);
  for (const double x : v.gravity_mps2) healthy = healthy && std::isfinite(x);
  put(out, !v.configured.empty(), v.in_service.size() >= 3, healthy);
}

/// In motion. `in_service`: the sensors that the monitor was given (`set_in_service`), all of the array at first.
template <class SysStatus>
void fill(SysStatus& out, const plumb::MotionVerdict& v, plumb::SensorSet in_service, bool accept_unchecked = false) {
  const plumb_flight::Told told = plumb_flight::told(v);
  const bool healthy =
      told == plumb_flight::Told::healthy || (accept_unchecked && told == plumb_flight::Told::unchecked);
  put(out, !in_service.empty(), (in_service - v.isolated - v.excluded).size() >= 3, healthy);
}

/// The force in motion, stamped with its instant. False: not bounded; the three fields are marked as not updated, and
/// zero, so that who overlooks the mark sees free fall and not a plausible lie.
template <class HighresImu>
bool fill(HighresImu& out, const plumb::MotionVerdict& v) {
  const bool good = plumb_flight::told(v) == plumb_flight::Told::healthy;
  out.time_usec = good ? plumb_flight::microseconds(v.sample.time_s) : out.time_usec;
  out.xacc = good ? static_cast<float>(v.sample.force_mps2[0]) : 0.0F;
  out.yacc = good ? static_cast<float>(v.sample.force_mps2[1]) : 0.0F;
  out.zacc = good ? static_cast<float>(v.sample.force_mps2[2]) : 0.0F;
  out.fields_updated = static_cast<std::uint16_t>(good ? out.fields_updated | kAccelerationFields
                                                       : out.fields_updated & ~kAccelerationFields);
  return good;
}

}  // namespace plumb_mavlink
