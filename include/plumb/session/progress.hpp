/// How far the reading of a log has come, for who waits for it.
#pragma once

#include <cstdint>
#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// A line of progress on standard error, only where that is a terminal; it is wiped at the end.
class Progress {
 public:
  explicit Progress(const std::string& what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void at(std::uint64_t rows, double time_s);

 private:
  std::string what_;
  bool shown_ = false;
  bool on_terminal_;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
