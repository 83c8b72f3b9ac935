#include "ros_notes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

const char* words_of(RosTrouble trouble) noexcept {
  switch (trouble) {
    case RosTrouble::record: return "records that could not be read";
    case RosTrouble::chunk: return "chunks that could not be read";
    case RosTrouble::channel: return "topics that contradict themselves";
    case RosTrouble::unknown: return "messages of channels that are not described";
    case RosTrouble::not_read: return "topics that are not read here";
    case RosTrouble::message: return "messages that are no sensor_msgs/msg/Imu";
    case RosTrouble::value: return "readings that are not numbers, or not measured";
    case RosTrouble::stamp: return "headers without a time";
    case RosTrouble::time: return "times that go back";
    case RosTrouble::count: break;
  }
  return "";
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
