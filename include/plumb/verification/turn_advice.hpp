/// How the tool is to be held next, from what its sensors have read: a roll moves only sensors that are not along the
/// axis of the tool, and none of a tool that stands upright.
#pragma once

#include <string>
#include <vector>

#include "plumb/array/sensor_array.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

/// What each station of a run showed of gravity, in the tool frame [m/s^2].
struct SeenAttitudes {
  std::vector<Vec3> gravity_mps2;
  Vec3 tool_axis{};  ///< unit vector along which the inclination is 0
};

/// The reading expected of a sensor must have changed by this part of gravity before it counts as validated.
inline constexpr double kProvingShare = 0.02;

/// Sensors in service whose expected reading has not changed by so much over the stations.
SensorSet unmoved(const SensorArray& array, SensorSet in_service, const SeenAttitudes& seen);

/// Whether some roll at the attitude of the last station changes gravity by so much along a direction (tool frame,
/// unit vector).
bool roll_is_enough(const Vec3& along, double change_mps2, const SeenAttitudes& seen);

/// To validate the sensors of the last verdict, one sentence for each kind of turn that is needed.
std::vector<std::string> validating_advice(const SensorArray& array, const Verdict& last, const SeenAttitudes& seen);

/// To tell the explanations of an alarm apart.
std::string isolating_advice(const Verdict& last, const SeenAttitudes& seen);

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
