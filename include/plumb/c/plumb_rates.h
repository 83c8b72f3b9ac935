/* Redundant gyros for C: `RateMonitor` in memory that the caller owns, and the median of gyro triads (docs/motion.md,
 * Redundant gyros). Rules of memory, threads, errors, `struct_size` and units are those of plumb.h. */
#ifndef PLUMB_C_PLUMB_RATES_H
#define PLUMB_C_PLUMB_RATES_H

#include "plumb/c/plumb_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PLUMB_C_TRIADS 8 /* room for the median */

/* One gyro axis; bounds are of a healthy one, noise alone is 1 sigma. */
typedef struct plumb_gyro_axis {
  uint32_t struct_size;    /* set by plumb_gyro_axis_defaults */
  int32_t chip;            /* axes of one chip bear the same number, 1 .. 255; 0 = a unit of its own */
  double axis[3];          /* unit vector of the calibrated axis, tool frame */
  double sigma_radps;      /* white noise of one sample, 1 sigma, above 0 [rad/s] */
  double scale_bound;      /* relative, 0 .. 0.5 */
  double axis_bound_rad;   /* turn of the axis, 0 .. 0.5 [rad] */
  double bias_bound_radps; /* 0 .. 100 [rad/s] */
  double lag_bound_s;      /* skew against the others, and what bandwidths differ by, as a time, 0 .. 1 [s] */
  double g_sensitivity_bound_s_per_m; /* shift of the reading per specific force, 0 .. 1 [(rad/s) / (m/s^2)] */
} plumb_gyro_axis;

typedef struct plumb_rates_config {
  uint32_t struct_size;        /* set by plumb_rates_config_defaults */
  int32_t axes;                /* 3 .. plumb_motion_capacity() */
  const plumb_gyro_axis* axis; /* so many of them; not kept */
  /* A value of the following out of its range is out_of_range or not_finite with the index that
   * plumb/motion/motion_setup.hpp gives for it, from 100 on; 120 is at_rest_radps and 121 force_bound_mps2. */
  int32_t max_faults;           /* units at fault at once that are searched for, 0 .. 4 */
  int32_t reserved;             /* 0 */
  int32_t block_samples[4];     /* 1, then multiples of the one before, .. 4096; the third is that of the block rate */
  double sample_period_s;       /* 1e-5 .. 1 [s] */
  double rate_bound_radps;      /* the fastest that the tool turns, averaged over two blocks, above 0 .. 1000 [rad/s] */
  double force_bound_mps2;      /* the largest specific force, where a sample does not say it, 0 .. 1e5 [m/s^2] */
  double at_rest_radps;         /* the fastest that the tool turns while it is said to be at rest, 0 .. 10 [rad/s] */
  double false_alarms_per_hour; /* 1e-9 .. 1 */
  double dwell_s;               /* an axis is excluded once it has been isolated for so long, 0 .. 10 [s] */
  double quiet_s;               /* evidence is forgotten after so long without any new, 0 .. 3600 [s] */
} plumb_rates_config;

/* One reading of all gyro axes at one instant. */
typedef struct plumb_rates_sample {
  uint32_t struct_size;                      /* set by plumb_rates_sample_defaults */
  uint32_t delivered;                        /* bit i: axis i has a reading */
  uint32_t clipped;                          /* bit i: axis i is at full scale */
  int32_t at_rest;                           /* 1: the host knows, by accelerometers above all, that the tool stands */
  double time_s;                             /* increasing [s] */
  double force_mps2;                         /* length of the specific force; below 0 or not finite: unknown [m/s^2] */
  double rate_radps[PLUMB_C_MOTION_SENSORS]; /* along each axis, calibrated [rad/s] */
} plumb_rates_sample;

/* Angular rate: a weighted mean over two adjacent blocks. */
typedef struct plumb_angular_rate {
  int32_t validity;             /* plumb_force_validity */
  uint32_t used;                /* bit i: axis i is in it */
  double time_s;                /* the instant that it belongs to [s] */
  double span_s;                /* length of each of the two blocks [s] */
  double rate_radps[3];         /* tool frame [rad/s] */
  double covariance_rad2ps2[9]; /* of the noise alone, row-major [(rad/s)^2] */
  double bound_radps;           /* of the length of the error [rad/s]; infinite: none */
} plumb_angular_rate;

typedef struct plumb_rates_verdict {
  uint32_t struct_size;   /* set by plumb_rates_verdict_defaults */
  uint32_t suspects;      /* bit i: in some of the smallest explanations */
  uint32_t isolated;      /* bit i: in every explanation, or off zero at rest; not excluded yet */
  uint32_t excluded;      /* bit i: provisionally, by parity */
  uint32_t off_at_rest;   /* bit i: suspected by parity, and read at rest what no healthy axis does */
  int32_t alarm;          /* 1: readings contradict each other */
  int32_t turned_at_rest; /* 1: axes read a rate at rest and nobody is suspected: the tool turned, or a small fault */
  int32_t block_ended;    /* 1: `block` is new with this sample */
  int32_t cause;          /* why nobody is isolated, or nothing is judged: plumb_motion_cause_text */
  int32_t reserved;       /* 0 */
  plumb_angular_rate sample; /* of the last two samples */
  plumb_angular_rate block;  /* of the last two blocks of block_samples[2] samples: tighter and later */
} plumb_rates_verdict;

/* No errors, a unit of its own; axis and noise are the caller's. Error: null_pointer. */
plumb_error plumb_gyro_axis_defaults(plumb_gyro_axis* axis) PLUMB_NOEXCEPT;
/* Everything but the axes. Error: null_pointer. */
plumb_error plumb_rates_config_defaults(plumb_rates_config* config) PLUMB_NOEXCEPT;
/* Nothing delivered, force unknown, not at rest. Error: null_pointer. */
plumb_error plumb_rates_sample_defaults(plumb_rates_sample* sample) PLUMB_NOEXCEPT;
/* A verdict that is none: no rate, no bound. Error: null_pointer. */
plumb_error plumb_rates_verdict_defaults(plumb_rates_verdict* verdict) PLUMB_NOEXCEPT;

typedef struct plumb_rates plumb_rates; /* lives in storage of the caller */

size_t plumb_rates_size(void) PLUMB_NOEXCEPT;
size_t plumb_rates_align(void) PLUMB_NOEXCEPT;

/* Builds a monitor in `storage`; `*rates` is where it stands, null on an error. Errors: those of SensorArray::make and
 * RateMonitor::configure, and those of plumb.h. */
plumb_error plumb_rates_init(void* storage, size_t storage_size, const plumb_rates_config* config,
                             plumb_rates** rates) PLUMB_NOEXCEPT;
/* One sample in, one verdict out (`verdict` may be null). Any bit pattern is taken; bounded work. On an error the
 * verdict becomes that of plumb_rates_verdict_defaults. */
plumb_error plumb_rates_step(plumb_rates* rates, const plumb_rates_sample* sample,
                             plumb_rates_verdict* verdict) PLUMB_NOEXCEPT;
/* Takes back exclusions and evidence. */
plumb_error plumb_rates_forget(plumb_rates* rates) PLUMB_NOEXCEPT;

/* One sample of several gyro triads, each calibrated and turned to the tool frame. */
typedef struct plumb_triad_rates {
  uint32_t struct_size;                 /* set by plumb_triad_rates_defaults */
  int32_t triads;                       /* 0 .. PLUMB_C_TRIADS */
  uint32_t given;                       /* bit k: triad k has a rate; one that is not finite counts as not given */
  int32_t faults;                       /* so many may be faulty at once: it takes 2 faults + 1 that are given */
  double rate_radps[PLUMB_C_TRIADS][3]; /* tool frame [rad/s] */
} plumb_triad_rates;
/* No triad, one fault. Error: null_pointer. */
plumb_error plumb_triad_rates_defaults(plumb_triad_rates* rates) PLUMB_NOEXCEPT;
/* The median, component by component: no further off than a healthy triad may be while at most `faults` are faulty.
 * For plumb_motion_sample.rate_radps[0], with gyro_corroborated = 1. `*given` = 1, or 0 where too few deliver; the rate
 * is then zero, as on an error. Errors: null_pointer, wrong_struct; out_of_range for triads (index 0). */
plumb_error plumb_median_rate(const plumb_triad_rates* rates, double rate_radps[3], int32_t* given) PLUMB_NOEXCEPT;

/* Bounds of every healthy triad. */
typedef struct plumb_triad_bounds {
  uint32_t struct_size;   /* set by plumb_triad_bounds_defaults */
  int32_t reserved;       /* 0 */
  double scale;           /* relative, 0 or more */
  double axis_rad;        /* turn of its axes, 0 or more [rad] */
  double bias_radps;      /* 0 or more [rad/s] */
  double noise_radps;     /* of a sample, 1 sigma, 0 or more [rad/s] */
  double noise_in_sigmas; /* noise is taken to be within so many sigmas of each sample, 0 or more */
} plumb_triad_bounds;
/* No errors; noise within six sigmas. Error: null_pointer. */
plumb_error plumb_triad_bounds_defaults(plumb_triad_bounds* bounds) PLUMB_NOEXCEPT;
/* What the median at this length of the rate is off by at most, in length [rad/s], its lag left out. For
 * plumb_motion_sample.rate_error_radps[0]. What triads lag each other by is no delay of their median: add sqrt(3)
 * times the largest lag times the angular acceleration. Infinite where the bounds are so wide that the rate says
 * nothing, and on an error. Errors: null_pointer, wrong_struct; not_finite and out_of_range with index 0 .. 4, the
 * bound in its order, or 5, the rate. */
plumb_error plumb_median_error(const plumb_triad_bounds* bounds, double rate_radps, double* error_radps) PLUMB_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
