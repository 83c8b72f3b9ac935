/// Where the hole goes, by minimum curvature.
#pragma once

#include <vector>

#include "plumb/io/file_error.hpp"
#include "plumb/survey/angle.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

struct PathStation {
  double md_m = 0.0;
  double inclination_rad = 0.0;
  bool azimuth_known = true;  ///< false for a tool that cannot be told from vertical: it is taken to be vertical
  double azimuth_rad = 0.0;
};

struct PathPoint {
  double md_m = 0.0;
  double north_m = 0.0, east_m = 0.0, tvd_m = 0.0;
  double dogleg_rad = 0.0;          ///< between this station and the one before
  double dogleg_deg_per_30m = 0.0;  ///< 0 at the first
};

/// Positions from the first station, which is the origin at its own measured depth as true vertical depth. North is
/// that of the azimuths. Arcs between the tangents of neighbouring stations (minimum curvature):
///   half = asin sqrt(sin^2((I2 - I1) / 2) + sin I1 sin I2 sin^2((A2 - A1) / 2)), half the dogleg
///   step = (MD2 - MD1) / 2 (t1 + t2) tan(half) / half
/// with tan(x) / x by its series below 0.01, so that straight holes lose no digits.
/// Refuses: fewer than one station, what is not finite, inclinations outside of 0 to 180 degrees, a measured depth that
/// does not increase, an azimuth that is missing where the inclination is above 5 degrees, and a dogleg of 180 degrees
/// (within 1e-6), for which no arc is the shortest.
io::FileExpected<std::vector<PathPoint>> minimum_curvature(const std::vector<PathStation>& stations);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
