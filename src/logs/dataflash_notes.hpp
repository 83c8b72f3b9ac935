/// What a reader of a DataFlash log has to say of its bytes, without a damaged log filling the screen.
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

enum class Trouble : std::uint8_t {
  passed_over,    ///< bytes that are no message
  unknown_type,   ///< a message that no FMT describes
  bad_format,     ///< an FMT that contradicts itself
  redefined,      ///< an FMT that contradicts an earlier one
  unit,           ///< a unit or multiplier that is not the usual one
  clock,          ///< time goes back
  no_number,      ///< a reading that is infinite or not a number
  bad_instance,   ///< an instance that cannot be
  bad_parameter,  ///< a parameter without a name that can be one
  count
};

class DataflashNotes {
 public:
  explicit DataflashNotes(LogSink& sink) : sink_(sink) {}
  /// Counts a trouble, and says whether it shall be noted still: a caller writes the sentence only then.
  bool wants(Trouble trouble, std::uint64_t offset) noexcept;
  void say(std::uint64_t offset, const std::string& what) { sink_.note(offset, what); }
  /// How many were left out, kind by kind.
  void sum_up();

 private:
  struct Tally {
    std::uint64_t seen = 0;
    std::uint64_t first_untold = 0;
  };
  LogSink& sink_;
  std::array<Tally, static_cast<std::size_t>(Trouble::count)> tallies_{};
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
