/* What must hold at every step (assertions, by the names of docs/properties.md) and of every run (claims).
   The values before the step are taken by `look`, those after it are judged by `judge`. */

hidden byte m0_, serving0_, aside0_, out0_, absent0_, readmitted0_, ever0_, suspected0_, open0_, run0_, monitored0_;
hidden byte unproven0_, fit0_, timed0_;
bit alarmed;      /* a block spoke against the tool since the collection of stations began */

inline look() {
  m0_ = mode; serving0_ = serving; aside0_ = aside; out0_ = out; absent0_ = absent; monitored0_ = MONITORED;
  readmitted0_ = readmitted; ever0_ = ever; suspected0_ = suspected; open0_ = open;
  run0_ = clean_run; unproven0_ = not_yet_validated; fit0_ = fit; timed0_ = timed_out;
  if
  :: raised & (BIT(ALARM) | BIT(NO_CONSISTENT_HYPOTHESIS) | BIT(NORM_MISMATCH)) -> alarmed = (mode == RECALIBRATING || mode == INITIAL)
  :: else
  fi
}

#define LEFT_SERVICE (serving0_ & ~serving)
#define CAME_BACK    (serving & ~serving0_)
#define DOUBTED (event == ALARM || event == NO_CONSISTENT_HYPOTHESIS || event == NORM_MISMATCH || event == PROVISIONAL_EXCLUSION)
#define CHANGED (mode != m0_ || serving != serving0_ || aside != aside0_ || out != out0_ || absent != absent0_)

inline judge() {
#ifdef CHIPS
  /* REQ-206: a unit leaves with all of it that served, and returns with all of it that was tested. */
  if
  :: event == EXCLUSION || event == PROVISIONAL_EXCLUSION ->
       assert(WITHIN(WHOLE(moved) & serving0_, moved) && (WHOLE(moved) & serving) == 0)
  :: event == PROBATION_PASSED -> assert(UNITS(moved) <= 1 && WITHIN(WHOLE(moved) & proven & (out0_ | aside0_), moved))
  :: else
  fi;
#endif
  /* S4: one place for every sensor */
  assert((serving | aside | out | absent) == ALL && COUNT(serving) + COUNT(aside) + COUNT(out) + COUNT(absent) == SENSORS);
  /* S3: fewer than three in service is failed; failed publishes nothing */
  assert(LEFT >= 3 || mode == FAILED);
  assert(mode != FAILED || !VALID);
  /* what the states mean */
  assert(mode != NOMINAL || serving == ALL);
  assert(mode != ISOLATED || (LEFT > 3 && serving != ALL));
  assert(mode != DEGRADED || LEFT == 3);
  assert(event == NONE || kind_of[m0_ * EVENTS + event] != IMPOSSIBLE);
  /* S5 */
  assert(m0_ != FAILED || mode == FAILED || event == RESET);
  /* S7: confirmed exclusion never from motion, failed never from motion: to suspect at most, nobody taken out for good or
     brought back, and nothing counted that rest counts */
  assert(!in_motion || (mode == SUSPECT && out == out0_ && absent == absent0_ && readmitted == readmitted0_ &&
                        WITHIN(serving, serving0_) && clean_run == 0 && not_yet_validated == unproven0_ && timed_out == timed0_));
  /* S1: an exclusion takes nobody who was healthy throughout the episode, and nobody but whom it names; nor does
     setting aside at rest while four are healthy */
  if
  :: event == EXCLUSION ->
       assert(WITHIN(moved, ever0_) && WITHIN(out & ~out0_, moved))
  :: event == PROVISIONAL_EXCLUSION && !in_motion && UNITS(monitored0_ & ~ever0_) >= FLAT(monitored0_) + 2 -> assert(WITHIN(moved, ever0_))
  :: else
  fi;
  /* S6: only the suspected, after their stations, and never so that fewer than three are left */
  if
  :: event == EXCLUSION -> assert(moved == suspected0_ && moved != 0 && open0_ && COUNT(monitored0_ & ~moved) >= 3)
  :: else
  fi;
  /* S6, S7: nobody leaves the service but by a culprit, a set-aside, a silence */
  assert(WITHIN(LEFT_SERVICE, (event == EXCLUSION || event == PROVISIONAL_EXCLUSION || event == CHANNEL_LOST -> moved : 0)));
  assert(!(kind == NO_EVIDENCE && event == NONE) || !CHANGED);
  /* S8: adopted only what was collected since the last word against the tool, and only on acceptance */
  if
  :: does & ADOPT_FIT -> assert(event == FIT_ACCEPTED && (m0_ == RECALIBRATING || m0_ == INITIAL) && !alarmed && fit0_)
  :: else
  fi;
  /* S9: back by probation, by acquittal of who was only set aside, or by the operator out of failed */
  assert(WITHIN(CAME_BACK, (event == PROBATION_PASSED || (event == RESET && m0_ == FAILED) -> moved :
                            (event == EXCLUSION -> aside0_ : 0))));
  assert(event != PROBATION_PASSED || UNITS(CAME_BACK) <= 1);
  /* S10: who has come back by probation once does not do so again, and nobody excluded comes back by an acquittal */
  assert(event != PROBATION_PASSED || WITHIN(CAME_BACK, readmitted & ~readmitted0_));
  assert(event == RESET || WITHIN(CAME_BACK & out0_, readmitted & ~readmitted0_));
  assert(WITHIN(readmitted0_, readmitted));
  /* S12: isolation timeout is bounded by a protection level, or an explanation is left that the rest corroborates, or failed.
     It is over after (n + 1) P stations in doubt at most: each of them takes one from what is left (TO_GO), and nothing
     but the end of the episode gives any back. */
  assert(most <= UNITS(ALL) && doubt <= P_STATIONS);
  assert(event != ISOLATION_TIMEOUT || m0_ != SUSPECT || (within -> (mode == SUSPECT && timed_out) : mode == FAILED));
  /* In failed the qualifier tells a failure by patience from one by what is left. */
  assert(mode != FAILED || m0_ == FAILED || timed_out == (event == ISOLATION_TIMEOUT));
  /* S14: within an episode the suspected only grow, but for those that are gone, and for a sensor that joined */
  assert(!(open0_ && open) || CAME_BACK & ~monitored0_ || WITHIN(suspected0_ & MONITORED, suspected));
  /* S15: a step that changes something has an event to record */
  assert(!CHANGED || event != NONE);
  /* S16: an alarm ends recalibration, and nothing collected outlives it */
  assert(!(DOUBTED && m0_ == RECALIBRATING) || (mode != RECALIBRATING && !fit));
  assert(!(DOUBTED && m0_ == INITIAL) || !fit);
  /* S17: doubt and no evidence never leave the monitor in a state that shows output without regard to them: in suspect it
     is valid within its bound only, of which this model knows nothing but `within` */
  assert(!DOUBTED || !VALID);
  assert(!(kind == NO_EVIDENCE) || !VALID);
  assert(!not_yet_validated || !SHOWS_OUTPUT);
  assert(!(kind == ALARMING || kind == OFF_GRAVITY) || event == EXCLUSION || !VALID || event <= CHANNEL_BACK);
  /* S19 */
  assert(calibrated || mode == INITIAL || mode == FAILED);
  /* S20: adopted means suspect and not yet validated, and out of suspect only what has been clean for long enough */
  assert(!(does & ADOPT_FIT) || (mode == SUSPECT && not_yet_validated && clean_run == 0));
  assert(!(m0_ == SUSPECT && PUBLISHES(mode)) || event == EXCLUSION ||
         (event == PASSED_BLOCK && run0_ >= R_BLOCKS && !unproven0_));
  assert(event != RESET || mode == FAILED || (not_yet_validated && !PUBLISHES(mode)));
  assert(event != RESET || m0_ != FAILED || mode == FAILED || clean_run == 0);
  if :: does & (START_FIT | DISCARD_FIT | RESTART_FIT | ADOPT_FIT) || (mode != RECALIBRATING && mode != INITIAL) -> alarmed = 0
     :: else fi
}

#ifdef CLAIMS
#define L1_HOLDS ([] (regime == FAULTY -> <> (WITHIN(broken, out) && mode != FAILED)))
#define L2_HOLDS ([] (regime == CALM -> <> [] (mode != SUSPECT)))
#define L3_HOLDS ([] (regime == DOUBTING && mode == SUSPECT -> <> (mode != SUSPECT || timed_out)))
#define L4_HOLDS ([] (regime == CALM -> <> (mode != RECALIBRATING && mode != INITIAL)))
#define L5_HOLDS ([] (regime == UNSEEN -> <> [] !VALID))
#define L6_HOLDS ([] (regime == VIOLATED && LEFT == 3 && calibrated -> <> (mode == FAILED)))
ltl L1 { L1_HOLDS }
ltl L2 { L2_HOLDS }
ltl L3 { L3_HOLDS }
ltl L4 { L4_HOLDS }
ltl L5 { L5_HOLDS }
ltl L6 { L6_HOLDS }
/* All at once: the ways in which a run may go on for ever exclude each other. */
ltl liveness { L1_HOLDS && L2_HOLDS && L3_HOLDS && L4_HOLDS && L5_HOLDS && L6_HOLDS }
/* must fail: the model can lose a sensor and go on with three */
ltl never_degraded { [] (mode != DEGRADED) }
#endif
