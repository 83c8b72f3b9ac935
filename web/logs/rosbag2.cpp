// A bag of ROS 2 in SQLite is left to the tool: SQLite would be half as large again as all of the page.
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

io::FileExpected<LogExtent> read_rosbag2(const std::string& path, LogSink&) {
  return tl::make_unexpected(io::FileError{path, 0, "",
                                           "is a bag of ROS 2 in SQLite (.db3), which the page does not read",
                                           "give it to plumb review, or record as MCAP"});
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
