/// From [[clock]] of an array file to the clocks of a monitor of motion (private to this module).
#pragma once

#include <optional>

#include "plumb/io/log_writer.hpp"
#include "plumb/session/motion_plan.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// `setup`: before `with_clocks`. What no [[clock]] names is on the clock of the log, which is without error.
ClockPlan clock_plan_of(const io::ArrayFile& array, const MotionSetup& setup);

/// Makes array and set-up of `plan` those that its clocks feed; or why they cannot be, and nothing has changed.
std::optional<io::FileError> apply_clocks(const io::ArrayFile& array, MotionPlan& plan);

/// Rows per sample of a sensor, at most, where every row holds a new sample of some chip; 1 of what has no [[clock]].
double rows_per_sample(const io::ArrayFile& array, int sensor) noexcept;

/// The time by `clock` at a common one: what `MotionClocks` turns back.
double stamp_of(const MotionClock& clock, double common_s) noexcept;
double common_time_of(const MotionClock& clock, double stamp_s) noexcept;

/// What the clocks of the chips say at a common time, where all are as stated: for a log in which nothing moves.
io::ClockTimes shown_by_clocks(const io::ArrayFile& array, double common_s) noexcept;

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
