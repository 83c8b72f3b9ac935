/// What redundant gyros find by parity alone, before anything is built: the least steady errors of one axis that
/// `RateMonitor` is sure to detect and to isolate.
#pragma once

#include <vector>

#include "plumb/array/geometry.hpp"
#include "plumb/array/sensor_array.hpp"
#include "plumb/motion/rate_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Of one axis [rad/s]; infinite where the axes cannot do it at all.
struct RateSize {
  double detected_radps = 0.0;  ///< some set of axes contradicts itself
  double isolated_radps = 0.0;  ///< every hypothesis without it is rejected, of as many units as the monitor allows for
};

/// While the tool turns at most so fast.
struct RateSizes {
  double rate_radps = 0.0;
  std::vector<RateSize> axis;
};

/// Steady errors, two blocks of `setup.block_samples[2]` samples, every other axis as far off as its bounds allow
/// (docs/theory.md, T11 and T15). Noise stays within the quantile of the monitor's false alarms. An error that changes
/// within a block, and lags, add nothing.
RateSizes rate_sizes(const SensorArray& array, const RateSetup& setup, double rate_radps);

/// All that `plumb geometry` has to say about gyros.
struct RateGeometry {
  FiguresOfMerit merit;
  int isolated_units =
      0;  ///< so many faulty units at once are isolated by parity (`motion_grade`), within `max_faults`
  RateSizes at_rest, turning;  ///< at `at_rest_radps`, at `rate_bound_radps`
};
RateGeometry study_rates(const SensorArray& array, const RateSetup& setup);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
