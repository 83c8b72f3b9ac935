/* plumb in motion for C: `MotionMonitor` (docs/motion.md) in memory that the caller owns. It stands beside the monitor
 * of plumb.h, which judges at rest, and needs neither gravity nor rest. Rules of memory, threads, errors, `struct_size`
 * and units are those of plumb.h.
 *
 * All figures of errors are bounds of healthy sensors, not standard deviations; noise alone is 1 sigma. */
#ifndef PLUMB_C_PLUMB_MOTION_H
#define PLUMB_C_PLUMB_MOTION_H

#include "plumb/c/plumb.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Room in the structs: sensors that are judged in motion; `plumb_motion_capacity()` says how many the library takes. */
#define PLUMB_C_MOTION_SENSORS 12
#define PLUMB_C_GYROS 2

typedef struct plumb_motion_sensor {
  uint32_t struct_size;       /* set by plumb_motion_sensor_defaults */
  int32_t chip;               /* sensors of one chip bear the same number, 1 .. 255; 0 = a unit of its own */
  double axis[3];             /* unit vector of the calibrated axis, tool frame */
  double sigma_mps2;          /* white noise of one sample, 1 sigma, above 0 [m/s^2] */
  double lever_arm_m[3];      /* from the reference point, tool frame, +-100 [m] */
  double lever_bound_m;       /* of each component of it, 0 .. 1 [m] */
  double lag_bound_s;         /* skew against the others, and what the bandwidths differ by, as a time, 0 .. 1 [s] */
  double rectification_bound; /* shift of the mean per mean square of the reading, 0 .. 1 [(m/s^2) / (m/s^2)^2] */
  double scale_bound;         /* relative, 0 .. 0.5 */
  double axis_bound_rad;      /* turn of the axis, 0 .. 0.5 [rad] */
  double bias_bound_mps2;     /* 0 .. 100 [m/s^2] */
} plumb_motion_sensor;

typedef struct plumb_motion_config {
  uint32_t struct_size;              /* set by plumb_motion_config_defaults */
  int32_t sensors;                   /* 3 .. plumb_motion_capacity() */
  const plumb_motion_sensor* sensor; /* so many of them; not kept */
  /* A value of the following out of its range is out_of_range with the index that plumb/motion/motion_setup.hpp gives
   * for it, from 100 on. */
  int32_t gyros;                /* triads in every sample, 0 .. 2 */
  int32_t gyro_corroborated;    /* 1: the host knows by other means that the gyro is right */
  int32_t max_faults;           /* units at fault at once that are searched for, 0 .. 4 */
  int32_t shortest_block;       /* samples of the shortest blocks judged, 1 .. block_samples[2] */
  int32_t block_samples[4];     /* 1, then multiples of the one before, .. 4096; the third is that of the block force */
  double sample_period_s;       /* 1e-5 .. 1 [s] */
  double gyro_scale_bound;      /* relative, 0 .. 0.4 */
  double gyro_axis_bound_rad;   /* turn of its axes, 0 .. 0.4 [rad] */
  double gyro_bias_bound_radps; /* 0 .. 10 [rad/s] */
  double gyro_noise_radps;      /* of a sample, 1 sigma, 0 .. 10 [rad/s] */
  double gyro_lag_bound_s;      /* against the accelerometers, 0 .. 1 [s] */
  double rate_bound_radps;      /* the fastest that the tool turns, .. 1000 [rad/s]; 0 = unknown */
  double force_bound_mps2;      /* the largest specific force, averaged over two blocks, 0 .. 1e5 [m/s^2] */
  double false_alarms_per_hour; /* 1e-9 .. 1 */
  double dwell_s;               /* a sensor is excluded once it has been isolated for so long, 0 .. 10 [s] */
  double quiet_s;               /* evidence is forgotten after so long without any new, 0 .. 3600 [s] */
} plumb_motion_config;

/* Everything but the sensors and gyros. Error: null_pointer. */
plumb_error plumb_motion_config_defaults(plumb_motion_config* config) PLUMB_NOEXCEPT;
/* No arm, no errors, a unit of its own; axis and noise are the caller's. Error: null_pointer. */
plumb_error plumb_motion_sensor_defaults(plumb_motion_sensor* sensor) PLUMB_NOEXCEPT;

/* One reading of all accelerometers and gyros at one instant. */
typedef struct plumb_motion_sample {
  uint32_t struct_size;                        /* set by plumb_motion_sample_defaults */
  uint32_t delivered;                          /* bit i: sensor i has a reading */
  uint32_t clipped;                            /* bit i: sensor i is at full scale */
  uint32_t rates_given;                        /* bit g: gyro g has a reading */
  double time_s;                               /* increasing [s] */
  double reading_mps2[PLUMB_C_MOTION_SENSORS]; /* specific force along each axis, calibrated [m/s^2] */
  double rate_radps[PLUMB_C_GYROS][3];         /* tool frame [rad/s] */
  /* What each rate is off by beside the bounds of the gyro, in length, 0 or more; of a median plumb_median_error of
   * plumb_rates.h. plumb_clocks_push does not read it. [rad/s] */
  double rate_error_radps[PLUMB_C_GYROS];
} plumb_motion_sample;
/* Nothing delivered. Error: null_pointer. */
plumb_error plumb_motion_sample_defaults(plumb_motion_sample* sample) PLUMB_NOEXCEPT;

/* Numbers of `validity`, `dominant` and `cause`: those of ForceValidity, ForceTerm (plumb/motion/motion_force.hpp) and
 * MotionCause (plumb/motion/motion_monitor.hpp). */
enum plumb_force_validity { PLUMB_FORCE_NONE, PLUMB_FORCE_UNCHECKED, PLUMB_FORCE_BOUNDED };

/* Specific force at the reference point: a weighted mean over two adjacent blocks. */
typedef struct plumb_specific_force {
  int32_t validity;           /* plumb_force_validity */
  int32_t dominant;           /* the largest part of the bound */
  uint32_t used;              /* bit i: sensor i is in it */
  int32_t gyro_assumed;       /* 1: the bound holds while the only gyro is healthy */
  double time_s;              /* the instant that it belongs to [s] */
  double span_s;              /* length of each of the two blocks [s] */
  double force_mps2[3];       /* tool frame [m/s^2] */
  double covariance_m2ps4[9]; /* of the noise alone, row-major [(m/s^2)^2] */
  double bound_mps2;          /* of the length of the error [m/s^2]; infinite: none */
} plumb_specific_force;

typedef struct plumb_motion_verdict {
  uint32_t struct_size;        /* set by plumb_motion_verdict_defaults */
  uint32_t rejected;           /* bit i: in a set that the last sample's blocks rejected */
  uint32_t suspects;           /* bit i: in some of the smallest explanations */
  uint32_t isolated;           /* bit i: in every explanation */
  uint32_t excluded;           /* bit i: provisionally, by this monitor */
  int32_t alarm;               /* 1: readings contradict each other */
  int32_t block_ended;         /* 1: `block` is new with this sample */
  int32_t least_faults;        /* units that it takes at least to explain what is on record */
  int32_t cause;               /* why nobody is isolated, or nothing is judged */
  int32_t gyros_disagree;      /* 1: one of the two gyros is faulty, and which one is not told */
  plumb_specific_force sample; /* of the last two samples */
  plumb_specific_force block;  /* of the last two blocks of 32 samples: tighter and later */
} plumb_motion_verdict;
/* A verdict that is none: no force, no bound. Error: null_pointer. */
plumb_error plumb_motion_verdict_defaults(plumb_motion_verdict* verdict) PLUMB_NOEXCEPT;

/* Names of the numbers, for a log. Never null. */
const char* plumb_force_validity_text(int32_t validity) PLUMB_NOEXCEPT;
const char* plumb_force_term_text(int32_t term) PLUMB_NOEXCEPT;
const char* plumb_motion_cause_text(int32_t cause) PLUMB_NOEXCEPT;

typedef struct plumb_motion plumb_motion; /* lives in storage of the caller */

int32_t plumb_motion_capacity(void) PLUMB_NOEXCEPT;
size_t plumb_motion_size(void) PLUMB_NOEXCEPT;
size_t plumb_motion_align(void) PLUMB_NOEXCEPT;

/* Builds a monitor in `storage`; `*motion` is where it stands, null on an error. Errors: those of SensorArray::make and
 * MotionMonitor::configure, and those of plumb.h. */
plumb_error plumb_motion_init(void* storage, size_t storage_size, const plumb_motion_config* config,
                              plumb_motion** motion) PLUMB_NOEXCEPT;
/* One sample in, one verdict out (`verdict` may be null). Any bit pattern is taken; bounded work. On an error the
 * verdict becomes that of plumb_motion_verdict_defaults. */
plumb_error plumb_motion_step(plumb_motion* motion, const plumb_motion_sample* sample,
                              plumb_motion_verdict* verdict) PLUMB_NOEXCEPT;
/* The sensors that others, a monitor at rest above all, leave in service. */
plumb_error plumb_motion_set_in_service(plumb_motion* motion, uint32_t sensors) PLUMB_NOEXCEPT;
/* Takes back exclusions and evidence: after rest has confirmed or refuted them. */
plumb_error plumb_motion_forget(plumb_motion* motion) PLUMB_NOEXCEPT;

/* Chips with clocks of their own (docs/motion.md): their samples are brought to common instants before the monitor
 * judges them, and what that may add is in its limits. */

/* One clock, and what is sampled by it. A sample stamped s counts at the common time
 * s - offset_s - rate (s - since_s). */
typedef struct plumb_chip_clock {
  uint32_t struct_size;   /* set by plumb_chip_clock_defaults */
  uint32_t sensors;       /* bit i: sensor i; every sensor has one clock */
  uint32_t gyros;         /* bit g: gyro g; likewise */
  int32_t reserved;       /* 0 */
  double sample_period_s; /* of the chip; each step within a tenth of it, 1e-5 .. 1 [s] */
  double offset_s;        /* by which it is ahead of the common clock at since_s [s] */
  double rate;            /* which it gains beside, +-0.05 [s/s] */
  double since_s;         /* by this clock [s] */
  double valid_s;         /* the bounds hold for so long before and after since_s [s] */
  double offset_bound_s;  /* offset_bound_s + rate_bound valid_s is at most one common period [s] */
  double rate_bound;      /* 0 .. 0.05 [s/s] */
} plumb_chip_clock;
/* Exact, for an hour; sensors and gyros are the caller's. Error: null_pointer. */
plumb_error plumb_chip_clock_defaults(plumb_chip_clock* clock) PLUMB_NOEXCEPT;

/* Numbers that plumb_clocks_push answers with: those of ClockPush (plumb/motion/motion_clocks.hpp). */
const char* plumb_clock_push_text(int32_t push) PLUMB_NOEXCEPT;

typedef struct plumb_clocks plumb_clocks; /* lives in storage of the caller; a plumb_motion is in it */

int32_t plumb_clocks_capacity(void) PLUMB_NOEXCEPT; /* most clocks */
size_t plumb_clocks_size(void) PLUMB_NOEXCEPT;
size_t plumb_clocks_align(void) PLUMB_NOEXCEPT;

/* Builds clocks and monitor in `storage`; `config` states chips as they are, and what clocks add is put on top.
 * `wait_s`: a chip that has not delivered so long after an instant is left out, 5 to 40 sample periods of each chip
 * [s]. Errors: those of plumb_motion_init, and those that plumb/motion/motion_clocks.hpp gives with their indices. */
plumb_error plumb_clocks_init(void* storage, size_t storage_size, const plumb_motion_config* config,
                              const plumb_chip_clock* clock, int32_t clocks, double wait_s,
                              plumb_clocks** made) PLUMB_NOEXCEPT;
/* A sample of one chip, with its own time; `push` (may be null) says what became of it. Any bit pattern is taken. */
plumb_error plumb_clocks_push(plumb_clocks* clocks, int32_t clock, const plumb_motion_sample* sample,
                              int32_t* push) PLUMB_NOEXCEPT;
/* After a clock has been compared with the common one again. */
plumb_error plumb_clocks_set(plumb_clocks* clocks, int32_t clock, double offset_s, double rate,
                             double since_s) PLUMB_NOEXCEPT;
/* The verdict of the next common instant, `*drawn` = 1, or 0 where it is not due yet: call it until then. `now_s`: the
 * common time. On an error the verdict becomes that of plumb_motion_verdict_defaults. */
plumb_error plumb_clocks_next(plumb_clocks* clocks, double now_s, plumb_motion_verdict* verdict,
                              int32_t* drawn) PLUMB_NOEXCEPT;
/* The monitor, for plumb_motion_set_in_service and plumb_motion_forget; null where there is none. */
plumb_motion* plumb_clocks_motion(plumb_clocks* clocks) PLUMB_NOEXCEPT;

/* Inclination of an axis of the tool while it moves: an interval, once per window, from the force that the monitor of
 * motion publishes (`ContinuousInclination`, docs/motion.md, docs/theory.md T13). */
typedef struct plumb_inclination_config {
  uint32_t struct_size;      /* set by plumb_inclination_config_defaults */
  double axis[3];            /* unit vector, tool frame; along the hole and downwards for a drilling tool */
  double axis_bound_rad;     /* how far the axis that is meant may be from it, 0 .. pi; no default [rad] */
  double velocity_bound_mps; /* velocity less some constant one, within a window, 0 .. 100; no default [m/s] */
  double window_s;           /* 128 sample periods .. 600 [s] */
  double gravity_mps2;       /* 1 .. 30 [m/s^2] */
  double gravity_bound_mps2; /* of what is stated as gravity, 0 .. 0.5 [m/s^2] */
} plumb_inclination_config;
/* Axis z and standard gravity; bounds without a default are not numbers, and refused. Error: null_pointer. */
plumb_error plumb_inclination_config_defaults(plumb_inclination_config* config) PLUMB_NOEXCEPT;

/* Numbers of `status` and `widest`: those of InclinationStatus and InclinationTerm
 * (plumb/motion/continuous_inclination.hpp). */
enum plumb_inclination_status {
  PLUMB_INCLINATION_FILLING,
  PLUMB_INCLINATION_KNOWN,
  PLUMB_INCLINATION_NO_FORCE,
  PLUMB_INCLINATION_RATE_UNKNOWN,
  PLUMB_INCLINATION_IRREGULAR_TIME,
  PLUMB_INCLINATION_CONTRADICTS_GRAVITY
};

typedef struct plumb_inclination_interval {
  uint32_t struct_size;     /* set by plumb_inclination_interval_defaults */
  int32_t status;           /* plumb_inclination_status: the angles count with KNOWN alone */
  int32_t is_new;           /* 1: a window has ended with this sample, or another status has begun */
  int32_t widest;           /* the largest part of the interval */
  int32_t gyro_assumed;     /* 1: it holds while the only gyro is healthy */
  double time_s;            /* the middle of the window [s] */
  double span_s;            /* its length [s] */
  double inclination_rad;   /* against gravity, 0 .. pi; its cosine is the mean cosine over the window [rad] */
  double low_rad, high_rad; /* it lies between these [rad] */
} plumb_inclination_interval;
/* No window has ended. Error: null_pointer. */
plumb_error plumb_inclination_interval_defaults(plumb_inclination_interval* interval) PLUMB_NOEXCEPT;

const char* plumb_inclination_status_text(int32_t status) PLUMB_NOEXCEPT;
const char* plumb_inclination_term_text(int32_t term) PLUMB_NOEXCEPT;

typedef struct plumb_inclination plumb_inclination; /* lives in storage of the caller */

size_t plumb_inclination_size(void) PLUMB_NOEXCEPT;
size_t plumb_inclination_align(void) PLUMB_NOEXCEPT;

/* `motion`: what plumb_motion_init was given. Errors: those of ContinuousInclination::configure (index 200 .. 205 for a
 * value of `config`), and those of plumb_motion_init; `*inclination` is null on an error. */
plumb_error plumb_inclination_init(void* storage, size_t storage_size, const plumb_motion_config* motion,
                                   const plumb_inclination_config* config,
                                   plumb_inclination** inclination) PLUMB_NOEXCEPT;
/* After plumb_motion_step, with the same sample and the monitor that judged it. `interval` is the last one, new or not.
 * On an error it becomes that of plumb_inclination_interval_defaults, and the sample is not taken. */
plumb_error plumb_inclination_step(plumb_inclination* inclination, const plumb_motion_sample* sample,
                                   const plumb_motion* motion, plumb_inclination_interval* interval) PLUMB_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
