/* plumb for C: the same monitor, in memory that the caller owns. No callback, no global, no heap; two monitors never
 * share anything, so each may live in its own thread (one monitor is for one thread at a time). C99 and C++.
 *
 * Every struct begins with `struct_size`; the `..._defaults` functions set it. A struct of another
 * version of this header is refused (PLUMB_WRONG_STRUCT), never misread.
 *
 * Units: SI, degC for temperature. Frames: the frame in which the axes are given; vectors of the verdict are turned by
 * `output_frame`. Gravity is positive down (`reads` says what the sensors themselves count). */
#ifndef PLUMB_C_PLUMB_H
#define PLUMB_C_PLUMB_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#define PLUMB_NOEXCEPT noexcept
#else
#define PLUMB_NOEXCEPT
#endif

/* Of this header. */
#define PLUMB_C_VERSION 1u
/* Room in the structs, whatever the library was built for: `plumb_capacity()` says how many sensors it takes. */
#define PLUMB_C_SENSORS 24

/* --- What a call answers. ------------------------------------------------------------------------------- */

/* 0 is success; the other codes and their figures are those of plumb/core/error.hpp, and these. */
#define PLUMB_OK 0
#define PLUMB_NULL_POINTER 1000       /* index = argument, from 0 */
#define PLUMB_WRONG_STRUCT 1001       /* index = argument, or sensor; value = struct_size, limit = the library's */
#define PLUMB_STORAGE_TOO_SMALL 1002  /* index = argument; value = bytes given, limit = bytes needed */
#define PLUMB_STORAGE_MISALIGNED 1003 /* index = argument; limit = alignment needed */
#define PLUMB_NOT_INITIALISED 1004    /* no monitor in this storage */
#define PLUMB_STORAGE_OVERLAPS 1005   /* index = argument: a workspace that lies in the monitor's storage */

typedef struct plumb_error {
  int32_t code;
  int32_t index; /* sensor, station or field; -1 where none applies */
  double value;  /* what was found */
  double limit;  /* what would have been allowed */
} plumb_error;

/* What is wrong, and how to mend it; `index`, `value` and `limit` say where. Never null, for any number. */
const char* plumb_error_text(int32_t code) PLUMB_NOEXCEPT;
const char* plumb_error_remedy(int32_t code) PLUMB_NOEXCEPT;

/* --- Configuration. ------------------------------------------------------------------------------------- */

typedef struct plumb_sensor {
  uint32_t struct_size;
  char id[16];         /* ends with a zero */
  double axis[3];      /* unit vector, calibrated */
  double sigma_mps2;   /* white noise of one sample, 1 sigma */
  double scale[4];     /* raw unit per m/s^2: c0 + c1 t + c2 t^2 + c3 t^3 with t = T - reference_degc */
  double bias_mps2[4]; /* the same for the bias */
  double reference_degc;
  double misfit_mps2;    /* 1 sigma per attitude that no coefficient explains */
  double full_scale_raw; /* 0 = unknown */
  double resolution_raw; /* one code; 0 = unknown */
  double lever_arm_m[3]; /* from the axis of rotation */
  /* What the datasheet leaves open of bias, scale (relative) and axis, 1 sigma: read where `calibrated` is 0. */
  double prior_bias_mps2, prior_scale, prior_axis_rad;
  /* Drift since the calibration, 1 sigma of what a reading is off by: at once, and more for every day since, for every
   * degree from reference_degc, for every degree a minute. All 0: not stated, and nothing is allowed for. */
  double stability_mps2, stability_per_day_mps2, stability_per_degc_mps2, stability_per_degc_per_min_mps2;
} plumb_sensor;

typedef struct plumb_config {
  uint32_t struct_size;
  int32_t sensors;            /* 3 .. plumb_capacity() */
  const plumb_sensor* sensor; /* so many of them */
  /* What calibration leaves, four numbers a sensor (axis error, offset error in m/s^2), packed lower triangle over
   * 4 x sensors, as in a calibration file; null: perfectly known. */
  const double* covariance;
  uint32_t covariance_size; /* 2 n (4 n + 1) */
  /* 0: axes, scales and biases are the datasheet's; the monitor makes its own calibration, and `covariance` is null. */
  int32_t calibrated;
  int32_t reads; /* +1 gravity, -1 specific force; anything else is out_of_range */
  double gravity_mps2, gravity_sigma_mps2;
  double output_frame[9];   /* row-major */
  int32_t lever_arms_known; /* 0: evidence rests while the tool turns */

  /* Settings of the monitor; `plumb_config_defaults` fills them in. Reasons, and the order in which an out_of_range
   * counts them: plumb/health/monitor_config.hpp. */
  int32_t window;
  int32_t asserted_faults;
  int32_t isolation_stations, patience, clean_blocks, forget_blocks, probation_stations, missing_confirm;
  int32_t max_age_samples, patience_blocks;
  int32_t recalibrate_after_exclusion;
  int32_t alarm_for_average_tool; /* 0: the false-alarm rate holds for every tool */
  uint64_t reset_key;
  double delta_f_mps2, false_alarm_rate, rejection_rate, triple_false_alarm_rate;
  double max_gap_s, max_age_s, station_angle_rad, excitation_angle_rad, clear_fraction;
  double alert_limit_rad, integrity_risk, fault_prior;
  double temperature_min_degc, temperature_max_degc;
  double days_since_calibration;
  double acceleration_bound_mps2; /* 0: a standstill is assumed */
} plumb_config;

/* Everything but the sensors. Error: null_pointer. */
plumb_error plumb_config_defaults(plumb_config* config) PLUMB_NOEXCEPT;
/* Scale 1, bias 0, no lever arm, the priors of an ordinary datasheet; axis, id and noise are the caller's. Error:
 * null_pointer. */
plumb_error plumb_sensor_defaults(plumb_sensor* sensor) PLUMB_NOEXCEPT;

/* --- Samples and verdicts. ------------------------------------------------------------------------------ */

typedef struct plumb_sample {
  uint32_t struct_size;
  uint32_t delivered; /* bit i: channel i delivered a value */
  double time_s;      /* strictly increasing */
  double raw[PLUMB_C_SENSORS];
  double temperature_degc;
  uint32_t station; /* tag, 0 = none */
  uint32_t count;   /* raw samples behind this one */
} plumb_sample;

enum plumb_state {
  PLUMB_NOMINAL,
  PLUMB_SUSPECT,
  PLUMB_ISOLATED,
  PLUMB_DEGRADED_3_SENSOR,
  PLUMB_RECALIBRATING,
  PLUMB_FAILED
};
/* From nothing up: a verdict of zeros, which nobody wrote, is invalid. */
enum plumb_validity { PLUMB_INVALID, PLUMB_HELD, PLUMB_UNCONFIRMED, PLUMB_DEGRADED, PLUMB_VALID };
/* Bits of `usable`. */
#define PLUMB_USABLE_VECTOR 1u
#define PLUMB_USABLE_INCLINATION 2u
#define PLUMB_USABLE_TOOLFACE 4u
#define PLUMB_USABLE_PROTECTION_LEVEL 8u
#define PLUMB_USABLE_MONITORED 16u
#define PLUMB_USABLE_STATIONARY 32u
#define PLUMB_USABLE_TEMPERATURE 64u
#define PLUMB_USABLE_CALIBRATION 128u
#define PLUMB_USABLE_REFERENCE 256u
/* Bits of `qualifiers`, the others are in plumb/health/state.hpp: no acceleration bound was stated; no stability was,
 * of some sensor. */
#define PLUMB_STANDSTILL_ASSUMED 256u
#define PLUMB_STABILITY_UNSTATED 512u

/* One change of state or of a set of sensors; sequence 0: nothing changed at this sample. */
typedef struct plumb_transition {
  uint32_t sequence;
  uint8_t from, to;            /* plumb_state */
  uint8_t event, cause, grade; /* plumb/health/state.hpp, in its order */
  uint8_t reserved[3];         /* 0: a verdict has no byte that nobody wrote */
  uint32_t sensors;            /* that it names */
  double time_s, statistic, limit;
} plumb_transition;

/* A sample of which nothing was delivered. Error: null_pointer. */
plumb_error plumb_sample_defaults(plumb_sample* sample) PLUMB_NOEXCEPT;

/* plumb/health/verdict.hpp says what each field means; sets of sensors are bits. */
typedef struct plumb_verdict {
  uint32_t struct_size;
  uint32_t sample;
  double time_s;
  uint8_t state, validity, cause, decided_by, grade;
  uint8_t tick, accepted, alert, protection_available, wants_rotation;
  uint8_t recalibration_phase;
  uint8_t faults_covered; /* by the protection level */
  uint16_t usable, qualifiers;
  plumb_transition transition;
  uint32_t configured, in_service, set_aside, excluded, absent;
  uint32_t suspects, clipped, restless, not_finite, noisy, stuck, contradicted_clip;
  uint8_t sensor_cause[PLUMB_C_SENSORS], fewest_faults[PLUMB_C_SENSORS];
  int32_t strict_grade, parity_grade, live_hypotheses, stations_on_record, stations_wanted, block_fill;
  double statistic, limit, margin;
  double mae_all_mps2, mae_worst_mps2, mae_worst_limit_mps2, parity, parity_limit, norm_error_mps2;
  double reference_mps2, reference_sigma_mps2, temperature_degc;
  double gravity_mps2[3], covariance[9], age_s, latest_mps2[3];
  double protection_level_rad, toolface_protection_rad;   /* 0 and pi: no bound (`protection_available` 0) */
  double turn_along[3], turn_change_mps2, turn_angle_rad; /* of the rotation that is wanted */
  double drift_mps2_per_h[PLUMB_C_SENSORS];
  double noise_factor, noise_correlation; /* 1 where the noise is as stated: see `plumb::Verdict` */
  /* Gravity that is off alike at many attitudes: by how much, and the length to configure; 0: none found. */
  double gravity_offset_mps2, gravity_to_configure_mps2;
  /* What the first attitudes contradict of the calibration: residuals in what its covariance allows, 0: nothing; and
   * the tolerance that every sensor has since, 0 where the calibration is refused. */
  double calibration_ratio, calibration_tolerance_mps2;
} plumb_verdict;

/* A verdict that is none: suspect, invalid, alert. Error: null_pointer. */
plumb_error plumb_verdict_defaults(plumb_verdict* verdict) PLUMB_NOEXCEPT;

/* Names of the numbers above, for a log. Never null. */
const char* plumb_state_text(int32_t state) PLUMB_NOEXCEPT;
const char* plumb_validity_text(int32_t validity) PLUMB_NOEXCEPT;
const char* plumb_cause_text(int32_t cause) PLUMB_NOEXCEPT;

/* --- The monitor. --------------------------------------------------------------------------------------- */

typedef struct plumb_monitor plumb_monitor; /* lives in storage of the caller */

uint32_t plumb_c_version(void) PLUMB_NOEXCEPT;       /* of the library's header */
uint32_t plumb_library_version(void) PLUMB_NOEXCEPT; /* major * 2^16 + minor * 2^8 + patch */
int32_t plumb_capacity(void) PLUMB_NOEXCEPT;
/* Storage of a monitor, and of the workspace that setting it up needs and then no more. */
size_t plumb_monitor_size(void) PLUMB_NOEXCEPT;
size_t plumb_monitor_align(void) PLUMB_NOEXCEPT;
size_t plumb_workspace_size(void) PLUMB_NOEXCEPT;
size_t plumb_workspace_align(void) PLUMB_NOEXCEPT;
size_t plumb_snapshot_size_max(void) PLUMB_NOEXCEPT;

/* Builds a monitor in `storage`: suspect, unproven. `*monitor` is where it stands, null on an error. Errors: those of
 * SensorArray::make and HealthMonitor::configure, and those above. */
plumb_error plumb_monitor_init(void* storage, size_t storage_size, void* workspace, size_t workspace_size,
                               const plumb_config* config, plumb_monitor** monitor) PLUMB_NOEXCEPT;
/* The same with what `plumb_monitor_snapshot` wrote under an equal configuration. With a snapshot that is damaged,
 * foreign or older it answers the error, and the monitor runs, unproven, as after init. */
plumb_error plumb_monitor_restore(void* storage, size_t storage_size, void* workspace, size_t workspace_size,
                                  const plumb_config* config, const uint8_t* snapshot, size_t snapshot_size,
                                  plumb_monitor** monitor) PLUMB_NOEXCEPT;
/* Errors: buffer_too_small. */
plumb_error plumb_monitor_snapshot(const plumb_monitor* monitor, uint8_t* to, size_t room,
                                   size_t* written) PLUMB_NOEXCEPT;

/* One sample in, one verdict out (`verdict` may be null). Any bit pattern is taken; bounded work. On an error of the
 * monitor or of the sample the verdict becomes that of plumb_verdict_defaults: none is left standing from before. */
plumb_error plumb_monitor_step(plumb_monitor* monitor, const plumb_sample* sample,
                               plumb_verdict* verdict) PLUMB_NOEXCEPT;
/* The last verdict once more; on an error as above. */
plumb_error plumb_monitor_verdict(const plumb_monitor* monitor, plumb_verdict* verdict) PLUMB_NOEXCEPT;

/* Leaves `failed` at the next step. Error: wrong_key. */
plumb_error plumb_monitor_reset(plumb_monitor* monitor, uint64_t key, uint32_t sensors) PLUMB_NOEXCEPT;
plumb_error plumb_monitor_set_gravity(plumb_monitor* monitor, double g_mps2, double sigma_mps2) PLUMB_NOEXCEPT;
/* `rate_radps` null: the tool turns at a rate that is not known. */
plumb_error plumb_monitor_set_rotation(plumb_monitor* monitor, int32_t turning,
                                       const double rate_radps[3]) PLUMB_NOEXCEPT;
plumb_error plumb_monitor_request_recalibration(plumb_monitor* monitor) PLUMB_NOEXCEPT;
/* Offers a calibration made elsewhere: biases, scales and covariance of `config` (its settings are not looked at) are
 * tried in the shadow and adopted or refused. Errors: those of plumb_monitor_init but for the storage, and of
 * HealthMonitor::offer_calibration; not_calibrated where `calibrated` is 0. */
plumb_error plumb_monitor_offer(plumb_monitor* monitor, void* workspace, size_t workspace_size,
                                const plumb_config* config) PLUMB_NOEXCEPT;
/* Axis, scale and bias of a sensor as they are in force now: what the monitor fitted, or was given. Error:
 * out_of_range (sensor). The other members are left as they are. */
plumb_error plumb_monitor_calibration(const plumb_monitor* monitor, int32_t sensor, plumb_sensor* to) PLUMB_NOEXCEPT;
plumb_error plumb_monitor_inhibit(plumb_monitor* monitor, int32_t frozen) PLUMB_NOEXCEPT;
/* The next sample may have any time: a recording has been played and the run begins, or the clock was set. Nothing is
 * valid before the next block at rest; what the monitor has learned stays. */
plumb_error plumb_monitor_begin_time_base(plumb_monitor* monitor) PLUMB_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
