/* The dip of the Earth's field as a second reference, for C: evidence over stations from figures of the caller, or
 * beside a monitor that has three sensors left (docs/isolation.md). Rules of memory, threads, errors, `struct_size` and
 * units are those of plumb.h. */
#ifndef PLUMB_C_PLUMB_DIP_H
#define PLUMB_C_PLUMB_DIP_H

#include "plumb/c/plumb.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a station says (plumb_dip_answer.verdict). */
enum {
  PLUMB_DIP_NOT_JUDGED = 0, /* `refusal` says why: plumb_dip_refusal_text */
  PLUMB_DIP_CONSISTENT = 1, /* no fault is needed */
  PLUMB_DIP_UNSEEN = 2,     /* none is needed, yet one of a sensor of `mirrors` would not show: it is in the bound */
  PLUMB_DIP_FAULT = 3,      /* no explanation without a fault; `named` is the sensor where one alone is left */
  PLUMB_DIP_UNEXPLAINED = 4 /* not by one faulty sensor either, or an error is beyond what was stated */
};

/* What a fault may do from station to station. */
enum { PLUMB_DIP_ANY_FAULT = 0, PLUMB_DIP_CONSTANT_BIAS = 1 };

/* The field as healthy magnetometers read it, and as it should be. Sigmas and bounds are 0 or more. */
typedef struct plumb_dip_field {
  uint32_t struct_size;  /* set by plumb_dip_field_defaults */
  int32_t reserved;      /* 0 */
  double field_nt[3];    /* mean of the magnetometers, in the frame of the array's axes [nT] */
  double axis_sigma_nt;  /* of each component: noise, 1 sigma [nT] */
  double axis_bound_nt;  /* calibration [nT] */
  double vector_nt;      /* bound on the length of what is added to the vector: interference [nT] */
  double turn_rad;       /* bound on the turn of the magnetometers against the accelerometers [rad] */
  double total_nt;       /* length by the model or survey [nT] */
  double total_sigma_nt; /* [nT] */
  double total_bound_nt; /* [nT] */
  double dip_rad;        /* -pi/2 .. pi/2, positive below the horizontal [rad] */
  double dip_sigma_rad;  /* [rad] */
  double dip_bound_rad;  /* [rad] */
} plumb_dip_field;

/* One station at rest: means over a block, and what each healthy reading may be off by. */
typedef struct plumb_dip_station {
  uint32_t struct_size;               /* set by plumb_dip_station_defaults */
  uint32_t used;                      /* bit i: sensor i serves; at most one of them is faulty */
  double mean_mps2[PLUMB_C_SENSORS];  /* calibrated [m/s^2] */
  double sigma_mps2[PLUMB_C_SENSORS]; /* noise of the mean, above 0 [m/s^2] */
  double bound_mps2[PLUMB_C_SENSORS]; /* calibration, drift, 0 or more [m/s^2] */
  double gravity_mps2;                /* its length [m/s^2] */
  double gravity_sigma_mps2;          /* 1 sigma [m/s^2] */
  double acceleration_mps2;           /* bound on a steady acceleration of the tool [m/s^2] */
  double sigmas;                      /* every sigma is taken so many times */
} plumb_dip_station;

typedef struct plumb_dip_answer {
  uint32_t struct_size;   /* set by plumb_dip_answer_defaults */
  int32_t verdict;        /* PLUMB_DIP_... */
  int32_t refusal;        /* 0 unless not judged: plumb_dip_refusal_text */
  int32_t named;          /* the faulty sensor; -1 where no single one is left */
  uint32_t suspects;      /* bit i: sensor i may be the faulty one */
  uint32_t mirrors;       /* bit i: has a possible fault that is not connected to no fault */
  double gravity_mps2[3]; /* frame of the array's axes [m/s^2] */
  double bound_rad;       /* largest angle between that and the truth; pi: none [rad] */
} plumb_dip_answer;

/* What the dip says beside the verdict of a monitor. */
typedef struct plumb_dip_report {
  uint32_t struct_size;     /* set by plumb_dip_report_defaults */
  int32_t protected_by_dip; /* 1: the bounds below are made with the dip; 0: those of the verdict stand */
  plumb_dip_answer answer;  /* what the dip says of the sensors that are left */
  double gravity_mps2[3];   /* output frame; without a sensor that is named, the verdict's [m/s^2] */
  double protection_level_calibrated_axes_rad; /* as in the verdict [rad] */
  double protection_level_housing_rad;         /* [rad] */
} plumb_dip_report;

/* No errors, no field. Error: null_pointer. */
plumb_error plumb_dip_field_defaults(plumb_dip_field* field) PLUMB_NOEXCEPT;
/* No sensor, standard gravity. Error: null_pointer. */
plumb_error plumb_dip_station_defaults(plumb_dip_station* station) PLUMB_NOEXCEPT;
/* Nothing judged, no bound. Error: null_pointer. */
plumb_error plumb_dip_answer_defaults(plumb_dip_answer* found) PLUMB_NOEXCEPT;
plumb_error plumb_dip_report_defaults(plumb_dip_report* report) PLUMB_NOEXCEPT;

const char* plumb_dip_verdict_text(int32_t verdict) PLUMB_NOEXCEPT;
const char* plumb_dip_refusal_text(int32_t refusal) PLUMB_NOEXCEPT;

typedef struct plumb_dip plumb_dip; /* lives in storage of the caller; serves either use, not both */

size_t plumb_dip_size(void) PLUMB_NOEXCEPT;
size_t plumb_dip_align(void) PLUMB_NOEXCEPT;

/* Evidence over stations that the caller makes. `axis`: `sensors` unit vectors, x y z each, not kept. Errors: those of
 * SensorArray::make; out_of_range for `assumption` (index 0); those of plumb.h. */
plumb_error plumb_dip_init(void* storage, size_t storage_size, const double* axis, int32_t sensors, int32_t assumption,
                           plumb_dip** dip) PLUMB_NOEXCEPT;
/* A station more: judged by itself after plumb_dip_forget. On an error the answer is that of the defaults. */
plumb_error plumb_dip_add(plumb_dip* dip, const plumb_dip_station* station, const plumb_dip_field* field,
                          plumb_dip_answer* found) PLUMB_NOEXCEPT;

/* Evidence beside a monitor. */
plumb_error plumb_dip_watch_init(void* storage, size_t storage_size, int32_t assumption,
                                 plumb_dip** dip) PLUMB_NOEXCEPT;
/* After a step whose verdict is a tick. `config` is that of the monitor; `workspace` as for plumb_monitor_init. On an
 * error the report is that of the defaults. */
plumb_error plumb_dip_watch_add(plumb_dip* dip, const plumb_monitor* monitor, void* workspace, size_t workspace_size,
                                const plumb_config* config, const plumb_dip_field* field,
                                plumb_dip_report* report) PLUMB_NOEXCEPT;

/* Begins anew: after an exclusion or a repair; with PLUMB_DIP_CONSTANT_BIAS whenever a fault may have begun. */
plumb_error plumb_dip_forget(plumb_dip* dip) PLUMB_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
