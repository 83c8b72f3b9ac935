#include "plumb/scenario/heading.hpp"

#include <cmath>

#include "plumb/scenario/portable_math.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// The vector turned by the angle about the unit axis.
Vec3 turned_about(const Vec3& vector, const Vec3& axis, double angle_rad) noexcept {
  return seen_from_turned(vector, axis, -angle_rad);
}

/// From one vector to the other about the unit axis that both are perpendicular to, -pi .. pi.
double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) noexcept {
  const double across = dot(axis, cross(from, to));
  const double angle = portable_angle(dot(from, to), std::abs(across));
  return across < 0.0 ? -angle : angle;
}

Vec3 made_level(const Vec3& vector, const Vec3& down) noexcept {
  const Vec3 out = minus(vector, scaled(down, dot(vector, down)));
  return scaled(out, 1.0 / norm(out));
}

/// By station; empty: the tool turns the shortest way.
struct StatedNorth {
  const std::vector<Vec3>& directions;
  std::uint64_t seed;

  std::vector<Vec3> operator()(const FixedAttitude&) const { return {}; }
  std::vector<Vec3> operator()(const DirectionList&) const { return {}; }
  std::vector<Vec3> operator()(const RandomStations&) const {
    const Stream stream(seed, Purpose::attitude, 1);
    std::vector<Vec3> out;
    for (const Vec3& down : directions)
      out.push_back(turned_about(perpendicular_to(down), down, stream.uniform(out.size(), -kPi, kPi)));
    return out;
  }
  std::vector<Vec3> operator()(const RollTest& law) const {
    std::vector<Vec3> out;
    for (int k = 0; k < law.stations; ++k)
      out.push_back(north_direction({law.inclination_rad, 0.0, law.first_toolface_rad + 2.0 * kPi * k / law.stations}));
    return out;
  }
  std::vector<Vec3> operator()(const DrillingPath& law) const {
    const Stream stream(seed, Purpose::attitude);
    std::vector<Vec3> out;
    for (int k = 0; k < law.stations; ++k) out.push_back(north_direction(attitude_at(law, k, stream)));
    return out;
  }
};

}  // namespace

Vec3 north_direction(const Attitude& attitude) noexcept {
  const SinCos inclination = portable_sincos(attitude.inclination_rad), azimuth = portable_sincos(attitude.azimuth_rad),
               toolface = portable_sincos(attitude.toolface_rad);
  // Of the high side, of what is on its right, and of the axis of the tool.
  const double high = inclination.cos * azimuth.cos, right = -azimuth.sin, along = inclination.sin * azimuth.cos;
  return {high * toolface.sin - right * toolface.cos, high * toolface.cos + right * toolface.sin, along};
}

Headings::Headings(const AttitudeLaw& law, const std::vector<Vec3>& directions, std::uint64_t seed) {
  north_ = std::visit(StatedNorth{directions, seed}, law);
  const bool stated = !north_.empty();
  if (!stated) north_.push_back(perpendicular_to(directions.front()));
  for (std::size_t k = 0; k + 1 < directions.size(); ++k) {
    const Passage passage(directions[k], directions[k + 1]);
    const Vec3 carried = made_level(turned_about(north_[k], passage.axis(), passage.angle_rad()), directions[k + 1]);
    if (!stated) north_.push_back(carried);
    ways_.push_back({passage, angle_about(directions[k + 1], carried, north_[k + 1])});
  }
}

Vec3 Headings::north(std::size_t station, double part) const noexcept {
  if (part <= 0.0 || station >= ways_.size()) return north_[station];
  const Way& way = ways_[station];
  const double smooth = Passage::smooth(part);
  const Vec3 carried = turned_about(north_[station], way.passage.axis(), way.passage.angle_rad() * smooth);
  return turned_about(carried, way.passage.at(part), way.heading_rad * smooth);
}

Vec3 Headings::rate_radps(std::size_t station, double part, double move_s) const noexcept {
  if (part <= 0.0 || station >= ways_.size() || !(move_s > 0.0)) return {};
  const Way& way = ways_[station];
  const double per_s = 6.0 * part * (1.0 - part) / move_s;
  // What stands still on the ground turns the other way in the tool.
  return plus(scaled(way.passage.axis(), -per_s * way.passage.angle_rad()),
              scaled(way.passage.at(part), -per_s * way.heading_rad));
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
