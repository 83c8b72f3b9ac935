#include "plumb/health/health_monitor.hpp"

static_assert(sizeof(plumb::HealthMonitor) <= LIMIT_KIB * 1024, "a monitor is larger than the requirement allows");
