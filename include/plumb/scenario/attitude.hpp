/// Attitude laws: where the tool points at each station. What plumb measures is the direction of
/// gravity in the tool frame (unit vector, positive down); azimuth is carried along for reports only.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/scenario/random.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// As a driller says it. ISCWSA axes: z down hole, x and y across.
struct Attitude {
  double inclination_rad = 0.0;  ///< of z against down, 0 .. pi
  double azimuth_rad = 0.0;      ///< gravity does not see it
  double toolface_rad = 0.0;     ///< gravity toolface
};

/// (-sin I sin tau, -sin I cos tau, cos I): the inverse of `tilt_of`.
Vec3 gravity_direction(const Attitude& attitude) noexcept;

/// One station only.
struct FixedAttitude {
  Vec3 direction{0.0, 0.0, 1.0};
};
/// The given directions in the given order.
struct DirectionList {
  std::vector<Vec3> directions;
};
/// Uniform on the sphere.
struct RandomStations {
  int stations = 48;
};
/// Equally spaced toolfaces, once round, at one inclination.
struct RollTest {
  double inclination_rad = rad_from_deg(90.0);
  int stations = 8;
  double first_toolface_rad = 0.0;
};
/// One station per stand: inclination builds, azimuth turns, toolface steps (plus a uniform jitter).
struct DrillingPath {
  int stations = 14;
  Attitude first{rad_from_deg(5.0), 0.0, 0.0};
  double build_rad = rad_from_deg(55.0 / 13.0);    ///< per stand
  double turn_rad = rad_from_deg(1.5);             ///< per stand
  double toolface_step_rad = rad_from_deg(137.5);  ///< per stand; the golden angle never repeats a toolface
  double toolface_jitter_rad = 0.0;                ///< uniform within +- this
};

using AttitudeLaw = std::variant<FixedAttitude, DirectionList, RandomStations, RollTest, DrillingPath>;

/// Attitude at station 0, 1, ... of a path; jitter from the stream.
Attitude attitude_at(const DrillingPath& path, int station, const Stream& stream) noexcept;

/// Gravity direction at every station. Refuses, with a remedy, laws without stations, directions that
/// are not of unit length and numbers that are not finite.
tl::expected<std::vector<Vec3>, std::string> directions_of(const AttitudeLaw& law, std::uint64_t seed);

/// Way between two attitudes along the great circle; between opposite ones across an arbitrary but
/// fixed direction.
class Passage {
 public:
  Passage(const Vec3& from, const Vec3& to) noexcept;
  /// Unit vector at part 0 .. 1 of the way, starting and ending at rest (smoothstep).
  Vec3 at(double part) const noexcept;
  double angle_rad() const noexcept { return angle_rad_; }
  /// Unit vector that what stands still on the ground turns about, by `angle_rad`.
  Vec3 axis() const noexcept { return cross(from_, across_); }
  /// Part of the angle at a part of the time.
  static double smooth(double part) noexcept { return part * part * (3.0 - 2.0 * part); }

 private:
  Vec3 from_;
  Vec3 across_;
  double angle_rad_ = 0.0;
};

/// The tool turns about an axis of its own at a constant rate for a while, on top of the attitude law, and keeps the
/// angle that it has then. What starting and stopping accelerate is omitted.
struct Turning {
  double rate_radps = 0.0;
  Vec3 axis{0.0, 0.0, 1.0};  ///< unit vector, tool frame
  double from_s = 0.0;       ///< on the log's own time axis
  double until_s = std::numeric_limits<double>::infinity();

  bool at_work(double time_s) const noexcept { return rate_radps != 0.0 && time_s >= from_s && time_s < until_s; }
  double angle_rad(double time_s) const noexcept;
};

/// What the vector becomes in the frame of a tool that has turned by the angle about the unit axis.
Vec3 seen_from_turned(const Vec3& vector, const Vec3& axis, double angle_rad) noexcept;

/// A unit vector perpendicular to the given one: the same for the same input everywhere.
Vec3 perpendicular_to(const Vec3& unit) noexcept;

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
