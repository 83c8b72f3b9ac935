// Any bytes as a log of the paper's tool, under both policies for bad rows: what is delivered is in order and finite
// where it must be, what is not is counted and named.
#include "log_reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  fuzz::read_under(file.path(), plumb::io::BadRowPolicy::stop);
  fuzz::read_under(file.path(), plumb::io::BadRowPolicy::skip);
  return 0;
}
