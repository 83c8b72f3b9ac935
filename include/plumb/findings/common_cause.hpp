/// Sensors of one direction on several chips that fail together: one cause explains that as well as several faults.
#pragma once

#include <cstdint>
#include <optional>

#include "plumb/health/verdict.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// What tells it.
enum class CommonSign : std::uint8_t {
  several,    ///< sensors of this direction, and no others, were excluded on two chips or more
  remaining,  ///< those of one chip were excluded, and the length of gravity was off without them
  length      ///< the length of gravity is off along this direction, and no sensor was excluded
};

struct CommonCause {
  CommonSign sign = CommonSign::several;
  SensorSet moved;   ///< excluded in the run, for good or provisionally; empty where the length alone tells it
  SensorSet others;  ///< of the same direction: the cause may have moved them, too
};

/// What a run has shown, beside its last verdict.
struct CommonEvidence {
  SensorSet excluded;                       ///< for what they read, at any time; none that hung, clipped or scattered
  bool length_off_after_exclusion = false;  ///< the sensors left agreed with each other and not with gravity
};

/// None where the array has no two sensors of one direction on different chips. Sensors that state no `package` count
/// as chips of their own.
std::optional<CommonCause> common_cause(const io::ArrayFile& array, const CommonEvidence& run, const Verdict& last);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
