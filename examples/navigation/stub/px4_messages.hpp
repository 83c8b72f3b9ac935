// Stand-in with the accelerometer fields of PX4's uORB message SensorsStatusImu (msg/SensorsStatusImu.msg).
#pragma once

#include <cstdint>

struct sensors_status_imu_s {
  std::uint64_t timestamp;  // us since start
  std::uint32_t accel_device_id_primary;
  std::uint32_t accel_device_ids[4];
  float accel_inconsistency_m_s_s[4];
  bool accel_healthy[4];
  std::uint8_t accel_priority[4];
};
