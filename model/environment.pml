/* What may happen to a tool, one step at a time, and what the evidence may say about it.

   Faults. `ever` holds the sensors that were wrong at some block of the episode. Which of them is wrong at which block
   is left open, so that faults that stay, glitch, recover and move from sensor to sensor are all among the runs. The
   bound: at least three of the sensors that isolation is posed on were healthy throughout (n - 3 faults for n sensors).
   With chips a fault is one of a unit, with all of its axes or some, and the bound leaves so many healthy units as span
   space however they lie: n - 1 - FLAT faults for n units. A channel is lost alone.

   Verdicts. Any block may be clean, short of clean, alarming, off gravity or no evidence at all (motion, heat, age),
   whatever is wrong: nothing is assumed about detection. Accusations obey the soundness theorem (T5, proofs/coq): at the
   confirmed grade nobody healthy throughout the episode is suspected; at the provisional grade nobody while four are healthy,
   and beyond that anybody may be. MOVING weakens it to "healthy at this block", the wording that a moving fault
   defeats; the model must then find the run that excludes a healthy sensor.

   Motion. What a monitor in motion finds is left open altogether: at any block in motion it may say anything of anybody.
   A sensor that is provisionally excluded may contradict the others at rest while these agree; that opens an episode.

   A silent channel, a channel that is back, the operator's reset, his request for recalibration, his freeze of
   switching and the outcome of a fit may come at any step, together with what a block says. */

byte ever;
byte rep = 1;            /* first of each run of sensors that stand alike (symmetry.h) */
byte kind;
#define SAMPLE      0    /* no block ended */
#define NO_EVIDENCE 1
#define CLEAN       2
#define SOFT        3    /* no alarm, not clean enough to end a suspicion */
#define ALARMING    4
#define OFF_GRAVITY 5
bit excited;             /* at an attitude that the records have not seen */
bit shows;               /* the fault shows here; for who is not yet validated: every prediction has moved */
bit vote;
byte wrong, i, result, among;
byte regime;             /* how the run goes on for ever, for liveness: */
#define FREE      0
#define CALM      1
#define DOUBTING  2
#define UNSEEN    3
#define VIOLATED  4
#define FAULTY    5
byte broken;             /* FAULTY: the sensors with a constant fault */

/* Any subset of a universe; of sensors that stand alike only how many. What this step has told apart stands no longer
   alike (the breadth-first search found the states that were lost without it). */
#define APART(s) ((s) ^ ((s) << 1))
inline pick(universe, set) {
  set = 0; i = 0;
  do
  :: i < SENSORS ->
       if
       :: skip
       :: HAS(universe, i) && (HAS(rep | APART(ever) | APART(suspected) | APART(lost), i) || (i > 0 && HAS(set, i - 1))) ->
            set = set | (1 << i)
       fi;
       i++
  :: else -> i = 0; break
  od
}

/* The same of units: all of a unit that is in the universe, or nothing of it. */
#if defined(CHIPS) && !defined(AXES_ALONE)  /* with AXES_ALONE an axis of a chip may be suspected alone: REQ-206 falls */
#define LOWER(i) (mates[i] & ((1 << (i)) - 1))
inline pick_units(universe, set) {
  set = 0; i = 0;
  do
  :: i < SENSORS ->
       if
       :: ((universe) & LOWER(i)) == 0
       :: ((universe) & LOWER(i)) == 0 && HAS(universe, i) &&
          (mates[i] != (1 << i) || HAS(rep | APART(ever) | APART(suspected) | APART(lost), i) || (i > 0 && HAS(set, i - 1))) ->
            set = set | (mates[i] & (universe))
       :: ((universe) & LOWER(i)) != 0
       fi;
       i++
  :: else -> i = 0; break
  od
}
#else
#define pick_units pick
#endif

#define ACCUSES (mode == NOMINAL || mode == ISOLATED || mode == SUSPECT || mode == RECALIBRATING)
/* What is on record of an episode in these modes is forgotten before it can matter. */
#define RECORDS (mode != FAILED && mode != INITIAL)
#define HEALTHY_THROUGHOUT UNITS(MONITORED & ~ever)
#define SPAN  (FLAT(MONITORED) + 1)  /* so many units span space */
#define CHECK (FLAT(MONITORED) + 2)  /* so many check one another */
#ifdef MOVING
#define SOUND_STRICT 1
#define ACCUSABLE ((HEALTHY_THROUGHOUT >= 3) -> (MONITORED & ever) : MONITORED)
#else
#define SOUND_STRICT HEALTHY_THROUGHOUT >= SPAN
#define ACCUSABLE (MONITORED & ever)
#endif
/* All that has been the matter with a sensor in this run and has left a trace. */
#define TOUCHED (ever | out | absent | readmitted)
#define MOST_FAULTS (UNITS(ALL) - 1 - FLAT(ALL))
/* With four and five sensors one channel more may fall silent than sensors may be wrong, so that the rank can be lost,
   and sensors return by probation. With six it is the sets of three faults that matter: one channel may be silent at a
   time, and returns are left to the smaller arrays. With chips one channel may be silent at a time, and units return; fits,
   freezes and two events at the end of one block, in which chips change nothing, are left to the arrays without. */
#ifdef CHIPS
#define ALL_OF_IT 0
#define BEARABLE(silent) (COUNT(absent | (silent)) <= 1 && UNITS(TOUCHED | (silent)) <= MOST_FAULTS)
#define RETURNS 1
#elif SENSORS == 6
#define ALL_OF_IT 1
#define BEARABLE(silent) (COUNT(absent | (silent)) <= 1 && COUNT(TOUCHED | (silent)) <= MOST_FAULTS)
#define RETURNS 0
#else
#define ALL_OF_IT 1
#define BEARABLE(silent) (COUNT(TOUCHED | (silent)) <= MOST_FAULTS + 1)
#define RETURNS 1
#endif
#define SOUND_PARITY HEALTHY_THROUGHOUT >= CHECK

inline block_kind() {
  if
  :: regime == FREE ->
       if :: kind = SAMPLE :: kind = NO_EVIDENCE :: kind = CLEAN :: kind = SOFT :: kind = ALARMING :: kind = OFF_GRAVITY fi
  :: regime == CALM -> kind = CLEAN
  :: regime == DOUBTING ->
       if :: kind = ALARMING :: mode == SUSPECT -> kind = SOFT fi
  :: regime == UNSEEN -> kind = NO_EVIDENCE
  :: regime == VIOLATED -> kind = ALARMING
  :: regime == FAULTY ->
       if :: broken & serving -> kind = ALARMING :: else -> kind = CLEAN fi
  fi
}

/* How many units are wrong at once never exceeds the bound. */
inline onset() {
  pick_units(MONITORED & ~ever, wrong);
#ifdef MOVING
  if :: COUNT(MONITORED & ~wrong) >= 3 || wrong == 0 -> ever = ever | wrong :: else -> wrong = 0 fi
#else
  if
  :: HEALTHY_THROUGHOUT - UNITS(wrong) >= SPAN && UNITS(TOUCHED | wrong) <= MOST_FAULTS -> ever = ever | wrong
  :: else -> wrong = 0
  fi
#endif
}

/* Without a unit to spare, or with fewer left than span space, nobody is convicted. */
#define ANSWERABLE (suspected != 0 && UNITS(MONITORED) >= CHECK && UNITS(MONITORED & ~suspected) >= SPAN)

inline ballot() {
  if
  :: regime == FAULTY -> ever = ever | (broken & MONITORED); isolated = broken & MONITORED & ~suspected; wrong = 0
  :: else ->
       if :: UNITS(MONITORED) >= CHECK && SOUND_STRICT && regime != VIOLATED -> among = ACCUSABLE; pick_units(among & ~suspected, isolated); among = 0
          :: else -> isolated = 0
       fi
  fi;
  if
  :: isolated != 0 && UNITS(MONITORED & ~(suspected | isolated)) >= SPAN -> suspected = suspected | isolated; standing = 0; agree = 0
  :: else
  fi;
  isolated = 0;
  if
  :: !ANSWERABLE -> standing = 0; agree = 0
  :: ANSWERABLE && standing
  :: ANSWERABLE && standing && regime != FAULTY -> standing = 0; agree = 0
  :: ANSWERABLE && !standing && regime != FAULTY
  :: ANSWERABLE && !standing -> standing = 1; agree = 0
  fi;
  if
  :: !standing || agree >= NEEDED
  :: standing && agree < NEEDED && regime != FAULTY
  :: standing && agree < NEEDED -> agree++
  fi
}

byte to_go;
inline count_doubt() {
  to_go = TO_GO;
  /* One more is suspected than ever before in this episode: patience begins anew, and so no more than n times. */
  if :: SUSPECTED > most -> most = SUSPECTED; doubt = 0 :: else fi;
  assert(TO_GO <= to_go);
  if
  :: (kind == ALARMING && !(result == 1 && EXPECTED(NO_CONSISTENT_HYPOTHESIS, NONE_ALIVE))) || (kind == SOFT && mode == SUSPECT) ->
       if :: doubt < P_STATIONS && excited -> doubt++; assert(TO_GO < to_go) :: else fi
  :: else
  fi;
  to_go = 0
}

inline count_clean() {
  if
  :: kind != CLEAN ->
       clean_run = 0;
       if :: kind != SOFT || mode == SUSPECT -> clean_stations = 0 :: else fi;
       if :: kind != SOFT -> probation = 0; probation_stations = 0 :: else fi
  :: else ->
       if :: clean_run < R_BLOCKS -> clean_run++ :: else fi;
       if :: not_yet_validated && clean_run == R_BLOCKS && shows -> not_yet_validated = 0 :: else fi;
       if
       :: (open || doubt > 0) && excited ->
            if
            :: clean_stations++             /* those set aside agree too */
            :: aside != 0 && regime == FREE
            fi;
            if :: clean_stations == M_STATIONS -> forget_episode(); ever = 0; timed_out = 0 :: else fi
       :: else
       fi;
       if
       :: !open && !not_yet_validated && RECORDS && mode != SUSPECT && regime == FREE && RETURNS ->
            among = (out | aside) & ~absent;
            among = among & ~WHOLE(among & readmitted);  /* asked as a whole: none of it has been back before */
            pick_units(among, proven); among = 0;
            if
            :: probation & proven -> probation = probation & proven
            :: else -> probation = proven; probation_stations = 0
            fi;
            proven = 0;
            if :: probation != 0 && excited && probation_stations < K_STATIONS -> probation_stations++ :: else fi
       :: else
       fi
  fi
}

/* What a quiet block is to the records, and which events it raises. */
inline quiet_block() {
  held = 0;
  if
  :: lost | back
  :: !(lost | back) -> if :: excited = 1 :: regime == FREE -> excited = 0 fi
  fi;
  if
  :: kind == ALARMING && RECORDS && !open -> open = 1; onset()
  :: (kind == CLEAN || kind == SOFT) && aside != 0 && RECORDS && !open -> open = 1; onset()
  :: kind != ALARMING || !RECORDS || open
  fi;
  vote = open && RECORDS && kind != OFF_GRAVITY && !(lost | back);
  if :: kind == CLEAN && not_yet_validated && clean_run + 1 >= R_BLOCKS && excited -> if :: shows = 1 :: regime == FREE -> shows = 0 fi :: else fi;
  if :: vote -> ballot() :: else fi;
  if
  :: kind == ALARMING && UNITS(MONITORED) >= CHECK && regime != FAULTY && !standing -> if :: result = 1 :: result = 0 fi
  :: else
  fi;
  if :: RECORDS -> count_doubt() :: else fi;
  count_clean();
  if
  :: ACCUSES && open && standing && agree >= NEEDED -> isolated = suspected; raised = raised | BIT(EXCLUSION)
  :: else
  fi;
  if
  :: ACCUSES && open && kind == ALARMING && UNITS(MONITORED) >= CHECK + 1 && (regime == FREE || regime == DOUBTING) &&
     result == 0 && !(lost | back) ->
       among = (SOUND_PARITY -> serving & ever : serving);
       pick_units(among, to_aside); among = 0;
       if :: to_aside != 0 && COUNT(serving & ~to_aside) >= 3 -> raised = raised | BIT(PROVISIONAL_EXCLUSION)
          :: else -> to_aside = 0
       fi
  :: else
  fi;
  if
  :: kind != OFF_GRAVITY && PATIENCE_ENDS ->
       if :: within = 0 :: regime != VIOLATED -> within = 1 fi;
       if :: !timed_out || !within -> raised = raised | BIT(ISOLATION_TIMEOUT) :: else fi
  :: else
  fi;
  if
  :: kind == ALARMING && result == 1 ->
       if :: EXPECTED(NO_CONSISTENT_HYPOTHESIS, NONE_ALIVE) :: else -> raised = raised | BIT(NO_CONSISTENT_HYPOTHESIS) fi
  :: kind == ALARMING && result == 0 -> raised = raised | BIT(ALARM)
  :: kind == OFF_GRAVITY ->
       if :: EXPECTED(NORM_MISMATCH, OF_GRAVITY) :: else -> raised = raised | BIT(NORM_MISMATCH) fi
  :: kind == CLEAN ->
       raised = raised | BIT(PASSED_BLOCK);
       if :: mode == RECALIBRATING || mode == INITIAL -> fit = 1 :: else fi
  :: else
  fi;
  if
  :: probation != 0 && probation_stations == K_STATIONS -> proven = probation; raised = raised | BIT(PROBATION_PASSED)
  :: else
  fi;
#if K_STATIONS == 1
  probation = 0; probation_stations = 0
#endif
}

/* Between blocks one thing happens at a time; the pairs of events that matter arise at the end of a block. */
inline sample() {
  if
  :: pick(ALL & ~absent, lost);
     if :: lost && BEARABLE(lost) -> raised = BIT(CHANNEL_LOST) :: else -> lost = 0 fi
  :: absent -> pick(absent, back);
     if :: back -> raised = BIT(CHANNEL_BACK) :: else fi
  :: mode == FAILED -> pick(ALL, named); raised = BIT(RESET)
  :: mode != FAILED -> named = ALL; raised = BIT(RESET)
  :: open && RECORDS -> onset()
  :: ALL_OF_IT && MAY_RECALIBRATE -> raised = BIT(RECALIBRATE)
  :: outcome_of_fit()
  fi
}

inline outcome_of_fit() {
  if
  :: mode == RECALIBRATING || mode == INITIAL ->
       if
       :: fit -> raised = raised | BIT(FIT_ACCEPTED)
       :: !(regime == CALM && mode == INITIAL) -> raised = raised | BIT(FIT_REJECTED)
       :: !(regime == CALM && fit)
       fi
  :: else
  fi
}

/* A channel event at the end of a block, whatever the records have led up to. */
inline coincidence() {
  if
  :: skip
  :: ALL_OF_IT && regime == FREE ->
       if
       :: HAS(rep & ~absent, 0) -> lost = 1
       :: HAS(rep & ~absent, 1) -> lost = 2
       :: HAS(rep & ~absent, 2) -> lost = 4
       :: HAS(rep & ~absent, 3) -> lost = 8
       :: HAS(rep & ~absent, 4) -> lost = 16
       :: HAS(rep & ~absent, 5) -> lost = 32
       :: else
       fi;
       if :: BEARABLE(lost) -> raised = BIT(CHANNEL_LOST) :: else -> lost = 0 fi
  :: ALL_OF_IT && regime == FREE && absent -> back = absent; raised = BIT(CHANNEL_BACK)
  fi
}

/* Whatever may be said of motion, and of whomever: what the table does not take up from there is said as well. */
inline motion() {
  pick_units(serving, to_aside);
  found = (1 << EVENTS) - 1;
  if :: to_aside == 0 -> found = found & ~BIT(PROVISIONAL_EXCLUSION) :: else fi;
  isolated = serving
}

#define FREEZABLE (BIT(EXCLUSION) | BIT(PROVISIONAL_EXCLUSION) | BIT(PROBATION_PASSED) | BIT(RECALIBRATE) | BIT(FIT_ACCEPTED))

inline choose() {
  block_kind();
  if
  :: kind == SAMPLE -> sample()
  :: kind == NO_EVIDENCE ->
       held = (regime == UNSEEN);
       if :: skip :: regime == FREE -> motion() fi
  :: else ->
       coincidence();
       quiet_block();
       outcome_of_fit();
       if
       :: ALL_OF_IT && MAY_RECALIBRATE && kind == CLEAN && regime == FREE -> raised = raised | BIT(RECALIBRATE)
       :: skip
       fi;
       if
       :: ALL_OF_IT && raised & FREEZABLE && regime == FREE -> raised = raised & ~FREEZABLE
       :: skip
       fi
  fi;
  raised = raised | (pending << NO_CONSISTENT_HYPOTHESIS);
#ifndef OLD_PATIENCE  /* patience does not lead past what speaks against the tool; without this S17 falls */
  if :: mode == RECALIBRATING && (raised & (BIT(NO_CONSISTENT_HYPOTHESIS) | BIT(ALARM) | BIT(NORM_MISMATCH))) ->
       raised = raised & ~BIT(ISOLATION_TIMEOUT)
     :: else
  fi
#endif
}
