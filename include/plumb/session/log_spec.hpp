/// Which log is read, and how.
#pragma once

#include <string>

#include "plumb/core/config.hpp"
#include "plumb/io/log_reader.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

struct LogSpec {
  std::string path;  ///< "-" = standard input
  io::BadRowPolicy on_bad_row = io::BadRowPolicy::stop;
  bool follow = false;  ///< at the end wait for more
  bool hash = false;    ///< of its bytes, into `LogStatistics::hash`
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
