/// What one clock may state.
#pragma once

#include "plumb/motion/motion_clocks.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// `number`: that of the clock, for the index of the error. `period_s`: from one common instant to the next.
Expected<void> check_clock(const MotionClock& clock, int number, double period_s) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
