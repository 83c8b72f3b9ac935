/// What is wrong with a ULog, told without drowning the listener (private to src/logs).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "plumb/core/config.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

enum class UlogTrouble : std::uint8_t {
  header,
  flags,
  appended,
  message,
  format,
  subscription,
  unknown_id,
  data_size,
  lacking,
  value,
  time,
  device,
  parameter,
  count_of_these,
};

/// The same kind of trouble is told at most five times; the rest is counted and summed up at the end.
class UlogNotes {
 public:
  static constexpr std::uint32_t kMost = 5;

  explicit UlogNotes(LogSink& sink) : sink_(sink) {}

  /// False where the sentence would not be told: it need not be put together.
  bool wanted(UlogTrouble trouble, std::uint64_t offset);
  /// Only after `wanted` of the same trouble.
  void say(std::uint64_t offset, const std::string& what) { sink_.note(offset, what); }
  void sum_up();

 private:
  struct Tally {
    std::uint64_t seen = 0;
    std::uint64_t last_offset = 0;
  };
  LogSink& sink_;
  std::array<Tally, static_cast<std::size_t>(UlogTrouble::count_of_these)> tallies_{};
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
