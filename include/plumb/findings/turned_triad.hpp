/// A triad of sensors at right angles that is mounted turned, or whose axes are named in another frame (NED, ENU): a
/// signed permutation of its three channels, which is a turn by 90, 120 or 180 deg or a mirror image.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "plumb/array/sensor_array.hpp"
#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/sample.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Channel k of the triad carries `sign[k]` times its sensor `source[k]`, 0 to 2.
struct TurnedTriad {
  std::array<int, 3> sensor{};  ///< of the array
  std::array<int, 3> source{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};

  bool operator==(const TurnedTriad& o) const { return sensor == o.sensor && source == o.source && sign == o.sign; }
};

/// Three sensors whose axes lie at right angles, within 10 deg each: three in a row of one `package`, wherever they
/// stand in the file, or of the sensors that state none. `package`: of each sensor, empty = not stated; may be empty.
std::vector<std::array<int, 3>> triads_of(const SensorArray& array, const std::vector<std::string>& package);

/// The 23 turns and 24 mirror images that a triad may be mounted in by mistake; of these the turns first.
std::vector<TurnedTriad> turns_of(const std::array<int, 3>& triad);

/// Whether it keeps the handedness: a turn, no mirror image.
bool is_turn(const TurnedTriad& turned) noexcept;

/// Its axis, in units of the triad's own axes, and the angle; of a turn only.
struct AxisAngle {
  std::array<int, 3> axis{};
  int deg = 0;
};
AxisAngle axis_of(const TurnedTriad& turned) noexcept;

/// The direction that channel k measures, if it is so: what the array file should say.
Vec3 mended_axis(const SensorArray& array, const TurnedTriad& turned, int k) noexcept;

/// The station with its channels where their sensors are.
void put_right(const TurnedTriad& turned, const Datasheet& datasheet, Station& station) noexcept;

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
