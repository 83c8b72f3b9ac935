/* The decision layer for C, as the lock-step model and the breadth-first search call it: bytes without padding, no
   pointers, sensors in general position, alone or in chips. Masks are sets of sensors, numbers of modes and events are
   those of the model.
 */
#ifndef PLUMB_MODEL_SHIM_H
#define PLUMB_MODEL_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  unsigned char mode, base;
  unsigned char in_service, provisionally_excluded, excluded, absent, readmitted;
  unsigned char not_yet_validated, timed_out, clean_run, calibrated;
} plumb_model_state;

typedef struct {
  unsigned raised, from_motion; /* one bit per event */
  unsigned char isolated, suspected, lost, back, proven, reset;
  unsigned char protection_within, passed_blocks, sensors;
  unsigned char unit[8]; /* of every sensor: those that fail with it, as a set with itself in it */
} plumb_model_input;

typedef struct {
  unsigned char event, moved, changed, adopted, from_motion;
} plumb_model_answer;

plumb_model_answer plumb_model_step(plumb_model_state* state, const plumb_model_input* input);
const char* plumb_model_mode_name(unsigned char mode);
const char* plumb_model_event_name(unsigned char event);

#ifdef __cplusplus
}
#endif
#endif
