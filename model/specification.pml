/* The state machine of the monitor, written by hand from docs/requirements and docs/theory.md (section 5). Nothing here is
   generated and nothing of the library is included: lockstep.pml runs the compiled decision layer beside it.

   SENSORS sensors in general position. A set of sensors is a mask, bit i stands for sensor i. CHIPS, where it is defined, is
   the size of every unit: 2111 is a chip of two axes and three single sensors. Without it every sensor is a unit. */

/* Counters are smaller than in a tool (E = 4, P = 6, K = 6, M = 3, R = 3 there). With four sensors two steps of each are
   one to count and one to arrive; with more sensors, where the sets are what matters, some arrive at once. */
#if SENSORS == 4
#define E_STATIONS 2  /* stations at which the strict answer must stand; 2 anyway where only three sensors survive */
#define P_STATIONS 3  /* stations in doubt: patience */
#define K_STATIONS 2  /* stations of probation */
#define M_STATIONS 2  /* clean stations that end an episode */
#define R_BLOCKS   2  /* passed blocks in a row that earn trust */
#else
#define E_STATIONS 1
#define P_STATIONS 2
#define K_STATIONS 1
#define M_STATIONS 1
#define R_BLOCKS   1
#endif

#define ALL        ((1 << SENSORS) - 1)
#define HAS(s, i)  (((s) >> (i)) & 1)
#define COUNT(s)   (HAS(s,0) + HAS(s,1) + HAS(s,2) + HAS(s,3) + HAS(s,4) + HAS(s,5))
#define WITHIN(a, b) (((a) & ~(b)) == 0)

#include "units.pml"

/* Modes: the states, with the first calibration as a mode of its own. */
#define NOMINAL       0
#define ISOLATED      1
#define SUSPECT       2
#define DEGRADED      3
#define RECALIBRATING 4
#define INITIAL       5
#define FAILED        6
#define MODES         7

/* Events in rank order. */
#define RESET            0
#define CHANNEL_LOST     1
#define CHANNEL_BACK     2
#define EXCLUSION          3
#define PROVISIONAL_EXCLUSION        4
#define ISOLATION_TIMEOUT    5
#define NO_CONSISTENT_HYPOTHESIS    6
#define ALARM            7
#define NORM_MISMATCH        8
#define FIT_ACCEPTED     9
#define FIT_REJECTED     10
#define PROBATION_PASSED 11
#define RECALIBRATE      12
#define PASSED_BLOCK      13
#define NONE             14
#define EVENTS           14
#define BIT(e) (1 << (e))

#define IGNORED    1
#define HELD       2
#define TAKEN      3
#define IMPOSSIBLE 4

/* Where a cell leads. */
#define STAY                0
#define BY_SIZE             1
#define BY_SIZE_IF_VALIDATED   2
#define BY_SIZE_WHEN_PASSED 3
#define TO_SUSPECT          4
#define SUSPECT_OR_FAILED   5
#define STAY_OR_FAILED      6
#define BY_PROTECTION       7
#define TO_RECALIBRATING    8
#define TO_BASE             9
#define BY_RESET            10
#define TO_FAILED           11

/* What a cell does besides. */
#define NOTHING         0
#define EXCLUDE         1
#define PUT_ASIDE       2
#define MARK_ABSENT     4
#define MARK_BACK       8
#define DISCARD_FIT     16
#define RESTART_FIT     32
#define ADOPT_FIT       64
#define START_FIT       128
#define REINSTATE       256
#define RETURN_NAMED    512
#define EXHAUST         1024
#define DISTRUST        2048
#define COUNT_IT        4096

hidden byte kind_of[98];
hidden byte target_of[98];
hidden short actions_of[98];
hidden byte motion_of[98];  /* taken up from motion as well */

#define CELL(m, e, k, t, a) kind_of[m * EVENTS + e] = k; target_of[m * EVENTS + e] = t; actions_of[m * EVENTS + e] = a
#define ALSO_FROM_MOTION(m, e) motion_of[m * EVENTS + e] = 1

/* One cell a line; tests/model reads these lines and holds them against what `plumb model` prints. */
inline write_table() {
  CELL(NOMINAL, RESET,            IGNORED,    STAY,              NOTHING);
  CELL(NOMINAL, CHANNEL_LOST,     TAKEN,      BY_SIZE,           MARK_ABSENT);
  CELL(NOMINAL, CHANNEL_BACK,     TAKEN,      STAY,              MARK_BACK);
  CELL(NOMINAL, EXCLUSION,          TAKEN,      BY_SIZE,           EXCLUDE);
  CELL(NOMINAL, PROVISIONAL_EXCLUSION,        TAKEN,      SUSPECT_OR_FAILED, PUT_ASIDE);
  CELL(NOMINAL, ISOLATION_TIMEOUT,    IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(NOMINAL, NO_CONSISTENT_HYPOTHESIS,    TAKEN,      TO_SUSPECT,        NOTHING);
  CELL(NOMINAL, ALARM,            TAKEN,      TO_SUSPECT,        NOTHING);
  CELL(NOMINAL, NORM_MISMATCH,        TAKEN,      TO_SUSPECT,        NOTHING);
  CELL(NOMINAL, FIT_ACCEPTED,     IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(NOMINAL, FIT_REJECTED,     IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(NOMINAL, PROBATION_PASSED, TAKEN,      BY_SIZE,           REINSTATE);
  CELL(NOMINAL, RECALIBRATE,      TAKEN,      TO_RECALIBRATING,  START_FIT);
  CELL(NOMINAL, PASSED_BLOCK,      TAKEN,      STAY,              COUNT_IT);

  CELL(ISOLATED, RESET,            IGNORED,    STAY,              NOTHING);
  CELL(ISOLATED, CHANNEL_LOST,     TAKEN,      BY_SIZE,           MARK_ABSENT);
  CELL(ISOLATED, CHANNEL_BACK,     TAKEN,      STAY,              MARK_BACK);
  CELL(ISOLATED, EXCLUSION,          TAKEN,      BY_SIZE,           EXCLUDE);
  CELL(ISOLATED, PROVISIONAL_EXCLUSION,        TAKEN,      SUSPECT_OR_FAILED, PUT_ASIDE);
  CELL(ISOLATED, ISOLATION_TIMEOUT,    IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(ISOLATED, NO_CONSISTENT_HYPOTHESIS,    TAKEN,      TO_SUSPECT,        NOTHING);
  CELL(ISOLATED, ALARM,            TAKEN,      TO_SUSPECT,        NOTHING);
  CELL(ISOLATED, NORM_MISMATCH,        TAKEN,      TO_SUSPECT,        NOTHING);
  CELL(ISOLATED, FIT_ACCEPTED,     IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(ISOLATED, FIT_REJECTED,     IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(ISOLATED, PROBATION_PASSED, TAKEN,      BY_SIZE,           REINSTATE);
  CELL(ISOLATED, RECALIBRATE,      TAKEN,      TO_RECALIBRATING,  START_FIT);
  CELL(ISOLATED, PASSED_BLOCK,      TAKEN,      STAY,              COUNT_IT);

  CELL(SUSPECT, RESET,            IGNORED,    STAY,                NOTHING);
  CELL(SUSPECT, CHANNEL_LOST,     TAKEN,      STAY_OR_FAILED,      MARK_ABSENT);
  CELL(SUSPECT, CHANNEL_BACK,     TAKEN,      STAY,                MARK_BACK);
  CELL(SUSPECT, EXCLUSION,          TAKEN,      BY_SIZE_IF_VALIDATED,   EXCLUDE);
  CELL(SUSPECT, PROVISIONAL_EXCLUSION,        TAKEN,      STAY_OR_FAILED,      PUT_ASIDE);
  CELL(SUSPECT, ISOLATION_TIMEOUT,    TAKEN,      BY_PROTECTION,       EXHAUST);
  CELL(SUSPECT, NO_CONSISTENT_HYPOTHESIS,    TAKEN,      STAY,                COUNT_IT);
  CELL(SUSPECT, ALARM,            TAKEN,      STAY,                COUNT_IT);
  CELL(SUSPECT, NORM_MISMATCH,        TAKEN,      STAY,                COUNT_IT);
  CELL(SUSPECT, FIT_ACCEPTED,     IMPOSSIBLE, TO_FAILED,           NOTHING);
  CELL(SUSPECT, FIT_REJECTED,     IMPOSSIBLE, TO_FAILED,           NOTHING);
  CELL(SUSPECT, PROBATION_PASSED, HELD,       STAY,                NOTHING);
  CELL(SUSPECT, RECALIBRATE,      TAKEN,      TO_RECALIBRATING,    START_FIT);
  CELL(SUSPECT, PASSED_BLOCK,      TAKEN,      BY_SIZE_WHEN_PASSED, COUNT_IT);

  CELL(DEGRADED, RESET,            IGNORED,    STAY,              NOTHING);
  CELL(DEGRADED, CHANNEL_LOST,     TAKEN,      BY_SIZE,           MARK_ABSENT);
  CELL(DEGRADED, CHANNEL_BACK,     TAKEN,      STAY,              MARK_BACK);
  CELL(DEGRADED, EXCLUSION,          IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(DEGRADED, PROVISIONAL_EXCLUSION,        IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(DEGRADED, ISOLATION_TIMEOUT,    IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(DEGRADED, NO_CONSISTENT_HYPOTHESIS,    TAKEN,      TO_SUSPECT,        NOTHING);
  CELL(DEGRADED, ALARM,            TAKEN,      TO_SUSPECT,        NOTHING);
  CELL(DEGRADED, NORM_MISMATCH,        TAKEN,      TO_SUSPECT,        NOTHING);
  CELL(DEGRADED, FIT_ACCEPTED,     IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(DEGRADED, FIT_REJECTED,     IMPOSSIBLE, TO_FAILED,         NOTHING);
  CELL(DEGRADED, PROBATION_PASSED, TAKEN,      BY_SIZE,           REINSTATE);
  CELL(DEGRADED, RECALIBRATE,      TAKEN,      TO_RECALIBRATING,  START_FIT);
  CELL(DEGRADED, PASSED_BLOCK,      TAKEN,      STAY,              COUNT_IT);

  CELL(RECALIBRATING, RESET,            IGNORED, STAY,              NOTHING);
  CELL(RECALIBRATING, CHANNEL_LOST,     TAKEN,   SUSPECT_OR_FAILED, MARK_ABSENT | DISCARD_FIT);
  CELL(RECALIBRATING, CHANNEL_BACK,     TAKEN,   STAY,              MARK_BACK);
  CELL(RECALIBRATING, EXCLUSION,          TAKEN,   BY_SIZE_IF_VALIDATED, EXCLUDE | DISCARD_FIT);
  CELL(RECALIBRATING, PROVISIONAL_EXCLUSION,        TAKEN,   SUSPECT_OR_FAILED, PUT_ASIDE | DISCARD_FIT);
  CELL(RECALIBRATING, ISOLATION_TIMEOUT,    TAKEN,   TO_BASE,           DISCARD_FIT);
  CELL(RECALIBRATING, NO_CONSISTENT_HYPOTHESIS,    TAKEN,   TO_SUSPECT,        DISCARD_FIT);
  CELL(RECALIBRATING, ALARM,            TAKEN,   TO_SUSPECT,        DISCARD_FIT);
  CELL(RECALIBRATING, NORM_MISMATCH,        TAKEN,   TO_SUSPECT,        DISCARD_FIT);
  CELL(RECALIBRATING, FIT_ACCEPTED,     TAKEN,   TO_SUSPECT,        ADOPT_FIT | DISTRUST);
  CELL(RECALIBRATING, FIT_REJECTED,     TAKEN,   TO_BASE,           DISCARD_FIT);
  CELL(RECALIBRATING, PROBATION_PASSED, HELD,    STAY,              NOTHING);
  CELL(RECALIBRATING, RECALIBRATE,      IGNORED, STAY,              NOTHING);
  CELL(RECALIBRATING, PASSED_BLOCK,      TAKEN,   STAY,              COUNT_IT);

  CELL(INITIAL, RESET,            IGNORED, STAY,           NOTHING);
  CELL(INITIAL, CHANNEL_LOST,     TAKEN,   STAY_OR_FAILED, MARK_ABSENT | RESTART_FIT);
  CELL(INITIAL, CHANNEL_BACK,     TAKEN,   STAY,           MARK_BACK);
  CELL(INITIAL, EXCLUSION,          TAKEN,   STAY_OR_FAILED, EXCLUDE | RESTART_FIT);
  CELL(INITIAL, PROVISIONAL_EXCLUSION,        TAKEN,   STAY_OR_FAILED, PUT_ASIDE | RESTART_FIT);
  CELL(INITIAL, ISOLATION_TIMEOUT,    TAKEN,   STAY,           RESTART_FIT);
  CELL(INITIAL, NO_CONSISTENT_HYPOTHESIS,    TAKEN,   STAY,           RESTART_FIT);
  CELL(INITIAL, ALARM,            TAKEN,   STAY,           RESTART_FIT);
  CELL(INITIAL, NORM_MISMATCH,        TAKEN,   STAY,           RESTART_FIT);
  CELL(INITIAL, FIT_ACCEPTED,     TAKEN,   TO_SUSPECT,     ADOPT_FIT | DISTRUST);
  CELL(INITIAL, FIT_REJECTED,     TAKEN,   STAY,           COUNT_IT);
  CELL(INITIAL, PROBATION_PASSED, HELD,    STAY,           NOTHING);
  CELL(INITIAL, RECALIBRATE,      IGNORED, STAY,           NOTHING);
  CELL(INITIAL, PASSED_BLOCK,      TAKEN,   STAY,           COUNT_IT);

  CELL(FAILED, RESET,            TAKEN,   BY_RESET, RETURN_NAMED | DISTRUST);
  CELL(FAILED, CHANNEL_LOST,     TAKEN,   STAY,     MARK_ABSENT);
  CELL(FAILED, CHANNEL_BACK,     TAKEN,   STAY,     MARK_BACK);
  CELL(FAILED, EXCLUSION,          IGNORED, STAY,     NOTHING);
  CELL(FAILED, PROVISIONAL_EXCLUSION,        IGNORED, STAY,     NOTHING);
  CELL(FAILED, ISOLATION_TIMEOUT,    IGNORED, STAY,     NOTHING);
  CELL(FAILED, NO_CONSISTENT_HYPOTHESIS,    IGNORED, STAY,     NOTHING);
  CELL(FAILED, ALARM,            IGNORED, STAY,     NOTHING);
  CELL(FAILED, NORM_MISMATCH,        IGNORED, STAY,     NOTHING);
  CELL(FAILED, FIT_ACCEPTED,     IGNORED, STAY,     NOTHING);
  CELL(FAILED, FIT_REJECTED,     IGNORED, STAY,     NOTHING);
  CELL(FAILED, PROBATION_PASSED, IGNORED, STAY,     NOTHING);
  CELL(FAILED, RECALIBRATE,      IGNORED, STAY,     NOTHING);
  CELL(FAILED, PASSED_BLOCK,      IGNORED, STAY,     NOTHING);

  ALSO_FROM_MOTION(NOMINAL, PROVISIONAL_EXCLUSION);
  ALSO_FROM_MOTION(NOMINAL, ALARM);
  ALSO_FROM_MOTION(ISOLATED, PROVISIONAL_EXCLUSION);
  ALSO_FROM_MOTION(ISOLATED, ALARM);
  ALSO_FROM_MOTION(SUSPECT, PROVISIONAL_EXCLUSION);
  ALSO_FROM_MOTION(SUSPECT, ALARM);
  ALSO_FROM_MOTION(DEGRADED, ALARM);
#ifdef MOTION_CONFIRMS  /* a monitor in motion excludes for good: S7 falls */
  motion_of[NOMINAL * EVENTS + EXCLUSION] = 1; motion_of[SUSPECT * EVENTS + EXCLUSION] = 1;
#endif
}

/* --- What the monitor remembers. ------------------------------------------------------------------------------- */

/* the machine */
byte mode = SUSPECT;
byte base = SUSPECT;     /* what recalibrating was entered from */
byte serving, aside, out, absent;  /* every sensor stands in one of them (S4) */
byte readmitted;         /* has come back by probation: once is all */
bit not_yet_validated, timed_out, calibrated;
byte clean_run;

/* the evidence on record */
bit open;                /* an episode: an alarm is on record */
byte suspected;            /* in every live fault set of the confirmed grade: the complement of what live sets contain */
bit standing;            /* the survivors are alive together, so the suspected are the answer */
byte agree;              /* stations at which that answer stood */
byte doubt;              /* stations in doubt */
byte most;               /* units at most that the answer and those set aside came to in this episode */
byte clean_stations;     /* clean stations since */
byte probation, probation_stations;
byte pending;            /* what a block said while a channel event or a reset was taken */
byte suspicion;          /* what the suspicion is about: */
#define OTHER       0
#define OF_GRAVITY  1
#define NONE_ALIVE  2
bit fit;                 /* stations held out of the fit were clean */
bit held;                /* no evidence for good */

#define MONITORED (serving | aside)
#ifdef CHIPS
#define SUSPECTED (standing -> UNITS(suspected | aside) : UNITS(aside))
#else
#define SUSPECTED COUNT((standing -> suspected : 0) | aside)
#endif
/* Stations in doubt that an episode has left before the isolation timeout is over: (n + 1) P at first, n units. */
#define TO_GO ((UNITS(ALL) - most) * P_STATIONS + P_STATIONS - doubt)
#define PUBLISHES(m) ((m) == NOMINAL || (m) == ISOLATED || (m) == DEGRADED)
/* Recalibrating is published as the state it came from, the first calibration as nothing. */
#define SHOWS_OUTPUT (PUBLISHES(mode) || (mode == RECALIBRATING && base != SUSPECT))
#define VALID (SHOWS_OUTPUT && !held && kind != NO_EVIDENCE)

/* --- One step of the machine: the first event in rank order that the mode neither ignores nor holds. ------------ */

short raised;
short found;             /* what a monitor in motion says, in bits of events */
bit in_motion;           /* the event taken came from there alone */
byte isolated, to_aside, lost, back, proven, named;
bit within;              /* the doubt has a bound within the alert limit, or an explanation that the rest corroborates */
byte event;
short does;              /* the actions of the cell taken */
byte moved;              /* the sensors that the event is about */

hidden byte e_;
hidden byte left_, size_;

/* From motion only where the table says so, and no exclusion that leaves fewer than three. */
#define HEEDED(e) ((found & BIT(e)) != 0 && motion_of[mode * EVENTS + e] && \
                   (e != PROVISIONAL_EXCLUSION || COUNT(serving & ~to_aside) >= 3))

inline rank() {
  event = NONE; does = NOTHING; in_motion = 0; e_ = 0;
  do
  :: e_ >= EVENTS -> break
  :: e_ < EVENTS && ((raised & BIT(e_)) != 0 && kind_of[mode * EVENTS + e_] >= TAKEN || HEEDED(e_)) ->
       event = e_; does = actions_of[mode * EVENTS + e_]; in_motion = (raised & BIT(e_)) == 0; break
  :: else -> e_++
  od
}

inline move_sensors() {
  moved = 0;
  if
  :: does & EXCLUDE ->
       moved = isolated;
#ifdef OLD_BAN  /* who was set aside after a return was latched out with the next convicted: S1 falls */
       out = out | moved | (aside & readmitted);
       serving = (serving | (aside & ~readmitted)) & ~moved;
#else
       out = out | moved;
       serving = (serving | aside) & ~moved;           /* setting aside was no conviction: the others are acquitted */
#endif
       aside = 0
  :: does & PUT_ASIDE ->
       moved = to_aside & serving;
       serving = serving & ~moved;
       aside = aside | moved
  :: does & MARK_ABSENT ->
       moved = lost & ~absent;
       serving = serving & ~moved; aside = aside & ~moved; out = out & ~moved;
       absent = absent | moved
  :: does & MARK_BACK ->
       moved = back & absent;
       absent = absent & ~moved;
       out = out | moved
  :: does & REINSTATE ->
       moved = proven & (out | aside) & ~readmitted;
#ifdef CHIPS  /* one unit at a time, with all of it that was tested */
       moved = moved & WHOLE(moved & ((~moved) + 1));
#else
       moved = moved & ((~moved) + 1);                 /* one at a time */
#endif
       readmitted = readmitted | moved;
       out = out & ~moved; aside = aside & ~moved;
       serving = serving | moved
  :: does & RETURN_NAMED ->
       moved = named;
       out = out & ~moved; aside = aside & ~moved; absent = absent & ~moved;
       serving = serving | moved
  :: else
  fi
}

#define LEFT COUNT(serving)
#define MODE_OF_SIZE ((LEFT < 3) -> FAILED : ((LEFT == 3) -> DEGRADED : ((serving == ALL) -> NOMINAL : ISOLATED)))
#define EARNED (clean_run >= R_BLOCKS && !not_yet_validated)

inline lead() {
  if
  :: event == NONE -> left_ = STAY
  :: else -> left_ = target_of[mode * EVENTS + event]
  fi;
  if
  :: left_ == STAY
  :: left_ == BY_SIZE -> mode = MODE_OF_SIZE
  :: left_ == BY_SIZE_IF_VALIDATED -> mode = ((LEFT < 3 || !not_yet_validated) -> MODE_OF_SIZE : SUSPECT)
  :: left_ == BY_SIZE_WHEN_PASSED -> mode = (EARNED -> MODE_OF_SIZE : mode)
  :: left_ == TO_SUSPECT -> mode = SUSPECT
  :: left_ == SUSPECT_OR_FAILED -> mode = ((LEFT < 3) -> FAILED : SUSPECT)
  :: left_ == STAY_OR_FAILED -> mode = ((LEFT < 3) -> FAILED : mode)
  :: left_ == BY_PROTECTION -> mode = (within -> mode : FAILED)
  :: left_ == TO_RECALIBRATING -> mode = RECALIBRATING
  :: left_ == TO_BASE -> mode = ((base == SUSPECT) -> SUSPECT : MODE_OF_SIZE)
  :: left_ == BY_RESET -> mode = ((LEFT < 3) -> mode : (calibrated -> SUSPECT : INITIAL))
  :: left_ == TO_FAILED -> mode = FAILED
  fi
}

hidden byte was_, in_was_, monitored_was_;

inline machine() {
  rank();
  was_ = mode; in_was_ = serving; monitored_was_ = MONITORED;
  move_sensors();
  if :: does & START_FIT -> base = was_ :: else fi;
  if :: does & DISTRUST -> not_yet_validated = 1 :: else fi;
  if :: does & (EXCLUDE | RETURN_NAMED | ADOPT_FIT) -> timed_out = 0 :: does & EXHAUST -> timed_out = 1 :: else fi;
#ifdef OLD_RESET  /* a reset that brings nobody back kept the clean run: S20 falls */
  if :: serving != in_was_ || (does & ADOPT_FIT) || in_motion -> clean_run = 0 :: else fi;
#else
  if :: serving != in_was_ || (does & (ADOPT_FIT | RETURN_NAMED)) || in_motion -> clean_run = 0 :: else fi;
#endif
  if :: does & ADOPT_FIT -> calibrated = 1 :: else fi;
  lead();
  /* In failed it says that time ran out; a failure of another kind says so, whatever was before. */
  if :: mode == FAILED && was_ != FAILED && !(does & EXHAUST) -> timed_out = 0 :: else fi
}

/* --- What the step means for the evidence on record. ------------------------------------------------------------- */

inline forget_episode() {
  open = 0; suspected = 0; standing = 0; agree = 0; doubt = 0; most = 0; clean_stations = 0
}

inline follow() {
  if
  :: does & (EXCLUDE | RETURN_NAMED | ADOPT_FIT) -> forget_episode()
  :: else ->
       if
       :: MONITORED != monitored_was_ ->              /* another question: the answer does not carry over */
            standing = 0; agree = 0;
            if
            :: MONITORED & ~monitored_was_ -> suspected = 0      /* a sensor joined: all lives again */
            :: else -> suspected = suspected & MONITORED       /* lost: what died among the rest stays dead */
            fi
       :: else
       fi
  fi;
  if :: does & (REINSTATE | ADOPT_FIT) -> probation = 0; probation_stations = 0
     :: does & MARK_ABSENT ->
          probation = probation & ~moved;
          if :: probation == 0 -> probation_stations = 0 :: else fi
     :: else fi;
  if :: does & (START_FIT | DISCARD_FIT | RESTART_FIT | ADOPT_FIT) -> fit = 0 :: else fi;
  if :: serving != in_was_ -> fit = 0 :: else fi;
  if
  :: in_motion -> skip                                  /* what rest found stays the cause */
  :: !in_motion && event == NORM_MISMATCH -> suspicion = OF_GRAVITY
  :: !in_motion && event == NO_CONSISTENT_HYPOTHESIS -> suspicion = NONE_ALIVE
  :: !in_motion && (event == ALARM || event == PROVISIONAL_EXCLUSION || event == CHANNEL_LOST || event == FIT_ACCEPTED || event == EXCLUSION) ->
       suspicion = OTHER
  :: else
  fi;
  if :: mode != SUSPECT && mode != RECALIBRATING -> suspicion = OTHER :: else fi;
  pending = 0;
  if
  :: event <= CHANNEL_BACK -> pending = (raised & (BIT(NO_CONSISTENT_HYPOTHESIS) | BIT(ALARM) | BIT(NORM_MISMATCH))) >> NO_CONSISTENT_HYPOTHESIS
  :: else
  fi
}

/* The condition for which the host had a fit made is no news while that fit is being made. */
#define EXPECTED(e, s) (mode == RECALIBRATING && base == SUSPECT && suspicion == (s))

#define MAY_RECALIBRATE (aside == 0 && \
  ((PUBLISHES(mode) && !open && !not_yet_validated) || \
   (mode == SUSPECT && LEFT > 3 && (suspicion == NONE_ALIVE || (suspicion == OF_GRAVITY && !open)))))

#define PATIENCE_ENDS ((mode == SUSPECT || mode == RECALIBRATING) && doubt >= P_STATIONS)

#define NEEDED ((COUNT(MONITORED & ~suspected) <= 3 && E_STATIONS < 2) -> 2 : E_STATIONS)
