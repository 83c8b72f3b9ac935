/// Small MCAP files, and what they tell, for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mcap_bytes.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ros_bytes.hpp"
#include "told.hpp"

namespace mcap_told {

using namespace plumb;
using namespace plumb::logs;
using namespace logs_told;
using namespace mcap_bytes;
using ros_bytes::Cdr;

inline io::FileExpected<LogExtent> read_bytes(const std::string& bytes, Told& told) {
  const LogFile file(bytes);
  return read_mcap(file.path(), told);
}

inline Told told_of(const std::string& bytes) {
  Told out;
  const auto extent = read_bytes(bytes, out);
  EXPECT_TRUE(extent.has_value()) << extent.error().text();
  return out;
}

/// Messages of one IMU, outside of chunks.
inline std::string bag_of(const std::vector<std::string>& messages) {
  std::string out = header() + described();
  for (const std::string& one : messages) out += message(1, one);
  return out + data_end() + footer();
}

}  // namespace mcap_told
