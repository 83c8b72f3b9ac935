/// Numbers with units as text <-> SI. A number without its unit is refused, and so is a bare "g":
/// g0 = 9.80665 m/s^2 or g98 = 9.8 m/s^2 must be named. "mg" and "ug" mean milli-g0 and micro-g0.
///
/// Errors carry `what` and `remedy`; the caller adds file, line and field.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "plumb/core/units.hpp"
#include "plumb/io/field.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

enum class Quantity : std::uint8_t {
  /// Of the vector that a group of sensors measures, as it stands inside plumb (plumb/io/field.hpp):
  /// gravity, m/s^2: m/s^2 mm/s^2 g0 mg0 ug0 mg ug g98 Gal mGal ft/s^2
  /// magnetic, 4 uT: uT nT mT T G mG gamma
  /// rate, rad/s: deg/s dps rad/s mrad/s deg/h
  acceleration,
  angle,        ///< rad: deg rad mrad arcmin
  time,         ///< s: s ms us min h
  rate,         ///< Hz: Hz kHz
  temperature,  ///< degC
  length,       ///< m: m km ft
  density,      ///< kg/m^3: kg/m^3 g/cm^3
  ratio,        ///< 1: % ppm, or no unit at all
};
const char* to_string(Quantity quantity) noexcept;

/// "12 mg" -> 0.1176798. Finite numbers only; the blank before the unit may be omitted. `field` matters to
/// `acceleration` alone, here and below.
FileExpected<double> parse_quantity(Quantity quantity, std::string_view text, FieldKind field = FieldKind::gravity);

/// The inverse, in the named unit, with as many digits as the double holds. An unknown unit is an error.
FileExpected<std::string> format_quantity(Quantity quantity, double si, std::string_view unit);

/// "m/s^2, mm/s^2, g0, ..." for messages and help.
std::string accepted_units(Quantity quantity, FieldKind field = FieldKind::gravity);

/// Unit of the numbers in a log. plumb keeps raw values exactly as the log has them; scale factors are
/// converted to this unit when the array file is read.
struct RawUnit {
  enum class Kind : std::uint8_t { voltage, count, acceleration };
  Kind kind = Kind::acceleration;
  double base_per_unit = 1.0;  ///< V, count or m/s^2 per unit
  std::string name = "m/s^2";
  FieldKind field = FieldKind::gravity;  ///< that the sensors measure: "acceleration" and m/s^2 are those of the field
};
FileExpected<RawUnit> parse_raw_unit(std::string_view text, FieldKind field = FieldKind::gravity);
std::string accepted_raw_units(FieldKind field = FieldKind::gravity);

/// "3 V/g0", "2048 count/g0", "415 count/(m/s^2)" -> log units per m/s^2. For a log in an acceleration
/// unit, "1" and "1 (m/s^2)/(m/s^2)" mean a reading that needs no scaling. Zero is refused.
FileExpected<double> parse_scale(std::string_view text, const RawUnit& log_unit);

/// A value given either as an acceleration ("12 mg") or in raw units ("33123 count") -> m/s^2 or log
/// units; `scale` is in log units per m/s^2.
FileExpected<double> parse_as_acceleration(std::string_view text, const RawUnit& log_unit, double scale);
FileExpected<double> parse_as_raw(std::string_view text, const RawUnit& log_unit, double scale);

/// Coefficient of (T - T_C)^order, order 1..3: "0.1 mg/degC", "2 ug/degC^2" -> m/s^2/degC^order for
/// Quantity::acceleration; "200 ppm/degC" -> 1/degC^order for Quantity::ratio.
FileExpected<double> parse_temperature_slope(Quantity quantity, std::string_view text, int order,
                                             FieldKind field = FieldKind::gravity);

/// Shortest decimal text that reads back as the same double; "nan", "inf", "-inf" where not finite.
std::string shortest(double value);
void append_shortest(std::string& out, double value);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
