// plumb's verdict in motion as PX4's uORB messages: `SensorsStatusImu`, which the selector of EKF2 and the arming
// checks read, and `SensorSelection`, which the module `sensors` follows (SENS_IMU_MODE 0). The axes are those of the
// array file: write it in FRD.
#pragma once

#include <algorithm>

#include "in_flight.hpp"
#include "px4.hpp"

namespace plumb_px4 {

/// Least that is published of a faulty chip: the selector's sum (default limit 2 m/s) is full after 21 ms.
inline constexpr float kFaulty_mps2 = 100.0F;

/// Chip minus force, with the low pass that PX4's voter has over the same: 0.95 of the last, 0.05 of the new.
using Differences = std::array<plumb::Vec3, 4>;

/// The chip to fly on. The current one while nothing is told against it; else a healthy one, of the highest priority;
/// where nobody is, the current one unless it is faulty; else none (0).
inline std::uint32_t primary_of(std::uint32_t current, const std::array<Instance, 4>& chips,
                                const std::array<plumb_flight::Told, 4>& told) {
  std::uint32_t best = 0, kept = 0;
  std::uint8_t highest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool clear = told[i] == plumb_flight::Told::healthy || told[i] == plumb_flight::Told::unchecked;
    const bool is_current = chips[i].device_id == current && chips[i].present();
    if (is_current && clear) return current;
    if (is_current && told[i] != plumb_flight::Told::faulty) kept = current;
    if (clear && chips[i].priority > highest) highest = chips[i].priority, best = chips[i].device_id;
  }
  return best != 0 ? best : kept;
}

/// `out` is the message published last. Without a force its stamp stays, for nothing new was measured.
/// `chips`: their specific force at the instant of the force, the mean of the same two samples.
template <class SensorsStatusImu>
void fill(SensorsStatusImu& out, Differences& differences_mps2, const plumb::MotionVerdict& v,
          const std::array<Instance, 4>& chips) {
  using plumb_flight::Told;
  std::array<Told, 4> told{};
  const bool force = plumb_flight::has_force(v.sample);
  if (force) out.timestamp = plumb_flight::microseconds(v.sample.time_s);
  for (std::size_t i = 0; i < 4; ++i) {
    const bool there = chips[i].present();
    told[i] = there ? plumb_flight::told(v, chips[i].axes) : Told::unknown;
    const plumb::Vec3 apart = plumb::minus(chips[i].specific_force_mps2, v.sample.force_mps2);
    plumb::Vec3& filtered = differences_mps2[i];
    if (there && force && plumb::norm(apart) < plumb_flight::kMost_mps2)
      filtered = plumb::plus(plumb::scaled(filtered, 0.95), plumb::scaled(apart, 0.05));
    const float distance = static_cast<float>(plumb::norm(filtered));
    out.accel_device_ids[i] = there ? chips[i].device_id : 0;
    out.accel_healthy[i] = told[i] == Told::healthy;
    out.accel_priority[i] = !there ? std::uint8_t{0} : out.accel_healthy[i] ? chips[i].priority : std::uint8_t{1};
    out.accel_inconsistency_m_s_s[i] = !there                     ? 0.0F
                                       : told[i] == Told::faulty  ? std::max(distance, kFaulty_mps2)
                                       : told[i] == Told::healthy ? std::min(distance, kUnknown_mps2)
                                                                  : kUnknown_mps2;
  }
  out.accel_device_id_primary = primary_of(out.accel_device_id_primary, chips, told);
}

/// `out` is the selection published last; true: publish it again, the chip is another. The gyro is left as it is.
template <class SensorSelection, class SensorsStatusImu>
bool select(SensorSelection& out, const SensorsStatusImu& status) {
  if (status.accel_device_id_primary == 0 || status.accel_device_id_primary == out.accel_device_id) return false;
  out.timestamp = status.timestamp;
  out.accel_device_id = status.accel_device_id_primary;
  return true;
}

}  // namespace plumb_px4
