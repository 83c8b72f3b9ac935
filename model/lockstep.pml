/* The specification in its environment, and with -DCODE the decision layer of the library in lock-step: both take every
   reachable step, and must agree on the event, the sensors it moves, whether a record is due, and everything kept.
   The library's state is part of the model checker's ("Matched"); with UNTRACKED states are missed without a word, which
   the counts of states.txt notice. */
#ifndef SENSORS
#define SENSORS 4
#endif
#ifdef UNTRACKED
#define MATCHED "UnMatched"
#else
#define MATCHED "Matched"
#endif

#ifdef CODE
c_decl {
\#include "shim.h"
extern plumb_model_state S;
extern plumb_model_input I;
extern plumb_model_answer A;
static plumb_model_state T;
static plumb_model_answer B;
}
c_track "&S" "sizeof(plumb_model_state)" MATCHED
#endif

#include "specification.pml"
#include "environment.pml"
#include "properties.pml"

c_code {
\#include "symmetry.h"
}

bit changed, agreed;

inline run_code() {
#ifdef CODE
  c_code {
    S.not_yet_validated = now.not_yet_validated; S.timed_out = now.timed_out; S.clean_run = now.clean_run;
    I.raised = now.raised; I.from_motion = now.found;
    I.isolated = now.isolated; I.suspected = now.to_aside; I.lost = now.lost; I.back = now.back;
    I.proven = now.proven; I.reset = now.named;
    I.protection_within = now.within; I.passed_blocks = R_BLOCKS; I.sensors = SENSORS;
    plumb_tell_units(I.unit);
    /* What recalibrating was entered from must be read in recalibrating alone: elsewhere another value changes nothing. */
    T = S;
    T.base = NOMINAL;
    A = plumb_model_step(&S, &I);
    B = plumb_model_step(&T, &I);
    T.base = S.base;
    now.agreed = now.mode == RECALIBRATING || (memcmp(&S, &T, sizeof S) == 0 && memcmp(&A, &B, sizeof A) == 0);
  }
#else
  skip
#endif
}

inline compare() {
#ifdef CODE
  changed = CHANGED;
  c_code {
    now.agreed = now.agreed && A.event == now.event && A.moved == now.moved && A.changed == now.changed && A.from_motion == now.in_motion && S.mode == now.mode &&
                 S.base == now.base && S.in_service == now.serving && S.provisionally_excluded == now.aside &&
                 S.excluded == now.out && S.absent == now.absent && S.readmitted == now.readmitted &&
                 S.not_yet_validated == now.not_yet_validated && S.timed_out == now.timed_out &&
                 S.clean_run == now.clean_run && S.calibrated == now.calibrated;
  }
  assert(agreed);
  changed = 0; agreed = 0
#else
  skip
#endif
}

inline tidy() {
  raised = 0; found = 0; in_motion = 0; isolated = 0; to_aside = 0; lost = 0; back = 0; proven = 0; named = 0; within = 0;
  event = NONE; does = 0; moved = 0; kind = SAMPLE; excited = 0; shows = 0; vote = 0; wrong = 0; result = 0;
  if :: !ALL_OF_IT -> suspicion = OTHER :: else fi;  /* it leads to fits alone */
  ever = (open -> ever & MONITORED : 0);
  if :: mode != RECALIBRATING -> base = SUSPECT :: else fi;
#ifdef CODE
  c_code { S.base = now.base; };
#endif
  c_code { plumb_sort(); }
}

active proctype tool() {
  atomic {
    if
    :: calibrated = 1
    :: ALL_OF_IT -> mode = INITIAL
    fi;
    d_step {
      write_table();
#ifdef CHIPS
      write_units();
#endif
      serving = ALL; not_yet_validated = 1; event = NONE;
#ifdef CODE
      c_code { S.mode = now.mode; S.base = now.base; S.in_service = now.serving; S.not_yet_validated = 1; S.calibrated = now.calibrated; };
#endif
      c_code { plumb_sort(); }
    }
  }
  do
  :: atomic {
       choose();
       d_step { look(); run_code(); machine(); follow(); c_code { plumb_tell(); }; judge(); compare(); tidy() }
     }
#ifdef CLAIMS
  :: atomic { regime == FREE ->
       if
       :: regime = CALM
       :: regime = DOUBTING
       :: regime = UNSEEN
       :: regime = VIOLATED
       :: !open && doubt == 0 && PUBLISHES(mode) && aside == 0 && COUNT(serving) > 3 ->
            pick_units(serving, broken);
            if
            :: broken != 0 && UNITS(serving & ~broken) > FLAT(serving) -> regime = FAULTY
            :: else -> broken = 0; regime = UNSEEN
            fi
       fi;
       d_step { c_code { plumb_sort(); } }
     }
#endif
  od
}
