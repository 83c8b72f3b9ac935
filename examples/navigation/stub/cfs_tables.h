/* Stand-ins for what the example needs of cFE and LC, for a machine without them: the fields of a watchpoint and of an
 * actionpoint, in LC's order, and the numbers of LC's table definitions. */
#ifndef STUB_CFS_TABLES_H
#define STUB_CFS_TABLES_H

#include <stdint.h>

typedef uint8_t uint8;
typedef uint16_t uint16;
typedef uint32_t uint32;
typedef int32_t int32;
typedef uint32_t CFE_SB_MsgId_t;

#define LC_MAX_RPN_EQU_SIZE 20
#define LC_MAX_ACTION_TEXT 32

enum {
  CFE_EVS_EventType_DEBUG = 1,
  CFE_EVS_EventType_INFORMATION,
  CFE_EVS_EventType_ERROR,
  CFE_EVS_EventType_CRITICAL
};
enum { LC_DATA_WATCH_UBYTE = 2, LC_DATA_WATCH_UDWORD_BE = 9, LC_DATA_WATCH_UDWORD_LE = 10 };
enum { LC_OPER_LT = 1, LC_OPER_LE, LC_OPER_NE, LC_OPER_EQ, LC_OPER_GE, LC_OPER_GT };
enum { LC_RPN_AND = 0xFFF1, LC_RPN_OR, LC_RPN_XOR, LC_RPN_NOT, LC_RPN_EQUAL };
enum { LC_APSTATE_ACTIVE = 1, LC_APSTATE_PASSIVE, LC_APSTATE_DISABLED };
#define LC_BITMASK_NONE 0xFFFFFFFFu

typedef union {
  uint32 Unsigned32;
  int32 Signed32;
  float Float32;
} LC_MultiType_t;

typedef struct {
  uint8 DataType;
  uint8 OperatorID;
  CFE_SB_MsgId_t MessageID;
  uint32 WatchpointOffset;
  uint32 BitMask;
  LC_MultiType_t ComparisonValue;
  uint32 ResultAgeWhenStale;
  uint32 CustomFuncArgument;
} LC_WDTEntry_t;

typedef struct {
  uint8 DefaultState;
  uint8 MaxPassiveEvents;
  uint8 MaxPassFailEvents;
  uint8 MaxFailPassEvents;
  uint16 RTSId;
  uint16 MaxFailsBeforeRTS;
  uint16 RPNEquation[LC_MAX_RPN_EQU_SIZE];
  uint16 EventType;
  uint16 EventID;
  char EventText[LC_MAX_ACTION_TEXT];
} LC_ADTEntry_t;

#endif
