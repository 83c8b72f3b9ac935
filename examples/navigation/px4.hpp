// plumb's verdict as PX4's uORB message SensorsStatusImu, for an array made of up to four triads (one accelerometer
// chip each). An instance is healthy where all three of its axes are in service; a chip loses its place with its first
// axis, although plumb goes on with the other two.
//
// accel_inconsistency_m_s_s is the distance of an instance to the mean of all in PX4. Here it is the distance to
// plumb's vector: a faulty chip moves a mean, and a healthy one may be the farthest from it. Both are specific force,
// as PX4's accelerometers read (upwards at rest). It is zero for the primary, as in PX4. Where there is no vector to
// compare with it is `kUnknown_mps2`.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/health/verdict.hpp"

namespace plumb_px4 {

/// Beyond what may be armed with (COM_ARM_IMU_ACC, 0.7 by default; keep it below 1), and nothing that the selector of
/// EKF2 adds up (EKF2_SEL_IMU_ACC, 1 by default; keep it there or above): nobody is blamed. Infinity would blame one
/// chip and for ever, NaN nobody and let it be armed.
inline constexpr float kUnknown_mps2 = 1.0F;

struct Instance {
  std::uint32_t device_id = 0;        // 0: this place is empty
  std::uint8_t priority = 50;         // as configured: 1 ... 100; 0: switched off
  plumb::SensorSet axes;              // the sensors of the array that are on this chip
  plumb::Vec3 specific_force_mps2{};  // what the driver of this chip reads, in plumb's output frame

  bool present() const { return device_id != 0 && priority != 0 && !axes.empty(); }
};

template <class SensorsStatusImu>
void fill(SensorsStatusImu& out, const plumb::Verdict& v, const std::array<Instance, 4>& instances) {
  const bool good = v.validity == plumb::Validity::valid || v.validity == plumb::Validity::degraded;
  const bool has_time = v.time_s > 0.0 && v.time_s < 1e13;  // microseconds in 64 bits; a broken clock has none
  out.timestamp = has_time ? static_cast<std::uint64_t>(v.time_s * 1e6) : 0;
  out.accel_device_id_primary = 0;
  std::uint8_t best = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Instance& chip = instances[i];
    const bool there = chip.present();
    const bool healthy = there && v.validity != plumb::Validity::invalid && v.in_service.contains(chip.axes) &&
                         (v.suspects & chip.axes).empty();
    const double distance = plumb::norm(plumb::plus(chip.specific_force_mps2, v.gravity_mps2));  // f - (-g)
    out.accel_device_ids[i] = there ? chip.device_id : 0;
    out.accel_healthy[i] = healthy;
    out.accel_priority[i] = !there ? std::uint8_t{0} : healthy ? chip.priority : std::uint8_t{1};  // 1: last resort
    out.accel_inconsistency_m_s_s[i] = !there                   ? 0.0F
                                       : good && distance < 1e4 ? static_cast<float>(distance)
                                                                : kUnknown_mps2;
    if (healthy && chip.priority > best) {
      best = chip.priority;
      out.accel_device_id_primary = chip.device_id;
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (best != 0 && out.accel_device_ids[i] == out.accel_device_id_primary) out.accel_inconsistency_m_s_s[i] = 0.0F;
  }
}

}  // namespace plumb_px4
