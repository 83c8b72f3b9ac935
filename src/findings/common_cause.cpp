#include "plumb/findings/common_cause.hpp"

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// A bias within 20 deg of a direction lies along it.
const double kAlong = std::cos(rad_from_deg(20.0));

/// The sensors that lie along the direction of any of these.
SensorSet alike_of(const SensorArray& array, SensorSet sensors) noexcept {
  SensorSet out;
  for (int i = 0; i < array.size(); ++i) {
    if (sensors.has(i)) out = out | of_direction(array, array.all(), array.axis(i));
  }
  return out;
}

}  // namespace

const char* to_string(CommonSign sign) noexcept {
  switch (sign) {
    case CommonSign::several: return "several_excluded";
    case CommonSign::remaining: return "length_off_after_exclusion";
    case CommonSign::length: return "length_off";
  }
  return "";
}

std::optional<CommonCause> common_cause(const SensorArray& array, const Mat3& output_frame, const CommonEvidence& run,
                                        const Verdict& last) {
  const SensorSet moved = run.excluded;
  if (!moved.empty()) {
    // A chip is excluded with all of its axes, whichever the cause has moved.
    const SensorUnits& units = array.units();
    const SensorSet alike =
        units.grouped() ? alike_of(array, moved) : of_direction(array, array.all(), array.axis(moved.lowest()));
    if (!alike.contains(moved) || alike.size() < 2) return std::nullopt;
    const bool share = units.count(of_direction(array, moved, array.axis(moved.lowest()))) > 1;
    if (units.count(moved) > 1 && !share) return std::nullopt;
    if (share) return CommonCause{CommonSign::several, moved, alike - moved};
    if (run.length_off_after_exclusion && alike != moved)
      return CommonCause{CommonSign::remaining, moved, alike - moved};
    return std::nullopt;
  }
  const Vec3& bias = last.norm_mismatch.bias_mps2;  // output frame
  const bool told = last.norm_mismatch.kind == NormMismatchKind::common_bias && norm(bias) > 0.0;
  for (int i = 0; told && i < array.size(); ++i) {
    const Vec3 axis = times(output_frame, array.axis(i));
    if (std::fabs(dot(axis, bias)) < kAlong * norm(bias)) continue;
    const SensorSet alike = of_direction(array, array.all(), array.axis(i));
    if (alike.size() > 1) return CommonCause{CommonSign::length, {}, alike};
  }
  return std::nullopt;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
