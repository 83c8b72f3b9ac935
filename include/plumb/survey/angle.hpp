/// Angles with what is known of their errors, and azimuths that cannot be taken for those from another north.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "plumb/core/config.hpp"
#include "plumb/geomagnetic/field_reference.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

struct Angle {
  double rad = 0.0;
  double sigma_rad = 0.0;  ///< of the Gaussian part
  double bias_rad = 0.0;   ///< bound of the part that is no distribution
};

/// How far the true angle can be, but with probability `integrity_risk` (0 to 1): the two-sided quantile times sigma,
/// plus the bound of the bias, pi at the most. Linear in the errors, as sigma is.
double protection_level_rad(const Angle& angle, double integrity_risk) noexcept;

enum class North : std::uint8_t { magnetic, true_north, grid };
const char* to_string(North north) noexcept;  ///< "magnetic", "true", "grid"

/// Azimuth from one north, clockwise, 0 to 2 pi.
template <North N>
struct AzimuthFrom {
  static constexpr North north = N;
  Angle angle;
};
using MagneticAzimuth = AzimuthFrom<North::magnetic>;
using TrueAzimuth = AzimuthFrom<North::true_north>;
using GridAzimuth = AzimuthFrom<North::grid>;

enum class NoAngle : std::uint8_t {
  not_finite,      ///< a component is NaN or infinite
  no_gravity,      ///< of no length
  vertical,        ///< the tool cannot be told from vertical: `found_rad` from it, limit `limit_rad`
  no_horizontal,   ///< the horizontal field cannot be told from none: found and limit in tesla
  across_field,    ///< as above for the field across the tool (magnetic toolface)
  gravity_failed,  ///< the check of gravity's length failed
  field_failed,    ///< a check of the field failed
  no_declination,  ///< the reference states none
  no_convergence,  ///< none was given
};

/// Why there is no angle, with what was found and what would have been enough.
struct Undefined {
  NoAngle why = NoAngle::not_finite;
  double found = 0.0;
  double limit = 0.0;

  /// "the tool is within 0.02 deg of vertical, which its uncertainty (5 sigma: 0.15 deg) does not tell from it".
  std::string text() const;
};

template <class T>
using OrUndefined = tl::expected<T, Undefined>;

/// Declination from magnetic to true north, with its own sigma added.
OrUndefined<TrueAzimuth> true_azimuth(const MagneticAzimuth& azimuth, const geomagnetic::FieldReference& reference);

/// Meridian convergence: from true to grid north, east positive. Of a map: exact.
struct Convergence {
  bool known = false;
  double rad = 0.0;
};
OrUndefined<GridAzimuth> grid_azimuth(const TrueAzimuth& azimuth, const Convergence& convergence);

/// Into 0 to 2 pi.
double full_turn_rad(double rad) noexcept;

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
