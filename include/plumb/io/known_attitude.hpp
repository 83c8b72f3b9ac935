/// A station of a calibration log whose attitude is known from elsewhere: the only thing that shows the wirings which
/// gravity cannot see.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Of a known attitude that states none: what a tool set up by hand and the turn of the datasheet axes leave.
inline constexpr double kKnownAttitudeTolerance_deg = 5.0;
inline constexpr double kLeastTolerance_deg = 0.01, kMostTolerance_deg = 45.0;

/// Angles as plumb prints them, in the output frame.
struct KnownAttitude {
  int station = 0;  ///< counted from 1, as `plumb calibrate --verbose` lists them
  double inclination_rad = 0.0, toolface_rad = 0.0;
  double tolerance_rad = rad_from_deg(kKnownAttitudeTolerance_deg);  ///< of the direction

  /// Angles and tolerance as `parse_known_attitude` gives them.
  bool plausible() const noexcept;
  bool operator==(const KnownAttitude& o) const noexcept {
    return station == o.station && inclination_rad == o.inclination_rad && toolface_rad == o.toolface_rad &&
           tolerance_rad == o.tolerance_rad;
  }
};

/// "STATION:INCLINATION_DEG,TOOLFACE_DEG" with ",TOLERANCE_DEG" where it is not the default. The error says what is
/// wrong and how it is written.
tl::expected<KnownAttitude, std::string> parse_known_attitude(const std::string& text);

/// Where down points at that attitude, in the frame of the tool; `output_frame`: rows, from the tool's frame.
Vec3 down_of(const KnownAttitude& attitude, const Mat3& output_frame) noexcept;

/// Those of `more` that `list` does not hold yet, behind it.
void add_known(const std::vector<KnownAttitude>& more, std::vector<KnownAttitude>& list);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
