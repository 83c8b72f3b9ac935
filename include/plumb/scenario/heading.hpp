/// Where north is at each station, and how fast the tool turns on its way: what magnetometers and gyros feel of an
/// attitude law, and accelerometers do not.
#pragma once

#include <cstdint>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/scenario/attitude.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// Unit vector towards north, level, in the tool frame; the azimuth is counted from it. ISCWSA axes.
Vec3 north_direction(const Attitude& attitude) noexcept;

/// One way between two stations: down goes along the great circle, and the tool turns about down besides, alike smooth.
class Headings {
 public:
  Headings() = default;
  /// `directions`: of down at the stations of the law. A path and a roll test state the azimuth; random stations have
  /// one of their own each; fixed and listed ones begin with any, and the tool turns the shortest way to the next.
  Headings(const AttitudeLaw& law, const std::vector<Vec3>& directions, std::uint64_t seed);

  /// At `part` 0 .. 1 of the way behind station `station`, counted from 0.
  Vec3 north(std::size_t station, double part) const noexcept;
  /// Of the tool against the ground, in the tool frame, where the way takes `move_s`; zero at rest.
  Vec3 rate_radps(std::size_t station, double part, double move_s) const noexcept;

 private:
  struct Way {
    Passage passage;
    double heading_rad = 0.0;  ///< about down, beside the passage
  };
  std::vector<Vec3> north_;
  std::vector<Way> ways_;
};

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
