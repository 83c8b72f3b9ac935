#include "plumb/array/mirror.hpp"

#include <cstddef>

namespace plumb {
inline namespace PLUMB_ABI {

Vec3 triple_weight(const SensorArray& array, int triple, int member) noexcept {
  if (member < 0 || member > 2) return Vec3{};
  const Mat3 map = triple_map(array, triple);
  const auto column = static_cast<std::size_t>(member);
  return {map[column], map[3 + column], map[6 + column]};
}

double mirror_error(const SensorArray& array, int triple, int member, const Vec3& g) noexcept {
  const Vec3 w = triple_weight(array, triple, member);
  const double square = dot(w, w);
  return square > 0.0 ? -2.0 * dot(g, w) / square : 0.0;
}

Vec3 mirror_axis(const SensorArray& array, int triple, int member) noexcept {
  const Vec3 w = triple_weight(array, triple, member);
  const double square = dot(w, w);
  if (!(square > 0.0)) return Vec3{};
  const Vec3& h = array.axis(array.triple(triple).sensors[static_cast<std::size_t>(member)]);
  return minus(h, scaled(w, 2.0 * dot(h, w) / square));
}

}  // namespace PLUMB_ABI
}  // namespace plumb
