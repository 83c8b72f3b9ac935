// The library itself, in one source: PLUMB_CAPACITY (4, 8, 16, 24) says how many sensors it takes.
#ifndef PLUMB_CAPACITY
#define PLUMB_CAPACITY 4
#endif
#define PLUMB_IMPLEMENTATION
#include "plumb.h"
