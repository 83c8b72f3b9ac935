/* plumb under cFS: the telemetry packet that carries its verdict, and the watch- and actionpoints by which the Limit
 * Checker (LC) acts on it. LC needs no code of its own: it compares bytes of a packet with limits. */
#ifndef NAV_CFS_LC_H
#define NAV_CFS_LC_H

#include "cfs_tables.h" /* on a target: cfe.h, lc_tbl.h, lc_platform_cfg.h */
#include "plumb/c/plumb.h"

#define NAV_PLUMB_HK_MID 0x0899 /* yours: the message id of this packet */
#define NAV_RTS_SAFE_MODE 12    /* yours: the stored command sequences */
#define NAV_RTS_RATE_DAMPING 13

typedef struct NAV_PlumbHk {
  uint8 Header[16]; /* CFE_MSG_TelemetryHeader_t */
  uint8 State;      /* plumb_state */
  uint8 Validity;   /* plumb_validity: the larger, the better */
  uint8 InService;  /* how many sensors */
  uint8 Alert;      /* the tilt is not bounded within the alert limit */
  uint32 Excluded;  /* bit i: sensor i */
  uint32 AgeMs;     /* of the vector; 0xFFFFFFFF where there is none */
} NAV_PlumbHk_t;

/* A verdict into the packet; the header is the message API's. */
void NAV_FillPlumbHk(NAV_PlumbHk_t* packet, const plumb_verdict* verdict);

/* Rows of the tables: copy them to the numbers that are free in yours, and the numbers in RPNEquation with them. */
enum { NAV_WP_FAILED, NAV_WP_NOT_USABLE, NAV_WP_OLD, NAV_WATCHPOINTS };
enum { NAV_AP_LOST, NAV_AP_COASTING, NAV_ACTIONPOINTS };
extern const LC_WDTEntry_t NAV_PlumbWDT[NAV_WATCHPOINTS];
extern const LC_ADTEntry_t NAV_PlumbADT[NAV_ACTIONPOINTS];

#endif
