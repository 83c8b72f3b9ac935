// WGS84: geodetic places as the harmonics need them, and back.
#pragma once

#include "plumb/geomagnetic/field_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {

/// Distance from the Earth's centre, and colatitude as cosine and sine: exact at the poles.
struct Geocentric {
  double radius_m = 0.0;
  double cos_colatitude = 0.0, sin_colatitude = 0.0;
  double longitude_rad = 0.0;
};

/// WMM report, equations (7) and (8).
Geocentric geocentric_of(const Place& place) noexcept;

/// The inverse, by Bowring's formula with one correction: within 1e-6 m and 1e-12 rad from 15 km below to 850 km above.
Place geodetic_of(const Geocentric& at) noexcept;

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
struct Direction {
  double sine = 0.0, cosine = 0.0;
};
Direction direction_of_deg(double angle_deg) noexcept;

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb
