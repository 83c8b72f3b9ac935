#include "plumb/io/field.hpp"

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

const char* to_string(FieldKind field) noexcept {
  switch (field) {
    case FieldKind::gravity: return "gravity";
    case FieldKind::magnetic: return "magnetic";
    case FieldKind::rate: return "rate";
  }
  return "?";
}

const FieldUnits& units_of(FieldKind field) noexcept {
  static constexpr FieldUnits kGravity = {
      "gravity",      "accelerometer", "m/s^2", 1.0,      "mg0",
      1e3 / kG0_mps2, "mps2",          1.0,     "0.5 mg", "\"3 V/g0\" or \"2048 count/g0\""};
  static constexpr FieldUnits kMagnetic = {"the magnetic field",
                                           "magnetometer",
                                           "uT",
                                           1.0 / kInside_per_ut,
                                           "nT",
                                           1e3 / kInside_per_ut,
                                           "nt",
                                           1e3 / kInside_per_ut,
                                           "20 nT",
                                           "\"0.1 V/uT\" or \"16 count/uT\""};
  static constexpr FieldUnits kRate = {
      "the rate",  "gyro",  "deg/s", 180.0 / kPi,  "deg/s",
      180.0 / kPi, "radps", 1.0,     "0.05 deg/s", "\"5 mV/(deg/s)\" or \"16.4 count/(deg/s)\""};
  switch (field) {
    case FieldKind::gravity: return kGravity;
    case FieldKind::magnetic: return kMagnetic;
    case FieldKind::rate: return kRate;
  }
  return kGravity;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
