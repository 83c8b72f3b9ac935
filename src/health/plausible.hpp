/// Whether what was read back can be the state of a monitor: what its parts alone cannot answer.
#pragma once

#include "plumb/health/detail/monitor_state.hpp"
#include "plumb/health/monitor_setup.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// In service, provisionally excluded, excluded and absent partition the array (property S4).
bool sets_are_plausible(const MonitorState& state) noexcept;
/// The coefficients in force, and how they can have come about.
bool calibration_is_plausible(const MonitorState& state, const MonitorSetup& setup) noexcept;
/// The mode goes with the sensors in service, the calibration and the fit.
bool mode_is_plausible(const MonitorState& state) noexcept;
/// What was published last must follow from what is remembered: it is what the host reads until the next step.
bool verdict_is_plausible(const MonitorState& state, const Verdict& v) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
