// Stand-in with the fields of MAVLink's SYS_STATUS that the adapter writes.
#pragma once

#include <cstdint>

struct mavlink_sys_status_t {
  std::uint32_t onboard_control_sensors_present;
  std::uint32_t onboard_control_sensors_enabled;
  std::uint32_t onboard_control_sensors_health;
};
