/* What fails at once. UNITS: how many units have a member in a set; WHOLE: all sensors of these. FLAT: how many units may lie
   in one plane with all their sensors that are in the set. Two directions always do and three never, so two units of one
   sensor each may, or one unit of two. Any FLAT + 1 units span space, any FLAT + 2 check one another. */
#ifdef CHIPS
hidden byte mates[6];  /* the unit of a sensor, as a set */
hidden byte units_in[64], whole_of[64], flat_in[64];
#define UNITS(s) units_in[s]
#define WHOLE(s) whole_of[s]
#define FLAT(s)  flat_in[s]
#else
#define UNITS(s) COUNT(s)
#define WHOLE(s) (s)
#define FLAT(s)  2
#endif

#ifdef CHIPS
hidden byte set_, of_, ones_, twos_;

inline write_units() {
#if CHIPS == 222
  mates[0] = 3; mates[1] = 3; mates[2] = 12; mates[3] = 12; mates[4] = 48; mates[5] = 48;
#else  /* 2111 */
  mates[0] = 3; mates[1] = 3; mates[2] = 4; mates[3] = 8; mates[4] = 16;
#endif
  set_ = 0;
  do
  :: set_ > ALL -> break
  :: else ->
       of_ = 0; ones_ = 0; twos_ = 0;
       do
       :: of_ >= SENSORS -> break
       :: else ->
            if  /* the lowest of its unit in the set stands for the unit */
            :: HAS(set_, of_) && (set_ & mates[of_] & ((1 << of_) - 1)) == 0 ->
                 units_in[set_] = units_in[set_] + 1;
                 whole_of[set_] = whole_of[set_] | mates[of_];
                 if
                 :: COUNT(set_ & mates[of_]) == 1 -> ones_++
                 :: COUNT(set_ & mates[of_]) == 2 -> twos_++
                 :: else
                 fi
            :: else
            fi;
            of_++
       od;
       flat_in[set_] = ((ones_ >= 2) -> 2 : ((ones_ + twos_ > 0) -> 1 : 0));
       set_++
  od
}
#endif
