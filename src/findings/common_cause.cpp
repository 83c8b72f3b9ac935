#include "plumb/findings/common_cause.hpp"

#include <cmath>
#include <set>
#include <string>

#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// Axes within 10 deg of one line are one direction; a bias within 20 deg of it lies along it.
const double kOneDirection = std::cos(rad_from_deg(10.0));
const double kAlong = std::cos(rad_from_deg(20.0));

SensorSet of_direction(const SensorArray& array, const Vec3& axis) {
  SensorSet out;
  for (int i = 0; i < array.size(); ++i) {
    if (std::fabs(dot(array.axis(i), axis)) >= kOneDirection) out = out.with(i);
  }
  return out;
}

bool on_several_chips(const io::ArrayFile& array, SensorSet set) {
  std::set<std::string> chips;
  for (int i = 0; i < array.array.size(); ++i) {
    if (!set.has(i)) continue;
    const std::string package = io::package_of(array, i);
    chips.insert(package.empty() ? "#" + std::to_string(i) : package);
  }
  return chips.size() > 1;
}

}  // namespace

std::optional<CommonCause> common_cause(const io::ArrayFile& array, const CommonEvidence& run, const Verdict& last) {
  const SensorSet moved = run.excluded;
  if (!moved.empty()) {
    const SensorSet alike = of_direction(array.array, array.array.axis(moved.lowest()));
    if (!alike.contains(moved) || !on_several_chips(array, alike)) return std::nullopt;
    if (on_several_chips(array, moved)) return CommonCause{CommonSign::several, moved, alike - moved};
    if (run.length_off_after_exclusion) return CommonCause{CommonSign::remaining, moved, alike - moved};
    return std::nullopt;
  }
  const Vec3& bias = last.norm_mismatch.bias_mps2;
  const bool told = last.norm_mismatch.kind == NormMismatchKind::common_bias && norm(bias) > 0.0;
  for (int i = 0; told && i < array.array.size(); ++i) {
    const Vec3 axis = times(array.output_frame, array.array.axis(i));  // the bias is in that frame
    if (std::fabs(dot(axis, bias)) < kAlong * norm(bias)) continue;
    const SensorSet alike = of_direction(array.array, array.array.axis(i));
    if (on_several_chips(array, alike)) return CommonCause{CommonSign::length, {}, alike};
  }
  return std::nullopt;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
