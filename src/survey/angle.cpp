#include "plumb/survey/angle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/numeric/tails.hpp"
#include "plumb/survey/attitude.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

double protection_level_rad(const Angle& angle, double integrity_risk) noexcept {
  if (!(integrity_risk > 0.0)) return kPi;
  const double sigmas = integrity_risk < 1.0 ? normal_tail_quantile(0.5 * integrity_risk) : 0.0;
  const double bound = sigmas * angle.sigma_rad + angle.bias_rad;
  return bound < kPi ? bound : kPi;
}

const char* to_string(North north) noexcept {
  switch (north) {
    case North::magnetic: return "magnetic";
    case North::true_north: return "true";
    case North::grid: return "grid";
  }
  return "?";
}

double full_turn_rad(double rad) noexcept {
  const double rest = std::fmod(rad, 2.0 * kPi);
  const double turned = rest < 0.0 ? rest + 2.0 * kPi : rest;
  return turned < 2.0 * kPi ? turned : 0.0;
}

std::string Undefined::text() const {
  switch (why) {
    case NoAngle::not_finite: return "a component is no finite number";
    case NoAngle::no_gravity: return "gravity has no length";
    case NoAngle::vertical:
      return fmt::format("the tool is within {:.3f} deg of vertical, and {:.0f} sigma of its tilt are {:.3f} deg",
                         deg_from_rad(found), kUndefinedWithinSigmas, deg_from_rad(limit));
    case NoAngle::no_horizontal:
      return fmt::format("the horizontal field is {:.0f} nT, and {:.0f} sigma of it are {:.0f} nT", found * 1e9,
                         kUndefinedWithinSigmas, limit * 1e9);
    case NoAngle::across_field:
      return fmt::format("the field across the tool is {:.0f} nT, and {:.0f} sigma of it are {:.0f} nT", found * 1e9,
                         kUndefinedWithinSigmas, limit * 1e9);
    case NoAngle::gravity_failed: return "gravity failed its check";
    case NoAngle::field_failed: return "the magnetic field failed its checks";
    case NoAngle::no_declination: return "the reference states no declination";
    case NoAngle::no_convergence: return "no meridian convergence was given";
  }
  return "?";
}

OrUndefined<TrueAzimuth> true_azimuth(const MagneticAzimuth& azimuth, const geomagnetic::FieldReference& reference) {
  if (!reference.declination_known) return tl::unexpected<Undefined>(Undefined{NoAngle::no_declination, 0.0, 0.0});
  TrueAzimuth out{azimuth.angle};
  out.angle.rad = full_turn_rad(azimuth.angle.rad + reference.declination_rad);
  out.angle.sigma_rad = std::hypot(azimuth.angle.sigma_rad, std::hypot(reference.declination_rad_sigma.common,
                                                                       reference.declination_rad_sigma.random));
  return out;
}

OrUndefined<GridAzimuth> grid_azimuth(const TrueAzimuth& azimuth, const Convergence& convergence) {
  if (!convergence.known) return tl::unexpected<Undefined>(Undefined{NoAngle::no_convergence, 0.0, 0.0});
  GridAzimuth out{azimuth.angle};
  out.angle.rad = full_turn_rad(azimuth.angle.rad - convergence.rad);
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
