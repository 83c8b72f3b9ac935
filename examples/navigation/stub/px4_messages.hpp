// Stand-ins with the accelerometer fields of PX4's uORB messages msg/SensorsStatusImu.msg, msg/SensorSelection.msg and
// msg/VehicleImu.msg.
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

struct sensor_selection_s {
  std::uint64_t timestamp;  // us since start
  std::uint32_t accel_device_id;
  std::uint32_t gyro_device_id;
};

struct vehicle_imu_s {
  std::uint64_t timestamp;         // us since start
  std::uint64_t timestamp_sample;  // end of the integration
  std::uint32_t accel_device_id;
  std::uint32_t gyro_device_id;
  float delta_angle[3];     // rad
  float delta_velocity[3];  // m/s, FRD
  std::uint16_t delta_angle_dt;
  std::uint16_t delta_velocity_dt;  // us
  std::uint8_t delta_angle_clipping;
  std::uint8_t delta_velocity_clipping;
};
