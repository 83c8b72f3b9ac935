/// A second reference beside the length of gravity: the dip of the Earth's magnetic field, the angle of the field below
/// the horizontal, known by a model and measured by healthy magnetometers. With it three accelerometers have one
/// redundancy: most single faults are detected, the faulty sensor is often named, and the direction has a bound
/// (docs/theory.md, T16). Pure functions; nothing of a monitor needs them.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/array/geometry.hpp"
#include "plumb/detection/fault_ranges.hpp"
#include "plumb/gravity/gravity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What a figure may be off by: noise as 1 sigma, and what does not average as a bound. Both >= 0.
struct ErrorOf {
  double sigma = 0.0, bound = 0.0;

  double within(double sigmas) const noexcept { return sigmas * sigma + bound; }
};

/// The Earth's field at the place, from a model or a survey.
struct FieldReference {
  double total_nt = 0.0;
  ErrorOf total_error_nt;
  double dip_rad = 0.0;  ///< -pi/2 .. pi/2, positive where the field points below the horizontal
  ErrorOf dip_error_rad;
};

/// Mean of the magnetometers at a station, in the frame of the array's axes. They are taken to be healthy: their
/// errors, interference of steel and currents among them, within what is stated.
struct FieldReading {
  Vec3 field_nt{};
  ErrorOf axis_error_nt;   ///< of each component: noise and calibration
  double vector_nt = 0.0;  ///< bound on the length of what else is added to the vector: interference
  double turn_rad = 0.0;   ///< bound on the turn of the magnetometers' frame against that of the accelerometers
};

/// One station at rest: means over a block, and what each healthy reading may be off by.
struct DipStation {
  SensorSet used;                  ///< sensors that serve, of rank 3; at most one of them is faulty
  Readings mean_mps2{};            ///< calibrated
  Readings sigma_mps2{};           ///< noise of the mean, > 0
  Readings bound_mps2{};           ///< calibration, drift, >= 0
  GravityReference gravity;        ///< 1 sigma
  double acceleration_mps2 = 0.0;  ///< bound on a steady acceleration of the tool
  FieldReading field;
  FieldReference reference;
  /// Every sigma above is taken so many times (1e-5 a number, two-sided). All that follows holds while each error is
  /// within that and its bound.
  double sigmas = 4.417;
};

/// Why a station says nothing.
enum class DipRefusal : std::uint8_t {
  none,
  too_few_sensors,  ///< fewer than three that span space: none lies within kPlaneTolerance of the plane of two others
  not_finite,       ///< a reading, a reference or an error of one
  error_not_positive,  ///< no noise of a sensor, or a sigma or bound below zero
  bad_reference,       ///< gravity, field or dip that cannot be: no length, a dip beyond 90 deg
  too_coarse,          ///< errors as large as gravity or the field itself: no direction is left
  field_length,        ///< the field is longer or shorter than its reference allows: interference beyond its bound
  sensors_changed      ///< `DipEvidence`: other sensors serve than at the stations before
};
const char* to_string(DipRefusal refusal) noexcept;
inline constexpr DipRefusal kLastDipRefusal = DipRefusal::sensors_changed;

/// One explanation of a station: sensor i is faulty and no other, or none is. Gravity is then `x - shift column_i` but
/// for what turns it by at most `turn_rad`; the fault is the shift but for `margin_mps2`.
struct DipHypothesis {
  FaultRanges shift;         ///< consistent with both references and all readings; {0} of no fault
  double margin_mps2 = 0.0;  ///< what the reading of sensor i, and errors of the others along its column, add to it
  double turn_rad = 0.0;

  bool consistent() const noexcept { return !shift.empty(); }
  FaultRanges fault() const noexcept { return shift.widened(margin_mps2); }
};

/// What one station leaves possible.
struct DipJudgement {
  DipRefusal refusal = DipRefusal::too_few_sensors;  ///< with any but `none` all else is empty
  SensorSet used;
  Vec3 x_mps2{};                         ///< least squares of all sensors that serve
  std::array<Vec3, kCapacity> column{};  ///< what reading i adds to it
  DipHypothesis none;                    ///< no sensor is faulty
  std::array<DipHypothesis, kCapacity> faulty{};
};

/// Every explanation by at most one faulty sensor that the stated errors allow is in the answer: none that is true is
/// left out while every error is within its sigmas and bound. Work is O(n^3) and nothing for three sensors, no
/// allocation.
DipJudgement judge_dip(const SensorArray& array, const DipStation& station) noexcept;

/// Least size of a fault of sensor i that both references show at this attitude, whatever the errors within the stated
/// ones: every larger one, of either sign, leaves "no fault" inconsistent. Infinite where the sensors do not span
/// space or the figures are refused. Of `station` everything but the readings counts; `gravity_mps2` is the true
/// vector, `field_nt` of the station the true field.
double surely_seen_mps2(const SensorArray& array, const DipStation& station, const Vec3& gravity_mps2, int i) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
