#include "ellipsoid.hpp"

#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {
namespace {

constexpr double kSemiMajor_m = 6378137.0;
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kEccentricitySquared = kFlattening * (2.0 - kFlattening);

}  // namespace

Direction direction_of_deg(double angle_deg) noexcept {
  const double quarters = std::nearbyint(angle_deg / 90.0);
  const double rest_rad = rad_from_deg(angle_deg - 90.0 * quarters);
  const double s = std::sin(rest_rad), c = std::cos(rest_rad);
  switch (static_cast<int>(quarters) & 3) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

Geocentric geocentric_of(const Place& place) noexcept {
  const Direction latitude = direction_of_deg(place.latitude_deg);
  const double normal_m = kSemiMajor_m / std::sqrt(1.0 - kEccentricitySquared * latitude.sine * latitude.sine);
  const double equatorial_m = (normal_m + place.height_m) * latitude.cosine;
  const double polar_m = (normal_m * (1.0 - kEccentricitySquared) + place.height_m) * latitude.sine;
  Geocentric out;
  out.radius_m = std::hypot(equatorial_m, polar_m);
  out.cos_colatitude = polar_m / out.radius_m;
  out.sin_colatitude = equatorial_m / out.radius_m;
  out.longitude_rad = rad_from_deg(place.longitude_deg);
  return out;
}

Place geodetic_of(const Geocentric& at) noexcept {
  const double equatorial_m = at.radius_m * at.sin_colatitude, polar_m = at.radius_m * at.cos_colatitude;
  const double semi_minor_m = kSemiMajor_m * (1.0 - kFlattening);
  const double second = kEccentricitySquared / (1.0 - kEccentricitySquared);
  double reduced =
      std::atan2(kSemiMajor_m * polar_m * (1.0 + second * semi_minor_m / at.radius_m), semi_minor_m * equatorial_m);
  double latitude = 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    const double s = std::sin(reduced), c = std::cos(reduced);
    latitude = std::atan2(polar_m + second * semi_minor_m * s * s * s,
                          equatorial_m - kEccentricitySquared * kSemiMajor_m * c * c * c);
    reduced = std::atan2((1.0 - kFlattening) * std::sin(latitude), std::cos(latitude));
  }
  const double s = std::sin(latitude), c = std::cos(latitude);
  const double root = std::sqrt(1.0 - kEccentricitySquared * s * s);
  Place out;
  out.latitude_deg = deg_from_rad(latitude);
  out.longitude_deg = deg_from_rad(at.longitude_rad);
  out.height_m = equatorial_m * c + polar_m * s - kSemiMajor_m * root;
  return out;
}

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb
