/// Sensors of one direction that fail together: one cause explains that as well as several faults. Temperature or
/// supply moves the same axis of all chips alike, and parity compares chips.
#pragma once

#include <cstdint>
#include <optional>

#include "plumb/array/geometry.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// What tells it.
enum class CommonSign : std::uint8_t {
  several,    ///< two or more sensors of this direction, and no others, were excluded; or two or more chips
  remaining,  ///< one was excluded, and the length of gravity was off without it
  length      ///< the length of gravity is off along this direction, and no sensor was excluded
};
const char* to_string(CommonSign sign) noexcept;

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

/// `output_frame`: rows, from the tool's frame to that of the verdict. None where no two sensors share a direction.
std::optional<CommonCause> common_cause(const SensorArray& array, const Mat3& output_frame, const CommonEvidence& run,
                                        const Verdict& last);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
