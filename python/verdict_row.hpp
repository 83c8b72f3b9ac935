/// A verdict as a row of a structured numpy array: every figure of `plumb::Verdict`, named as in plumb/c/plumb.h.
#pragma once

#include <cstdint>

#include "module.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb_python {

inline constexpr std::size_t kSensors = plumb::kCapacity;

// COLUMN(type, name, extent, what it is). Sets of sensors are bits, of sensor i bit i; words are indices into tuples of
// the module; vectors are in the output frame.
// clang-format off
#define PLUMB_VERDICT_ROW(COLUMN) \
  COLUMN(double, time_s, , "time of the sample [s]") \
  COLUMN(std::uint32_t, sample, , "samples offered since power-on, those refused included") \
  COLUMN(std::uint8_t, state, , "index into STATES") \
  COLUMN(std::uint8_t, validity, , "index into VALIDITIES: what the vector may be used for; read it before anything else") \
  COLUMN(std::uint8_t, cause, , "index into CAUSES: why") \
  COLUMN(std::uint8_t, decided_by, , "index into CAUSES: the test that decided the last block (parity, norm or mae)") \
  COLUMN(std::uint8_t, grade, , "index into GRADES: what the last exclusion rests on") \
  COLUMN(bool, tick, , "this sample completed a block: statistic and vector are new") \
  COLUMN(bool, accepted, , "the sample was used") \
  COLUMN(bool, alert, , "False only where the output is valid and the protection level within the alert limit") \
  COLUMN(bool, protection_available, , "a bound on the error is known") \
  COLUMN(bool, wants_rotation, , "another attitude would help: turn_along says which") \
  COLUMN(std::uint8_t, faults_covered, , "faulty sensors that the protection level holds for; 0: no bound") \
  COLUMN(std::uint16_t, usable, , "bits, named in USABLE: what of this row may be used") \
  COLUMN(std::uint16_t, qualifiers, , "bits, named in QUALIFIERS: standstill_assumed, stability_unstated and others") \
  COLUMN(std::uint32_t, transition, , "number of the change at this sample, 1, 2, 3, ...; 0: nothing changed") \
  COLUMN(std::uint8_t, transition_from, , "index into STATES: before the change") \
  COLUMN(std::uint8_t, transition_to, , "index into STATES: after the change") \
  COLUMN(std::uint8_t, transition_event, , "index into EVENTS: what was taken") \
  COLUMN(std::uint8_t, transition_cause, , "index into CAUSES: of the change") \
  COLUMN(std::uint8_t, transition_grade, , "index into GRADES: of the exclusion, if it is one") \
  COLUMN(std::uint32_t, transition_sensors, , "sensors that the event names") \
  COLUMN(double, transition_time_s, , "time of the change [s]") \
  COLUMN(double, transition_statistic, , "of the block that decided [standard deviations; m/s^2 for mae]") \
  COLUMN(double, transition_limit, , "its limit, same unit") \
  COLUMN(std::uint32_t, configured, , "all sensors: in service + provisionally excluded + excluded + absent") \
  COLUMN(std::uint32_t, in_service, , "sensors used for the vector") \
  COLUMN(std::uint32_t, provisionally_excluded, , "provisionally excluded") \
  COLUMN(std::uint32_t, excluded, , "isolated as faulty") \
  COLUMN(std::uint32_t, absent, , "silent") \
  COLUMN(std::uint32_t, suspects, , "suspected by some consistent explanation; none without an alarm on record") \
  COLUMN(std::uint32_t, clipped, , "at full scale in this block") \
  COLUMN(std::uint32_t, scattering, , "scattered more than their noise in this block") \
  COLUMN(std::uint32_t, not_finite, , "read no number in this block") \
  COLUMN(std::uint32_t, noisy, , "scatter by themselves while the others are at rest") \
  COLUMN(std::uint32_t, stuck, , "repeat one value while the others predict a change") \
  COLUMN(std::uint32_t, contradicted_clip, , "at full scale while the others predict less") \
  COLUMN(std::uint8_t, sensor_cause, [kSensors], "index into CAUSES for each sensor: why it is out of service or suspected") \
  COLUMN(std::uint8_t, minimum_faults, [kSensors], "fewest faults that explain the data with the sensor healthy; 255: no explanation") \
  COLUMN(std::int32_t, confirmed_grade, , "faults that the sensors not excluded can still isolate") \
  COLUMN(std::int32_t, provisional_grade, , "faults that they can provisionally exclude") \
  COLUMN(std::int32_t, consistent_hypotheses, , "test subsets that are still consistent") \
  COLUMN(std::int32_t, stations_on_record, , "distinct attitudes in doubt, on which the isolation timeout runs") \
  COLUMN(std::int32_t, block_fill, , "samples of the block that is being collected") \
  COLUMN(double, statistic, , "of the test that decided the last block [standard deviations; m/s^2 for mae]") \
  COLUMN(double, limit, , "its limit, same unit") \
  COLUMN(double, margin, , "1 - statistic / limit; negative: alarm") \
  COLUMN(double, mae_all_mps2, , "sliding mean absolute error of the sensors in service [m/s^2]") \
  COLUMN(double, mae_worst_mps2, , "that of the worst triple in service [m/s^2]") \
  COLUMN(double, mae_worst_limit_mps2, , "its limit [m/s^2]") \
  COLUMN(std::uint16_t, triples_tested, , "how many triples the last block was tested by") \
  COLUMN(std::uint16_t, triples_failing, , "how many of them were beyond their limit; which: Monitor.verdict") \
  COLUMN(double, parity, , "parity residual of the last block [standard deviations]") \
  COLUMN(double, parity_limit, , "its limit; 0: three sensors have no parity") \
  COLUMN(double, norm_error_mps2, , "length of the vector minus gravity, last block [m/s^2]") \
  COLUMN(double, reference_mps2, , "length of gravity used by the tests [m/s^2]") \
  COLUMN(double, reference_sigma_mps2, , "its standard uncertainty [m/s^2]") \
  COLUMN(std::uint8_t, norm_mismatch_kind, , "index into NORM_MISMATCH_KINDS: kind of the norm mismatch") \
  COLUMN(std::int32_t, norm_mismatch_attitudes, , "attitudes that were compared for it") \
  COLUMN(double, norm_mismatch_length_mps2, , "error of the length common to all of them [m/s^2]") \
  COLUMN(double, norm_mismatch_length_bound_mps2, , "largest error of that [m/s^2]; 0: none") \
  COLUMN(double, norm_mismatch_widened_mps2, , "by how much three sigma of gravity are wider for it [m/s^2]") \
  COLUMN(double, norm_mismatch_bias_mps2, [3], "error of the length along a direction [m/s^2]") \
  COLUMN(double, norm_mismatch_turn_rad, , "most that this can turn the direction [rad]; 0: no bound yet") \
  COLUMN(double, gravity_offset_mps2, , "gravity finding: common offset of the length at many attitudes [m/s^2]; 0: none found") \
  COLUMN(double, gravity_to_configure_mps2, , "gravity finding: the length to configure [m/s^2]; 0: none found") \
  COLUMN(bool, calibration_contradicted, , "calibration finding: the first attitudes contradict its covariance") \
  COLUMN(bool, calibration_refused, , "... by more than any tolerance explains: nothing is valid") \
  COLUMN(std::int32_t, calibration_attitudes, , "... at so many attitudes") \
  COLUMN(double, calibration_ratio, , "... by residuals of so many times what it allows; 0: by none") \
  COLUMN(double, calibration_tolerance_mps2, , "... and every sensor has this tolerance since [m/s^2]") \
  COLUMN(float, drift_mps2_per_h, [kSensors], "slow drift below the limits, for each sensor as if it alone drifted [m/s^2 per hour]; 0: none") \
  COLUMN(double, noise_factor, , "noise of all sensors in stated sigmas, as blocks at rest have shown it; 1: as stated") \
  COLUMN(double, noise_correlation, , "samples that are worth one independent one; 1: all are independent") \
  COLUMN(double, temperature_degc, , "last one that was a number [degC]") \
  COLUMN(double, temperature_rate_degc_per_min, , "its change [degC per minute]; 0: not known yet") \
  COLUMN(double, gravity_mps2, [3], "vector of the last block at rest, positive down [m/s^2]") \
  COLUMN(double, covariance, [9], "of it, row-major: noise and calibration [(m/s^2)^2]") \
  COLUMN(double, age_s, , "since the block that gave it [s]") \
  COLUMN(double, latest_mps2, [3], "vector of this one sample, for which no claim is made [m/s^2]") \
  COLUMN(double, protection_level_calibrated_axes_rad, , "bound on the angle between gravity_mps2 and the truth in the frame of the calibrated axes [rad]; NaN: no bound") \
  COLUMN(double, protection_level_housing_rad, , "the same in the frame of the housing, alignment included [rad]; NaN: no bound") \
  COLUMN(double, toolface_protection_housing_rad, , "what it means for the toolface [rad]; pi near the vertical; NaN: no bound") \
  COLUMN(double, turn_along, [3], "unit vector along which gravity has to change; 0: any turn helps, or none is wanted") \
  COLUMN(double, turn_change_mps2, , "by so much [m/s^2]") \
  COLUMN(double, turn_angle_rad, , "least turn that counts as another attitude [rad]") \
  COLUMN(std::uint8_t, recalibration_phase, , "index into RECALIBRATION_PHASES") \
  COLUMN(bool, recalibration_offered, , "a calibration of the host's is on trial instead of a fit") \
  COLUMN(std::int32_t, recalibration_stations, , "stations of the fit") \
  COLUMN(std::int32_t, recalibration_held_out, , "stations kept for the proof") \
  COLUMN(std::int32_t, stations_wanted, , "stations still missing") \
  COLUMN(std::uint32_t, recalibration_lacking, , "sensors that need gravity along and against their axis") \
  COLUMN(double, recalibration_wanted_direction, [3], "unit vector of gravity that would help most; 0: none is asked for") \
  COLUMN(std::uint16_t, recalibration_refusal, , "why the last fit was not accepted: error_text; 0: none was refused") \
  COLUMN(std::uint16_t, snapshot_refusal, , "why the monitor runs without its history: error_text; 0: it does not") \
  COLUMN(std::uint64_t, config_hash, , "of array, calibration and settings, gravity left out: equal runs have equal ones")
// clang-format on

struct VerdictRow {
#define PLUMB_MEMBER(type, name, extent, what) type name extent;
  PLUMB_VERDICT_ROW(PLUMB_MEMBER)
#undef PLUMB_MEMBER
};

/// Every byte of it, padding too: equal verdicts are equal bytes.
void write_row(const plumb::Verdict& verdict, const plumb::Mat3& frame, VerdictRow& to);

/// verdict_dtype, VERDICT_FIELDS and the tuples of names.
void bind_verdict_row(py::module_& module);

}  // namespace plumb_python
