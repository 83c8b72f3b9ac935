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
#define PLUMB_NOT_INITIALISED 1004    /* nothing was set up in this storage */
#define PLUMB_STORAGE_OVERLAPS 1005   /* index = argument: a workspace that lies in the monitor's storage */

typedef struct plumb_error {
  int32_t code;  /* PLUMB_OK, one of the numbers above, or an Errc */
  int32_t index; /* sensor, station or field, from 0; -1 where none applies */
  double value;  /* what was found */
  double limit;  /* what would have been allowed, in the same unit */
} plumb_error;

/* What is wrong, and how to mend it; `index`, `value` and `limit` say where. Never null, for any number. */
const char* plumb_error_text(int32_t code) PLUMB_NOEXCEPT;
const char* plumb_error_remedy(int32_t code) PLUMB_NOEXCEPT;

/* --- Configuration. ------------------------------------------------------------------------------------- */

/* One sensor, as calibrated, or as its datasheet has it. All of it is read by init, restore and offer. */
typedef struct plumb_sensor {
  uint32_t struct_size;  /* set by plumb_sensor_defaults */
  char id[16];           /* name, up to 15 characters and a zero; not empty, no two alike */
  double axis[3];        /* unit vector of the calibrated axis, tool frame */
  double sigma_mps2;     /* white noise of one sample, 1 sigma, above 0 [m/s^2] */
  double scale[4];       /* raw unit per m/s^2: c0 + c1 t + c2 t^2 + c3 t^3 with t = T - reference_degc; c0 above 0 */
  double bias_mps2[4];   /* the same for the bias [m/s^2]: raw = scale (acceleration + bias) */
  double reference_degc; /* T of t = 0 [degC] */
  double misfit_mps2;    /* 1 sigma per attitude that no coefficient explains [m/s^2]; 0 = none */
  double full_scale_raw; /* |raw| at and beyond which the channel is clipped; 0 = unknown */
  double resolution_raw; /* one code of the converter; 0 = unknown */
  double lever_arm_m[3]; /* from the axis of rotation, tool frame [m]; read where config.lever_arms_known */
  /* What the datasheet leaves open, 1 sigma: read where config.calibrated is 0. */
  double prior_bias_mps2; /* of the bias [m/s^2] */
  double prior_scale;     /* of the scale, relative */
  double prior_axis_rad;  /* of the axis, about each of two directions across it [rad] */
  /* Drift since the calibration, 1 sigma of what a reading is off by; all four add up. All 0: not stated, nothing is
   * allowed for, and every verdict has PLUMB_STABILITY_UNSTATED. */
  double stability_mps2;                  /* at once, however long ago [m/s^2] */
  double stability_per_day_mps2;          /* more for every day since */
  double stability_per_degc_mps2;         /* more for every degree from reference_degc */
  double stability_per_degc_per_min_mps2; /* more for every degree a minute */
  int32_t chip; /* sensors of one chip bear the same number, 1 .. 255; 0 = a unit of its own */
} plumb_sensor;

typedef struct plumb_config {
  uint32_t struct_size;       /* set by plumb_config_defaults */
  int32_t sensors;            /* 3 .. plumb_capacity() */
  const plumb_sensor* sensor; /* so many of them; not kept */
  /* What calibration leaves, four numbers a sensor (axis error, offset error in m/s^2), packed lower triangle over
   * 4 x sensors, as in a calibration file; null, or zero of a sensor:
   * its row counts as exact, and every verdict has PLUMB_UNCERTAINTY_UNSTATED. Not kept. */
  const double* covariance;
  uint32_t covariance_size; /* 2 n (4 n + 1) of n sensors; 0 with null */
  /* `common_scale_sigma` of the file: 1 sigma of the gravity at which it was calibrated, relative; 0 = in the
   * covariance. Looked at with a covariance only. */
  double common_scale;
  /* 0: axes, scales and biases are the datasheet's; the monitor makes its own calibration, and `covariance` is null. */
  int32_t calibrated;
  int32_t reads;       /* +1: a sensor shows +G with its axis down (gravity); -1: with its axis up (specific force) */
  double gravity_mps2; /* length of gravity where the tool is [m/s^2] */
  double gravity_sigma_mps2; /* its 1 sigma [m/s^2] */
  double output_frame[9];    /* rotation, row-major: tool frame -> frame of the verdict's vectors */
  int32_t lever_arms_known;  /* 0: evidence rests while the tool turns */

  /* Settings of the monitor; `plumb_config_defaults` fills them in. A value out of its range is out_of_range, with the
   * index of the field in plumb/health/monitor_config.hpp, which also has the reasons. */
  int32_t window;             /* samples per block, 1 .. 32 (libraries for 16 and 24 sensors: .. 256) */
  int32_t assumed_faults;     /* claim: never more than 0 .. 3 faulty sensors, or chips; -1 = no claim */
  int32_t isolation_stations; /* attitudes over which an answer must stay unique before a sensor is excluded, 1 .. 20 */
  int32_t isolation_timeout;  /* attitudes under suspicion before `failed`, unless bounded, 1 .. 24 */
  int32_t passed_blocks;      /* passed blocks in a row that end suspicion, 1 .. 1000 */
  int32_t forget_blocks;      /* passed blocks at other attitudes that end an episode, 1 .. 24 */
  int32_t probation_stations; /* attitudes before an excluded sensor may return, 1 .. 24 */
  int32_t missing_confirm;    /* samples in a row without a value: the channel is lost, 1 .. 60000 */
  int32_t max_age_samples;    /* samples without a quiet block until nothing is valid, .. 1000000; 0 = two blocks */
  int32_t isolation_timeout_blocks;    /* the same in blocks at any attitude, .. 1000000; 0 = not used */
  int32_t recalibrate_after_exclusion; /* 1: estimate biases and scales anew once the survivors are trusted */
  int32_t alarm_for_average_tool;      /* 0: the false-alarm rate holds for every tool; 1: for the average one */
  int32_t alert_in_calibrated_axes;    /* 0: alert_limit_rad is about the housing; 1: about the calibrated axes */
  uint64_t reset_key;                  /* what plumb_monitor_reset must be called with */
  double delta_f_mps2;            /* MAE limit of your own [m/s^2], 0 .. 10; 0 = computed from noise and geometry */
  double false_alarm_rate;        /* per block and test, 1e-9 .. 1e-2 */
  double rejection_rate;          /* per block, how seldom the true explanation may die, 1e-12 .. 1e-2 */
  double triple_false_alarm_rate; /* of the MAE of each triple alone, 0 .. 1e-2; 0 = its share of false_alarm_rate */
  double max_gap_s;               /* a longer gap between samples empties windows, 1e-6 .. 1e9 [s] */
  double max_age_s;         /* time without a quiet block until nothing is valid, .. 1e9 [s]; 0 = 1 s, or two blocks */
  double station_angle_rad; /* change of direction that begins a new station, 1e-4 .. 1.5 [rad] */
  double distinct_attitude_angle_rad; /* attitudes at least so far apart count as different, 1e-3 .. 1.5 [rad] */
  double clear_fraction;              /* clean, while in suspect, is below this fraction of the limit, 0.1 .. 1 */
  double alert_limit_rad;             /* largest tilt error that you can bear, 1e-6 .. pi [rad] */
  double integrity_risk;              /* probability that the protection level leaves out, 1e-12 .. 0.1 */
  double fault_prior;                 /* probability that one given sensor is faulty, 0 .. 0.1 */
  double temperature_min_degc;        /* calibrated span [degC]; more than 5 degC beyond it output is unconfirmed */
  double temperature_max_degc;        /* not below the former */
  double days_since_calibration;      /* at this power-on, 0 .. 36525; 0 where `calibrated` is 0 */
  double acceleration_bound_mps2;     /* largest steady acceleration of the tool, 0 .. 10 [m/s^2]; 0: a standstill is
                                         assumed */
  double alignment_bound_rad; /* most that the calibrated axes as a whole are turned by, 0 .. pi [rad]; 0: not stated */
} plumb_config;

/* Everything but the sensors. Error: null_pointer. */
plumb_error plumb_config_defaults(plumb_config* config) PLUMB_NOEXCEPT;
/* Scale 1, bias 0, no lever arm, the priors of an ordinary datasheet; axis, id and noise are the caller's. Error:
 * null_pointer. */
plumb_error plumb_sensor_defaults(plumb_sensor* sensor) PLUMB_NOEXCEPT;

/* --- Samples and verdicts. ------------------------------------------------------------------------------ */

typedef struct plumb_sample {
  uint32_t struct_size;        /* set by plumb_sample_defaults */
  uint32_t delivered;          /* bit i: channel i delivered a value */
  double time_s;               /* of your clock [s]; strictly increasing from sample to sample */
  double raw[PLUMB_C_SENSORS]; /* in the raw unit of the sensors; any bit pattern; read where `delivered` */
  double temperature_degc;     /* of the sensors [degC]; not finite: the one before holds */
  uint32_t station;            /* tag of the attitude; 0 = none, the monitor finds stations by itself */
  uint32_t count;              /* raw samples behind this one; 1 unless it is a mean */
} plumb_sample;

enum plumb_state {
  PLUMB_NOMINAL,           /* all sensors are in use and agree */
  PLUMB_SUSPECT,           /* a limit was crossed, or not every sensor is validated yet */
  PLUMB_ISOLATED,          /* a sensor is out, the rest can still check itself */
  PLUMB_DEGRADED_3_SENSOR, /* without some sensor in use there would be no vector */
  PLUMB_RECALIBRATING,     /* biases and scales are estimated anew beside the run, or for the first time */
  PLUMB_FAILED             /* too few sensors, or no answer in time; left by plumb_monitor_reset alone */
};
/* In ascending order: a verdict of zeros is invalid. */
enum plumb_validity {
  PLUMB_INVALID,     /* must not be used */
  PLUMB_HELD,        /* an older vector: the tool moves, or data stop */
  PLUMB_UNCONFIRMED, /* no bound within the alert limit holds: do not rely on it */
  PLUMB_DEGRADED,    /* may be used; no redundancy is left */
  PLUMB_VALID        /* may be used: the error is within the protection level, and that within the alert limit */
};
/* Bits of `usable`. */
#define PLUMB_USABLE_VECTOR 1u           /* gravity_mps2 */
#define PLUMB_USABLE_INCLINATION 2u      /* its inclination */
#define PLUMB_USABLE_TOOLFACE 4u         /* its toolface: at least 3 deg away from vertical */
#define PLUMB_USABLE_PROTECTION_LEVEL 8u /* the two protection levels */
#define PLUMB_USABLE_MONITORED 16u       /* the sensors in service check one another */
#define PLUMB_USABLE_STATIONARY 32u      /* the tool stands still */
#define PLUMB_USABLE_TEMPERATURE 64u     /* within the calibrated span and its margin, and not in a hurry */
#define PLUMB_USABLE_CALIBRATION 128u    /* accepted, and not one that none could check */
#define PLUMB_USABLE_REFERENCE 256u      /* there is no norm mismatch */
/* Bits of `qualifiers`, beside the state. */
#define PLUMB_NOT_YET_VALIDATED 1u       /* since power-on or reset not every sensor has been seen to follow the tool */
#define PLUMB_MOVING 2u                  /* the last block was not quiet */
#define PLUMB_INITIAL_CALIBRATION 4u     /* no calibration has been accepted yet: the monitor makes its own */
#define PLUMB_PROVISIONAL 8u             /* a sensor is provisionally excluded: reversible */
#define PLUMB_NO_REDUNDANCY 16u          /* the loss of some sensor in service would end the measurement */
#define PLUMB_TIMED_OUT 32u              /* the isolation timeout is over */
#define PLUMB_THREE_SENSOR_FIT 64u       /* the coefficients come from a fit that no spare sensor could check */
#define PLUMB_INHIBITED 128u             /* plumb_monitor_inhibit is in force */
#define PLUMB_STANDSTILL_ASSUMED 256u    /* no acceleration bound was stated */
#define PLUMB_STABILITY_UNSTATED 512u    /* no stability was stated, of some sensor */
#define PLUMB_UNCERTAINTY_UNSTATED 1024u /* the calibration takes some sensor for exact */
#define PLUMB_ALIGNMENT_UNSTATED 2048u   /* no alignment bound: the calibrated axes count as those of the housing */
/* What a step takes, in rank order: `event` of a transition. */
enum plumb_event {
  PLUMB_EVENT_RESET,
  PLUMB_EVENT_CHANNEL_LOST,
  PLUMB_EVENT_CHANNEL_BACK,
  PLUMB_EVENT_EXCLUSION,
  PLUMB_EVENT_PROVISIONAL_EXCLUSION,
  PLUMB_EVENT_ISOLATION_TIMEOUT,
  PLUMB_EVENT_NO_CONSISTENT_HYPOTHESIS,
  PLUMB_EVENT_ALARM,
  PLUMB_EVENT_NORM_MISMATCH,
  PLUMB_EVENT_FIT_ACCEPTED,
  PLUMB_EVENT_FIT_REJECTED,
  PLUMB_EVENT_PROBATION_PASSED,
  PLUMB_EVENT_RECALIBRATE,
  PLUMB_EVENT_PASSED_BLOCK,
  PLUMB_EVENT_NONE
};
/* What an exclusion rests on: nothing, agreement alone (revised as it goes), every explanation, your claim. */
enum plumb_grade { PLUMB_GRADE_NONE, PLUMB_GRADE_PROVISIONAL, PLUMB_GRADE_CONFIRMED, PLUMB_GRADE_ASSUMED };
/* How far a recalibration is. */
enum plumb_recalibration_phase {
  PLUMB_RECALIBRATION_IDLE,
  PLUMB_RECALIBRATION_COLLECTING,
  PLUMB_RECALIBRATION_FITTING,
  PLUMB_RECALIBRATION_ACCEPTED
};
/* One change of state or of a set of sensors; sequence 0: nothing changed at this sample. */
typedef struct plumb_transition {
  uint32_t sequence;   /* 1, 2, 3, ...; 0 = nothing changed, and nothing below is of use */
  uint8_t from, to;    /* plumb_state, before and after */
  uint8_t event;       /* plumb_event; none where a notice was recorded: the host froze or released, say */
  uint8_t cause;       /* why: plumb_cause_text */
  uint8_t grade;       /* plumb_grade of the exclusion, if it is one */
  uint8_t reserved[3]; /* 0: every byte of a verdict is written */
  uint32_t sensors;    /* bits of the sensors that it names: excluded, lost, back */
  double time_s;       /* of the sample [s] */
  double statistic;    /* of the block that decided: standard deviations (parity, norm) or m/s^2 (mae) */
  double limit;        /* its limit, same unit */
} plumb_transition;

/* A sample of which nothing was delivered. Error: null_pointer. */
plumb_error plumb_sample_defaults(plumb_sample* sample) PLUMB_NOEXCEPT;

/* Everything that is said about one sample. Sets of sensors are bits: bit i is sensor i. Arrays over sensors are 0
 * behind the last. "Block" is the last complete one: what it tells is new where `tick` is 1, and stands until the next.
 */
typedef struct plumb_verdict {
  uint32_t struct_size; /* set by plumb_verdict_defaults */
  uint32_t sample;      /* samples offered since power-on, those refused included */
  double time_s;        /* of this sample [s] */

  uint8_t state;                /* plumb_state */
  uint8_t validity;             /* plumb_validity: what the vector is worth; read it first */
  uint8_t cause;                /* why the verdict says what it says: plumb_cause_text */
  uint8_t decided_by;           /* the test that decided the block, a cause: parity, norm or mae */
  uint8_t grade;                /* plumb_grade of the last exclusion */
  uint8_t tick;                 /* 1: this sample completed a block */
  uint8_t accepted;             /* 1: the sample was used (time in order, enough channels) */
  uint8_t alert;                /* 0 only where the output is valid and its bound within alert_limit_rad */
  uint8_t protection_available; /* 1: the protection levels are bounds */
  uint8_t wants_rotation;       /* 1: another attitude would help; turn_... says which */
  uint8_t recalibration_phase;  /* plumb_recalibration_phase */
  uint8_t faults_covered;       /* faulty sensors, or chips, that the level holds for; 0 without a level */
  uint16_t usable;              /* bits PLUMB_USABLE_...: what of this verdict may be used */
  uint16_t qualifiers;          /* bits, from PLUMB_NOT_YET_VALIDATED to PLUMB_ALIGNMENT_UNSTATED */
  plumb_transition transition;  /* sequence != 0: something changed at this sample */

  uint32_t configured;             /* all sensors: those of the next four sets together */
  uint32_t in_service;             /* the vector is made of these */
  uint32_t provisionally_excluded; /* out, reversibly */
  uint32_t excluded;               /* out: isolated as faulty */
  uint32_t absent;                 /* their channels are silent */

  uint32_t suspects;          /* faulty in some consistent hypothesis */
  uint32_t clipped;           /* at full scale in the block being collected */
  uint32_t scattering;        /* scattered beyond their noise in the block */
  uint32_t not_finite;        /* read no number in the block being collected */
  uint32_t noisy;             /* scatter while the others are at rest, last quiet block */
  uint32_t stuck;             /* repeat one value while the others predict a change, last quiet block */
  uint32_t contradicted_clip; /* at full scale while the others predict less, last quiet block */

  uint8_t sensor_cause[PLUMB_C_SENSORS]; /* why it is out of service or suspected: plumb_cause_text; 0 = it is not */
  uint8_t
      minimum_faults[PLUMB_C_SENSORS]; /* fewest faults that explain the data with it healthy; 255: no explanation */
  int32_t confirmed_grade;       /* faulty sensors, or chips, that those not excluded can still isolate for good */
  int32_t provisional_grade;     /* ... that they can exclude provisionally, by parity alone */
  int32_t consistent_hypotheses; /* sets of sensors that still explain the data */
  int32_t stations_on_record;    /* attitudes under suspicion, which count towards the timeout */
  int32_t stations_wanted;       /* attitudes that a recalibration still needs; 0 unless it collects */
  int32_t block_fill;            /* samples of the block being collected, 0 .. window */

  double statistic; /* of the test that decided: standard deviations (parity, norm) or m/s^2 (mae) */
  double limit;     /* its limit, same unit */
  double margin;    /* 1 - statistic / limit: 1 perfect, 0 at the limit, below 0 an alarm */

  double mae_all_mps2;         /* mean absolute error of the sensors in service over the window [m/s^2] */
  double mae_worst_mps2;       /* of the worst triple in service [m/s^2] */
  double mae_worst_limit_mps2; /* its limit [m/s^2] */
  double parity;               /* parity residual of the block [standard deviations] */
  double parity_limit;         /* its limit; 0: three sensors have no parity */
  double norm_error_mps2;      /* length of the vector less gravity, of the block [m/s^2] */
  double reference_mps2;       /* length of gravity that is in force [m/s^2] */
  double reference_sigma_mps2; /* its 1 sigma [m/s^2] */
  double temperature_degc;     /* last finite one [degC] */

  double gravity_mps2[3]; /* vector of the last quiet block, positive down, output frame [m/s^2] */
  double covariance[9];   /* of it, row-major [(m/s^2)^2]: noise and calibration, no acceleration of the tool */
  double age_s;           /* since the block that gave the vector [s] */
  double latest_mps2[3];  /* vector of this one sample, for which no claim is made [m/s^2] */
  /* Bounds on the angle to the truth [rad]; 0 = none (`protection_available` 0). */
  double protection_level_calibrated_axes_rad; /* in the frame of the calibrated axes */
  double protection_level_housing_rad;         /* the alignment of that frame included */
  double toolface_protection_housing_rad; /* what it means for the toolface [rad]; pi = no bound, or near vertical */

  double turn_along[3];    /* unit vector along which gravity should change, output frame; 0: any turn does */
  double turn_change_mps2; /* by how much [m/s^2] */
  double turn_angle_rad;   /* least turn that counts as another attitude [rad] */

  double drift_mps2_per_h[PLUMB_C_SENSORS]; /* slow drift of its own reading, as if it alone drifted; 0 = none */
  double noise_factor;      /* noise in stated sigmas, as blocks at rest have shown it, 1 .. 3; 1 = as stated */
  double noise_correlation; /* samples that are worth one independent one, from 1 */
  /* Gravity that is off alike at many attitudes. */
  double gravity_offset_mps2;       /* by how much [m/s^2]; 0 = none found */
  double gravity_to_configure_mps2; /* the length to configure [m/s^2]; 0 = none found */
  /* What the first attitudes contradict of the calibration. */
  double calibration_ratio; /* residuals, in what its covariance allows; 0 = nothing is contradicted */
  double
      calibration_tolerance_mps2; /* what every sensor is allowed since [m/s^2]; 0 where the calibration is refused */
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

/* Builds a monitor in `storage`: suspect, not yet validated. `*monitor` is where it stands, null on an error. Errors:
 * those of SensorArray::make and HealthMonitor::configure, and those above. */
plumb_error plumb_monitor_init(void* storage, size_t storage_size, void* workspace, size_t workspace_size,
                               const plumb_config* config, plumb_monitor** monitor) PLUMB_NOEXCEPT;
/* The same with what `plumb_monitor_snapshot` wrote under an equal configuration. With a snapshot that is damaged,
 * foreign or older it answers the error, and the monitor runs, not yet validated, as after init. */
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
