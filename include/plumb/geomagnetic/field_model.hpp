/// The Earth's main magnetic field at a place and a date, from spherical harmonics.
///
/// Equations: World Magnetic Model, technical report (Chulliat et al., NOAA NCEI and BGS; WMM2025: doi
/// 10.25923/prbc-s316), section 1.2, equations (4) to (19). The crust, the ionosphere and currents of space are not in
/// it: `error_model.hpp` says what that costs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "plumb/core/vec3.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {

inline constexpr int kMaxDegree = 12;
/// Gauss coefficients of degree 1 to 12, n (n + 1) / 2 + m - 1 that of degree n and order m.
inline constexpr std::size_t kCoefficientCount = 90;
constexpr std::size_t coefficient_index(int degree, int order) noexcept {
  return static_cast<std::size_t>(degree * (degree + 1) / 2 + order - 1);
}

/// Schmidt semi-normalised Gauss coefficients in nT, their change in nT per year, and when they hold.
struct FieldModel {
  std::string name;  ///< "WMM-2025"
  double epoch_year = 0.0;
  double first_year = 0.0, last_year = 0.0;  ///< validity, decimal years, both ends included
  std::array<double, kCoefficientCount> g_nt{}, h_nt{}, g_nt_per_year{}, h_nt_per_year{};
};

/// WMM2025: epoch 2025.0, valid to 2030.0. NOAA's and BGS' coefficients are in the public domain; the table here was
/// taken from the npm package geomagnetism 0.2.0 (Apache-2.0, NOTICE).
const FieldModel& wmm2025();

/// On the WGS84 ellipsoid.
struct Place {
  double latitude_deg = 0.0;   ///< geodetic, -90 to 90
  double longitude_deg = 0.0;  ///< east positive, -180 to 360
  double height_m = 0.0;       ///< above the ellipsoid, below it negative; the geoid is within 110 m of it: 3 nT
};

/// WMM states its accuracy from 1 km below the ellipsoid to 850 km above it.
inline constexpr double kLowestStated_m = -1000.0, kHighest_m = 850e3;
/// A well goes deeper. The sources of the main field lie in the core, 2900 km down, so that the series holds below
/// ground as it does above: the field grows by 3/a of itself a metre, 25 nT a kilometre. What the crust adds is in no
/// degree of the model, above ground or below.
inline constexpr double kLowest_m = -15e3;

/// What stands in the way of taking the declination for granted.
enum class FieldZone : std::uint8_t {
  usual,
  caution,   ///< horizontal field below 6000 nT: compasses may become unreliable (WMM report, caution zone)
  blackout,  ///< below 2000 nT: declination is not to be used (WMM report, blackout zone)
};
const char* to_string(FieldZone zone) noexcept;

/// Field in geodetic axes north, east, down [tesla], and angles [rad].
struct FieldElements {
  Vec3 ned_tesla{};
  double horizontal_tesla = 0.0, total_tesla = 0.0;
  double dip_rad = 0.0;          ///< inclination of the field, down positive, -pi/2 to pi/2
  double declination_rad = 0.0;  ///< of the horizontal field from true north, east positive, -pi to pi
};

/// The field, how it changes, and what to know of it.
struct EarthField {
  Place place;
  double year = 0.0;  ///< decimal
  std::string model;
  FieldElements value;
  FieldElements per_year;  ///< the same elements' change a year [tesla, rad]
  /// Declination from the grid north of polar stereographic maps (WMM report, equations (1) and (2)), for latitudes of
  /// 55 degrees and more to either side; elsewhere `has_grid_variation` is false.
  double grid_variation_rad = 0.0;
  bool has_grid_variation = false;
  /// At the poles of rotation every direction is south or north: `ned_tesla` is then along the meridian of the given
  /// longitude, declination counts from it, and only the grid variation means something to others.
  bool north_undefined = false;
  bool below_stated_height = false;  ///< deeper than 1 km: see `kLowest_m`
  FieldZone zone = FieldZone::usual;
};

/// Refuses, each with a remedy: a date outside the model's validity, a place outside the limits above, what is not
/// finite. Nothing is extrapolated.
io::FileExpected<EarthField> field_at(const FieldModel& model, const Place& place, double year);

/// "2026-03-31" as a decimal year, the day's beginning: 2026 + 89/365.
io::FileExpected<double> decimal_year(std::string_view date);

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb
