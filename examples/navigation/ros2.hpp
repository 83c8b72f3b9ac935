// plumb's verdict as ROS 2 messages: sensor_msgs/Imu and diagnostic_msgs/DiagnosticStatus. Templates: they take the
// generated types and, in the tests, stand-ins of the same fields.
//
// Signs: Imu.linear_acceleration is specific force (REP 145), at rest upwards with the length of g; plumb's vector is
// gravity, downwards: the adapter negates it. Axes (REP 103, x forward, y left, z up) are those of
// MonitorSetup::output_frame, which you set. A vector that may not be used is marked by -1 in element 0 of its
// covariance, as Imu.msg asks, and is zero, which no filter takes for gravity.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "plumb/array/sensor_array.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb_ros2 {

/// May the vector enter a filter: `valid`, or `degraded` where the user accepts that nothing checks it.
inline bool believed(const plumb::Verdict& v, bool accept_degraded) {
  bool finite = true;
  for (const double x : v.gravity_mps2) finite = finite && std::isfinite(x);
  for (const double x : v.covariance) finite = finite && std::isfinite(x);
  const bool good =
      v.validity == plumb::Validity::valid || (accept_degraded && v.validity == plumb::Validity::degraded);
  return good && finite && v.covariance[0] > 0.0;
}

/// Stamped with the block that gave the vector: publish where `verdict.tick` is set. Rates are yours to fill in.
template <class Imu>
void fill(Imu& out, const plumb::Verdict& v, const std::string& frame_id, bool accept_degraded = false) {
  const bool good = believed(v, accept_degraded);
  double stamp_s = std::isfinite(v.age_s) ? v.time_s - v.age_s : v.time_s;
  if (!(std::fabs(stamp_s) < 2147483647.0)) stamp_s = 0.0;  // of a broken clock; no cast says what becomes of it
  const double whole_s = std::floor(stamp_s);
  out.header.frame_id = frame_id;
  out.header.stamp.sec = static_cast<std::int32_t>(whole_s);
  out.header.stamp.nanosec = static_cast<std::uint32_t>(std::fmin((stamp_s - whole_s) * 1e9, 999999999.0));
  out.orientation_covariance[0] = -1.0;       // yaw does not show in gravity
  out.angular_velocity_covariance[0] = -1.0;  // no gyro here
  out.linear_acceleration.x = good ? -v.gravity_mps2[0] : 0.0;
  out.linear_acceleration.y = good ? -v.gravity_mps2[1] : 0.0;
  out.linear_acceleration.z = good ? -v.gravity_mps2[2] : 0.0;
  for (std::size_t i = 0; i < 9; ++i) out.linear_acceleration_covariance[i] = good ? v.covariance[i] : 0.0;
  if (!good) out.linear_acceleration_covariance[0] = -1.0;
}

/// OK: valid with all sensors. WARN: usable with less, or not confirmed. STALE: an old vector. ERROR: none.
template <class Status>
void fill_status(Status& out, const plumb::Verdict& v, const plumb::SensorArray& array) {
  switch (v.validity) {
    case plumb::Validity::valid: out.level = v.in_service == v.configured ? Status::OK : Status::WARN; break;
    case plumb::Validity::degraded:
    case plumb::Validity::unconfirmed: out.level = Status::WARN; break;
    case plumb::Validity::held: out.level = Status::STALE; break;
    case plumb::Validity::invalid: out.level = Status::ERROR; break;
  }
  if (v.state == plumb::HealthState::failed) out.level = Status::ERROR;
  out.message = std::string(plumb::to_string(v.state)) + ": " + plumb::to_string(v.cause);
  out.values.clear();
  const auto tell = [&out](std::string key, std::string value) {
    out.values.emplace_back();
    out.values.back().key = std::move(key);
    out.values.back().value = std::move(value);
  };
  char number[32];
  std::snprintf(number, sizeof number, "%.6g", v.statistic);
  tell("statistic", number);
  std::snprintf(number, sizeof number, "%.6g", v.limit);
  tell("limit", number);
  tell("validity", plumb::to_string(v.validity));
  for (int i = 0; i < array.size(); ++i) {  // those left out are told too
    if (v.in_service.has(i)) continue;
    tell(array.row(i).id.data(), plumb::to_string(v.sensor_cause[static_cast<std::size_t>(i)]));
  }
}

}  // namespace plumb_ros2
