/* Included by pan.c. Sensors of an array in general position are interchangeable to the decision layer, but for the one
   rule that probation returns the lowest first, and there each of them may be the only one proven. So only how many
   sensors stand alike counts: after every step the sensors are put in the order of what is known of them. With chips
   the axes of one are interchangeable, and so are whole chips of the same size. tests/model/breadth_first_test.cpp does
   the same with its own code and without the shortcuts of environment.pml, and must count the same states. In a replay
   the names of the sensors follow them. */
#include <stdio.h>

extern int readtrail; /* of pan.c: a trail is being replayed */

#define PLUMB_MASKS(use) \
  use(serving) use(aside) use(out) use(absent) use(readmitted) use(ever) use(suspected) use(probation) use(broken)

static int plumb_order[8];
static int plumb_names[8] = {1, 2, 3, 4, 5, 6, 7, 8};

/* The unit of a sensor, as a set; its sensors have successive numbers. */
static unsigned plumb_unit(int i) {
#ifdef CHIPS
  return mates[i];
#else
  return 1u << i;
#endif
}

/* With the sensor before: an axis of the same chip, or both single. */
static int plumb_exchangeable(int i) {
  return plumb_unit(i) == plumb_unit(i - 1) ||
         (__builtin_popcount(plumb_unit(i)) == 1 && __builtin_popcount(plumb_unit(i - 1)) == 1);
}

#ifdef CODE
static void plumb_tell_units(unsigned char* unit) {
  int i;
  for (i = 0; i < SENSORS; ++i) unit[i] = plumb_unit(i);
}
#endif

static unsigned plumb_place(unsigned mask) {
  unsigned sorted = 0;
  int i;
  for (i = 0; i < SENSORS; ++i) sorted |= ((mask >> plumb_order[i]) & 1u) << i;
  return sorted;
}

/* Units in order: of neighbours of the same size the one of which more is known goes first. */
static void plumb_sort_units(unsigned* known) {
#ifdef CHIPS
  int moved = 1;
  while (moved) {
    int first = 0;
    moved = 0;
    while (first < SENSORS) {
      const int size = __builtin_popcount(mates[first]), next = first + size;
      int k = 0;
      if (next < SENSORS && __builtin_popcount(mates[next]) == size) {
        while (k < size && known[first + k] == known[next + k]) ++k;
        if (k < size && known[first + k] < known[next + k]) {
          moved = 1;
          for (k = 0; k < size; ++k) {
            const unsigned word = known[first + k];
            const int place = plumb_order[first + k];
            known[first + k] = known[next + k];
            known[next + k] = word;
            plumb_order[first + k] = plumb_order[next + k];
            plumb_order[next + k] = place;
          }
        }
      }
      first = next;
    }
  }
#endif
}

static void plumb_sort(void) {
  unsigned known[8];
  int i, k, names[8];
  for (i = 0; i < SENSORS; ++i) {
    unsigned word = 0;
#define PLUMB_KNOWN(m) word = word << 1 | ((now.m >> i) & 1u);
    PLUMB_MASKS(PLUMB_KNOWN)
#ifdef CHIPS
#define PLUMB_ALIKE(a, b) (mates[a] == mates[b])
#else
#define PLUMB_ALIKE(a, b) 1
#endif
    for (k = i; k > 0 && PLUMB_ALIKE(k - 1, i) && known[k - 1] < word; --k) {
      known[k] = known[k - 1];
      plumb_order[k] = plumb_order[k - 1];
    }
    known[k] = word;
    plumb_order[k] = i;
  }
  plumb_sort_units(known);
#define PLUMB_PLACE(m) now.m = plumb_place(now.m);
  PLUMB_MASKS(PLUMB_PLACE)
#ifdef CODE
  S.in_service = plumb_place(S.in_service);
  S.provisionally_excluded = plumb_place(S.provisionally_excluded);
  S.excluded = plumb_place(S.excluded);
  S.absent = plumb_place(S.absent);
  S.readmitted = plumb_place(S.readmitted);
#endif
  now.rep = 0;
  for (i = 0; i < SENSORS; ++i) {
    if (i == 0 || known[i] != known[i - 1] || !plumb_exchangeable(i)) now.rep |= 1u << i;
  }
  if (readtrail) {
    for (i = 0; i < SENSORS; ++i) names[i] = plumb_names[plumb_order[i]];
    for (i = 0; i < SENSORS; ++i) plumb_names[i] = names[i];
  }
}

/* --- A step in words, for model/replay. -------------------------------------------------------------------------- */

static const char* plumb_modes[] = {"nominal",       "isolated",          "suspect", "degraded",
                                    "recalibrating", "first calibration", "failed"};
static const char* plumb_events[] = {"reset",
                                     "channel lost",
                                     "channel back",
                                     "exclusion",
                                     "provisional exclusion",
                                     "isolation timeout",
                                     "no consistent hypothesis",
                                     "alarm",
                                     "norm mismatch",
                                     "fit accepted",
                                     "fit rejected",
                                     "probation passed",
                                     "recalibrate",
                                     "passed block",
                                     "none"};
static const char* plumb_kinds[] = {
    "a sample", "no evidence", "a passed block", "an inconclusive block", "an alarming block", "a block off gravity"};

static void plumb_set(const char* what, unsigned mask) {
  int i;
  if (mask == 0) return;
  printf("%s", what);
  for (i = 1; i <= SENSORS; ++i) {
    int k;
    for (k = 0; k < SENSORS; ++k) {
      if (plumb_names[k] == i && ((mask >> k) & 1u)) printf(" %d", i);
    }
  }
}

static void plumb_tell(void) {
  static int step = 0;
  if (!readtrail) return;
  printf("| %3d  %s%s", ++step, plumb_kinds[now.kind], now.kind >= 2 && now.excited ? " at a new attitude" : "");
  plumb_set("; wrong in this episode:", ever0_);
  plumb_set("; suspected:", suspected0_);
  printf("\n|      %s", plumb_events[now.event]);
  if (now.in_motion) printf(" from motion");
  plumb_set(":", now.moved);
  if (m0_ != now.mode)
    printf(", %s -> %s", plumb_modes[m0_], plumb_modes[now.mode]);
  else
    printf(", stays %s", plumb_modes[now.mode]);
  plumb_set("; in service", now.serving);
  plumb_set("; provisionally excluded", now.aside);
  plumb_set("; excluded", now.out);
  plumb_set("; absent", now.absent);
  plumb_set("; has returned once", now.readmitted);
  printf("%s\n", now.not_yet_validated ? "; not yet validated" : "");
}
