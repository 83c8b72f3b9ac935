/// How a set of directions lies against another one. The only source of the host libraries that needs a singular value
/// decomposition: its templates cost seconds of compile time.
#pragma once

#include "plumb/array/sensor_array.hpp"
#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Orthogonal 3x3 matrix, row by row.
using Turn = std::array<Vec3, 3>;

enum class Hand { kept, free };  ///< a rotation, or a mirror image too

/// Wahba's problem: the turn that brings directions nearest to others, in the sense of least squares, by the singular
/// value decomposition of the sum of their outer products.
class BestTurn {
 public:
  void add(const Vec3& onto, const Vec3& from) noexcept;
  Turn find(Hand hand) const;

 private:
  std::array<Vec3, 3> sum_{};
};

Vec3 turned(const Turn& turn, const Vec3& direction) noexcept;

/// The least singular value of the matrix whose rows are the axes: 0 where they lie in one plane.
double least_singular_value(const SensorArray& array);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
