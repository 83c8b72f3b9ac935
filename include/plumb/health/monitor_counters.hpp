/// What was not used, and why.
#pragma once

#include <cstdint>

#include "plumb/core/detail/fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct MonitorCounters {
  std::uint32_t samples = 0;          ///< offered
  std::uint32_t time_refused = 0;     ///< time not finite or not increasing
  std::uint32_t gaps = 0;             ///< longer than the longest gap, or no channel at all
  std::uint32_t temperature_out = 0;  ///< outside the calibrated span and its margin, or not finite
  std::uint32_t moving_blocks = 0;
  std::uint32_t rotating_blocks = 0;

  static constexpr auto fields() noexcept {
    using C = MonitorCounters;
    return field_list(&C::samples, &C::time_refused, &C::gaps, &C::temperature_out, &C::moving_blocks,
                      &C::rotating_blocks);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
