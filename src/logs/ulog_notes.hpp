/// What can be wrong with a ULog (private to src/logs).
#pragma once

#include <cstdint>

#include "log_notes.hpp"
#include "plumb/core/config.hpp"

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
  count
};

const char* words_of(UlogTrouble trouble) noexcept;

using UlogNotes = LogNotes<UlogTrouble>;

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
