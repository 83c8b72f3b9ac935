/* The packet and the tables of cfs_lc.h. */
#include "cfs_lc.h"

#include <stddef.h>

static uint8 count_of(uint32_t bits) {
  uint8 n = 0;
  for (; bits != 0; bits &= bits - 1u) ++n;
  return n;
}

void NAV_FillPlumbHk(NAV_PlumbHk_t* packet, const plumb_verdict* v) {
  const double age_ms = 1000.0 * v->age_s; /* compared below so that a NaN counts as too old */
  packet->State = v->state;
  packet->Validity = v->validity;
  packet->InService = count_of(v->in_service);
  packet->Alert = v->alert;
  packet->Excluded = v->excluded;
  packet->AgeMs = v->validity != PLUMB_INVALID && age_ms >= 0.0 && age_ms < 4294967295.0 ? (uint32)age_ms : 0xFFFFFFFFu;
}

/* LC reads bytes, whatever the processor's order: the type says which. */
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define NAV_UDWORD LC_DATA_WATCH_UDWORD_BE
#else
#define NAV_UDWORD LC_DATA_WATCH_UDWORD_LE
#endif
/* A packet that stops coming makes its results stale after three samples of the actionpoints. LC then starts its count
 * of failures anew, so none below waits for a second failure: plumb has confirmed what it says. Watch for the silence
 * itself with HS or a heartbeat; stale is no failure to LC. */
#define NAV_WATCH(field, type, operation, limit)                                                             \
  {                                                                                                          \
    .DataType = (type), .OperatorID = (operation), .MessageID = NAV_PLUMB_HK_MID,                            \
    .WatchpointOffset = offsetof(NAV_PlumbHk_t, field), .BitMask = LC_BITMASK_NONE, .CustomFuncArgument = 0, \
    .ResultAgeWhenStale = 3, .ComparisonValue = {                                                            \
      limit                                                                                                  \
    }                                                                                                        \
  }

const LC_WDTEntry_t NAV_PlumbWDT[NAV_WATCHPOINTS] = {
    [NAV_WP_FAILED] = NAV_WATCH(State, LC_DATA_WATCH_UBYTE, LC_OPER_EQ, PLUMB_FAILED),
    [NAV_WP_NOT_USABLE] = NAV_WATCH(Validity, LC_DATA_WATCH_UBYTE, LC_OPER_LT, PLUMB_DEGRADED),
    [NAV_WP_OLD] = NAV_WATCH(AgeMs, NAV_UDWORD, LC_OPER_GT, 60000),
};

const LC_ADTEntry_t NAV_PlumbADT[NAV_ACTIONPOINTS] = {
    /* Nothing is left to believe: safe mode, at once. */
    [NAV_AP_LOST] = {.DefaultState = LC_APSTATE_ACTIVE,
                     .MaxPassiveEvents = 2,
                     .MaxPassFailEvents = 2,
                     .MaxFailPassEvents = 2,
                     .RTSId = NAV_RTS_SAFE_MODE,
                     .MaxFailsBeforeRTS = 1,
                     .RPNEquation = {NAV_WP_FAILED, LC_RPN_EQUAL},
                     .EventType = CFE_EVS_EventType_CRITICAL,
                     .EventID = 1100,
                     .EventText = "plumb: failed"},
    /* The vector is not usable and old: the gyros have carried on for a minute. */
    [NAV_AP_COASTING] = {.DefaultState = LC_APSTATE_ACTIVE,
                         .MaxPassiveEvents = 2,
                         .MaxPassFailEvents = 2,
                         .MaxFailPassEvents = 2,
                         .RTSId = NAV_RTS_RATE_DAMPING,
                         .MaxFailsBeforeRTS = 1,
                         .RPNEquation = {NAV_WP_NOT_USABLE, NAV_WP_OLD, LC_RPN_AND, LC_RPN_EQUAL},
                         .EventType = CFE_EVS_EventType_ERROR,
                         .EventID = 1101,
                         .EventText = "plumb: attitude coasts"},
};
