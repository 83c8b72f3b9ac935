// Stand-ins with the fields of sensor_msgs/Imu and diagnostic_msgs/DiagnosticStatus, for a machine without ROS 2. A
// test compiles the same adapter against the types that rosidl generates, where Debian's rosidl is installed.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ros2_stub {

struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};
struct Header {
  Time stamp;
  std::string frame_id;
};
struct Vector3 {
  double x = 0.0, y = 0.0, z = 0.0;
};
struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};
struct Imu {
  Header header;
  Quaternion orientation;
  std::array<double, 9> orientation_covariance{};
  Vector3 angular_velocity;
  std::array<double, 9> angular_velocity_covariance{};
  Vector3 linear_acceleration;
  std::array<double, 9> linear_acceleration_covariance{};
};
struct KeyValue {
  std::string key, value;
};
struct DiagnosticStatus {
  static constexpr unsigned char OK = 0, WARN = 1, ERROR = 2, STALE = 3;
  unsigned char level = 0;
  std::string name, message, hardware_id;
  std::vector<KeyValue> values;
};

}  // namespace ros2_stub
