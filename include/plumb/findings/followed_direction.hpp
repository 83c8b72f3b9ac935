/// Whether the temperature of the stations goes with their attitude, so that a fit cannot tell the two apart.
#pragma once

#include <vector>

#include "plumb/calibration/observability.hpp"
#include "plumb/core/sample.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// The direction whose component of gravity says the temperature of the stations; axis 0 where none does, or where
/// nothing was estimated over temperature.
struct FollowedDirection {
  char axis = 0;  ///< 'x', 'y' or 'z' of the tool frame
  double correlation = 0.0;
};
FollowedDirection followed_direction(int order, const std::vector<Station>& stations,
                                     const std::vector<SeenAttitude>& attitudes);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
