/// What can be wrong with a DataFlash log (private to src/logs).
#pragma once

#include <cstdint>

#include "log_notes.hpp"
#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

enum class DataflashTrouble : std::uint8_t {
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

const char* words_of(DataflashTrouble trouble) noexcept;

using DataflashNotes = LogNotes<DataflashTrouble>;

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
