// Stand-ins with the fields of MAVLink's SYS_STATUS and HIGHRES_IMU that the adapter writes.
#pragma once

#include <cstdint>

struct mavlink_sys_status_t {
  std::uint32_t onboard_control_sensors_present;
  std::uint32_t onboard_control_sensors_enabled;
  std::uint32_t onboard_control_sensors_health;
};

struct mavlink_highres_imu_t {
  std::uint64_t time_usec;
  float xacc, yacc, zacc;  // m/s^2
  std::uint16_t fields_updated;
};
