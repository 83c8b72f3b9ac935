/// What can be wrong with a bag of ROS 2 (private to src/logs).
#pragma once

#include <cstdint>

#include "log_notes.hpp"
#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

enum class RosTrouble : std::uint8_t {
  record,    ///< of MCAP, or a row of SQLite
  chunk,     ///< one that cannot be unpacked, or whose check sum is wrong
  channel,   ///< a channel or topic that contradicts itself or another
  unknown,   ///< a message of a channel that was not described
  not_read,  ///< a topic of an IMU in a type or an encoding that is not read here
  message,   ///< one that is no sensor_msgs/msg/Imu
  value,     ///< a reading that is no number, or that the driver says it has not
  stamp,     ///< a header without a time
  time,      ///< time goes back
  count
};

const char* words_of(RosTrouble trouble) noexcept;

using RosNotes = LogNotes<RosTrouble>;

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
