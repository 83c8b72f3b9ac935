#include "plumb/verification/turn_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

constexpr const char* kRollTest =
    "Where the hole does not allow that, record a roll test before the run (at least four attitudes, some tens of "
    "degrees apart in toolface and in inclination, a few blocks at rest each) and give it: plumb monitor --roll-test "
    "roll.csv.";

std::string names(SensorSet set, const SensorArray& array) {
  std::string out;
  for (int i = 0; i < array.size(); ++i) {
    if (set.has(i)) out += (out.empty() ? "" : ", ") + std::string(array.row(i).id.data());
  }
  return out;
}

/// Largest less smallest reading that the stations let expect of a sensor.
double moved_mps2(const Vec3& axis, const SeenAttitudes& seen) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Vec3& g : seen.gravity_mps2) {
    least = std::fmin(least, dot(axis, g));
    most = std::fmax(most, dot(axis, g));
  }
  return seen.gravity_mps2.empty() ? 0.0 : most - least;
}

double length_of(const SeenAttitudes& seen) {
  return seen.gravity_mps2.empty() ? kG0_mps2 : norm(seen.gravity_mps2.back());
}

/// Of the last station.
double inclination_rad(const SeenAttitudes& seen) {
  return seen.gravity_mps2.empty() ? 0.0 : angle_between_rad(seen.gravity_mps2.back(), seen.tool_axis);
}

/// Least change of the inclination that moves gravity along the axis by this part of itself, towards the side where it
/// is less.
double inclination_change_deg(double inclination_rad, double share) {
  double least = kPi;
  for (const double sign : {-1.0, 1.0}) {
    const double cosine = std::cos(inclination_rad) + sign * share;
    if (std::fabs(cosine) <= 1.0) least = std::fmin(least, std::fabs(std::acos(cosine) - inclination_rad));
  }
  return std::ceil(deg_from_rad(least));
}

}  // namespace

SensorSet unmoved(const SensorArray& array, SensorSet in_service, const SeenAttitudes& seen) {
  SensorSet out;
  for (int i = 0; i < array.size(); ++i) {
    if (in_service.has(i) && moved_mps2(array.axis(i), seen) < kProvingShare * length_of(seen)) out = out.with(i);
  }
  return out;
}

bool roll_is_enough(const Vec3& along, double change_mps2, const SeenAttitudes& seen) {
  const Vec3 across = minus(along, scaled(seen.tool_axis, dot(along, seen.tool_axis)));
  return 2.0 * std::sin(inclination_rad(seen)) * norm(across) * length_of(seen) >= change_mps2;
}

std::vector<std::string> validating_advice(const SensorArray& array, const Verdict& last, const SeenAttitudes& seen) {
  std::vector<std::string> out;
  const double proving_mps2 = kProvingShare * length_of(seen);
  SensorSet by_roll, by_inclination;
  const SensorSet still = unmoved(array, last.in_service, seen);
  for (int i = 0; i < array.size(); ++i) {
    if (!still.has(i)) continue;
    SensorSet& which = roll_is_enough(array.axis(i), proving_mps2, seen) ? by_roll : by_inclination;
    which = which.with(i);
  }
  if (!by_roll.empty())
    out.push_back(
        fmt::format("Roll the tool to another toolface and re-shoot: validation needs a change of the "
                    "reading of {} by 2 % of gravity, and a roll makes it.",
                    names(by_roll, array)));
  if (!by_inclination.empty()) {
    const double now = inclination_rad(seen);
    out.push_back(fmt::format(
        "Re-shoot at another inclination, {:.0f} deg or more away from {:.1f} deg: the reading of {} has not changed "
        "by "
        "2 % of gravity at any station, and a roll does not change it. {}",
        inclination_change_deg(now, kProvingShare), deg_from_rad(now), names(by_inclination, array), kRollTest));
  }
  if (out.empty())
    out.push_back(
        "Re-shoot, and hold the tool still for several blocks at each station: validation needs blocks in a "
        "row that agree.");
  return out;
}

std::string isolating_advice(const Verdict& last, const SeenAttitudes& seen) {
  const char* const found = "A sensor is faulty but not yet isolated. ";
  const RotationRequest& turn = last.rotation;
  const bool directed = turn.wanted && turn.change_mps2 > 0.0;
  // A roll by half a turn carries gravity to the other side of the axis.
  const bool roll = directed ? roll_is_enough(turn.along, turn.change_mps2, seen)
                             : 2.0 * std::fmin(inclination_rad(seen), kPi - inclination_rad(seen)) >= turn.angle_rad;
  if (roll) return std::string(found) + "Roll the tool to other toolfaces and re-shoot: other attitudes isolate it.";
  const bool possible = !directed || turn.change_mps2 <= 2.0 * length_of(seen);
  if (!possible)
    return std::string(found) +
           "It is too small for any turn to isolate it: change the tool, or use the output within its bound.";
  return std::string(found) +
         "Re-shoot at another inclination: a roll at this one changes too little of what the suspected sensors read.";
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
