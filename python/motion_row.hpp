/// A verdict in motion: as an object with words, and as a row of a structured numpy array with every figure of
/// `plumb::MotionVerdict`, named as there and as in plumb/c/plumb_motion.h.
#pragma once

#include <cstdint>
#include <optional>

#include "module.hpp"
#include "plumb/motion/continuous_inclination.hpp"

namespace plumb_python {

// COLUMN(type, name, extent, what it is). Sets of sensors are bits, of sensor i bit i; words are indices into tuples of
// the module; vectors are in the output frame.
// clang-format off
#define PLUMB_FORCE_ROW(FORCE_COLUMN) \
  FORCE_COLUMN(std::uint8_t, validity, , "index into FORCE_VALIDITIES: whether the bound holds; read it before anything else") \
  FORCE_COLUMN(std::uint8_t, dominant, , "index into FORCE_TERMS: the largest part of the bound") \
  FORCE_COLUMN(bool, gyro_assumed, , "the bound holds while the only gyro is healthy") \
  FORCE_COLUMN(std::uint32_t, used, , "sensors that are in it") \
  FORCE_COLUMN(double, time_s, , "the instant that it belongs to [s]; NaN: no force") \
  FORCE_COLUMN(double, span_s, , "length of each of the two blocks behind it [s]") \
  FORCE_COLUMN(double, force_mps2, [3], "specific force at the reference point, at rest upwards [m/s^2]; NaN: no force") \
  FORCE_COLUMN(double, covariance_m2ps4, [3][3], "of its noise alone [(m/s^2)^2]; NaN: no force") \
  FORCE_COLUMN(double, bound_mps2, , "of the length of its error [m/s^2]; infinite: none")

#define PLUMB_INCLINATION_ROW(INCLINATION_COLUMN) \
  INCLINATION_COLUMN(std::uint8_t, status, , "index into INCLINATION_STATUSES; the angles are NaN but with known") \
  INCLINATION_COLUMN(std::uint8_t, widest, , "index into INCLINATION_TERMS: the largest part of the interval") \
  INCLINATION_COLUMN(bool, gyro_assumed, , "it holds while the only gyro is healthy") \
  INCLINATION_COLUMN(double, time_s, , "the middle of the window [s]") \
  INCLINATION_COLUMN(double, span_s, , "length of the window [s]") \
  INCLINATION_COLUMN(double, inclination_rad, , "against gravity; its cosine is the mean cosine over the window [rad]") \
  INCLINATION_COLUMN(double, low_rad, , "it lies between this [rad]") \
  INCLINATION_COLUMN(double, high_rad, , "and this [rad]")

#define PLUMB_MOTION_ROW(MOTION_COLUMN) \
  MOTION_COLUMN(double, time_s, , "time of the sample [s]") \
  MOTION_COLUMN(std::uint8_t, cause, , "index into MOTION_CAUSES: why no sensor is isolated, or nothing is judged") \
  MOTION_COLUMN(bool, alarm, , "readings contradict each other") \
  MOTION_COLUMN(bool, gyros_disagree, , "the two gyros read more apart than their bounds allow: one of them is faulty") \
  MOTION_COLUMN(bool, block_ended, , "`block` is new with this sample") \
  MOTION_COLUMN(std::uint32_t, rejected, , "sensors in sets that the last blocks rejected") \
  MOTION_COLUMN(std::uint32_t, suspects, , "sensors in some of the smallest explanations") \
  MOTION_COLUMN(std::uint32_t, isolated, , "sensors in every explanation") \
  MOTION_COLUMN(std::uint32_t, excluded, , "sensors that this monitor has excluded, provisionally") \
  MOTION_COLUMN(std::int32_t, least_faults, , "units that it takes at least to explain what is on record") \
  MOTION_COLUMN(ForceRow, sample, , "specific force of the last two samples, a record (FORCE_FIELDS)") \
  MOTION_COLUMN(ForceRow, block, , "of the last two blocks of 32 samples, tighter and later, a record (FORCE_FIELDS)") \
  MOTION_COLUMN(bool, inclination_ended, , "`inclination` is new with this sample: a window has ended, or why there is none") \
  MOTION_COLUMN(InclinationRow, inclination, , "of the z axis of [output] over the last window, a record (INCLINATION_FIELDS)")
// clang-format on

#define PLUMB_MEMBER(type, name, extent, what) type name extent;
struct ForceRow {
  PLUMB_FORCE_ROW(PLUMB_MEMBER)
};
struct InclinationRow {
  PLUMB_INCLINATION_ROW(PLUMB_MEMBER)
};
struct MotionRow {
  PLUMB_MOTION_ROW(PLUMB_MEMBER)
};
#undef PLUMB_MEMBER

/// What `MotionMonitor.step` returns.
struct MotionVerdict {
  Array array;
  double time_s = 0.0;
  plumb::MotionVerdict verdict;
  bool inclination_ended = false;
  std::optional<plumb::InclinationInterval> inclination;  ///< none where the array file bounds no velocity
};

/// Every byte of it, padding too: equal verdicts are equal bytes.
void write_row(double time_s, const plumb::MotionVerdict& verdict, const plumb::Mat3& frame, MotionRow& to);

/// Null: the array file bounds no velocity, and no window is ever full.
void write_inclination(bool ended, const plumb::InclinationInterval* interval, MotionRow& to);

/// MotionVerdict, SpecificForce, Inclination, motion_dtype, MOTION_FIELDS, FORCE_FIELDS, INCLINATION_FIELDS and the
/// tuples of names.
void bind_motion_verdict(py::module_& module);

}  // namespace plumb_python
