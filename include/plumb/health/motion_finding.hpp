/// What a monitor in motion tells the state machine. `HealthMonitor` needs nothing else of it: what passes one to the
/// other is health/motion_link.hpp.
#pragma once

#include "plumb/core/detail/fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Set by the host between steps; holds until set again. It counts only while the tool moves: at rest, rest decides.
struct MotionFinding {
  bool alarm = false;  ///< readings contradict each other, whoever is at fault
  SensorSet excluded;  ///< those that the monitor in motion has excluded, after its dwell

  static constexpr auto fields() noexcept { return field_list(&MotionFinding::alarm, &MotionFinding::excluded); }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
