/// Which vector a group of sensors measures, and how its readings stand inside plumb.
///
/// All that the core knows of a field is the length of its vector at rest (docs/theory.md, section 1.7), so that a
/// magnetic field is calibrated and monitored as gravity is. Readings are brought to the size of gravity where a file
/// is read, by a power of two, and back where a result is written: both lose nothing. 1 uT is 0.25 inside, so that the
/// Earth's field, 22 to 67 uT, is 5.5 to 16.8. A rate is in rad/s inside; it has no length, and is judged by parity.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

enum class FieldKind : std::uint8_t { gravity, magnetic, rate };
const char* to_string(FieldKind field) noexcept;

/// What stands for one microtesla inside.
inline constexpr double kInside_per_ut = 0.25;

/// Words and units of a field, for files, messages and results.
struct FieldUnits {
  const char* vector;          ///< "gravity", "the magnetic field"
  const char* sensor;          ///< "accelerometer"
  const char* coarse;          ///< unit of the whole vector
  double coarse_per_inside;    ///< coarse units of 1 inside
  const char* fine;            ///< unit of errors
  double fine_per_inside;      ///< fine units of 1 inside
  const char* json_suffix;     ///< of keys: "mps2"
  double json_per_inside;      ///< what such a key holds of 1 inside
  const char* noise_example;   ///< "0.5 mg"
  const char* scale_examples;  ///< "3 V/g0" or "2048 count/g0"
};
const FieldUnits& units_of(FieldKind field) noexcept;

/// A place and a day of which the length of the magnetic field is wanted.
struct MagneticPlace {
  double latitude_deg = 0.0;   ///< geodetic, north
  double longitude_deg = 0.0;  ///< east
  double height_m = 0.0;       ///< above the ellipsoid
  std::string date;            ///< "2026-03-31"
};

/// The field at a place, 1 sigma.
struct MagneticReference {
  std::string source;
  double total_ut = 0.0, total_sigma_ut = 0.0;
  bool dip_known = false;
  double dip_rad = 0.0, dip_sigma_rad = 0.0;  ///< below the horizon
};

/// A model of the Earth's field: `geomagnetic::lookup`. The errors' `field` is "latitude", "longitude", "height" or
/// "date".
using FieldLookup = std::function<FileExpected<MagneticReference>(const MagneticPlace&)>;

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
