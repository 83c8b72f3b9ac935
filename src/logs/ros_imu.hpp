/// The message sensor_msgs/msg/Imu in CDR, as ROS 2 stores it (private to src/logs).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "plumb/core/config.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

/// https://docs.ros.org/en/rolling/p/sensor_msgs/msg/Imu.html. What its driver says it does not measure is NaN.
struct RosImu {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string_view frame_id;  ///< in the bytes that were read
  Axes rate_radps = kAbsentAxes;
  Axes specific_force_mps2 = kAbsentAxes;
  Axes variance_m2ps4 = kAbsentAxes;  ///< of the specific force, where the driver declares one
  bool has_force = true;
};

/// OMG DDSI-RTPS 2.5, 10.2: four bytes say byte order and version, alignment counts behind them. The reason where the
/// bytes are no such message; empty where they are.
std::string_view parse_ros_imu(const unsigned char* bytes, std::size_t size, RosImu& out) noexcept;

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
