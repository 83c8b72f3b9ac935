// Any bytes as a bag of ROS 2 (MCAP).
#include "flight_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  fuzz::Listener listener(size);
  listener.judge(plumb::logs::read_mcap(file.path(), listener));
  return 0;
}
