/* C: an error with the sensor, the value found, the limit, and the remedy. */
#include <stdio.h>

#include "plumb/c/plumb.h"

static uint64_t storage[8192], workspace[4096];

int main(void) {
  plumb_sensor sensor[3];
  plumb_config config;
  plumb_monitor* monitor;
  for (int i = 0; i < 3; ++i) {
    plumb_sensor_defaults(&sensor[i]);
    sensor[i].id[0] = (char)('x' + i);
    sensor[i].axis[i] = i == 1 ? 0.9 : 1.0; /* the second is no unit vector */
    sensor[i].sigma_mps2 = 0.002;
  }
  plumb_config_defaults(&config);
  config.sensors = 3;
  config.sensor = sensor;
  const plumb_error e = plumb_monitor_init(storage, sizeof storage, workspace, sizeof workspace, &config, &monitor);
  printf("sensor %d: %s: %g, must be %g\n", (int)e.index, plumb_error_text(e.code), e.value, e.limit);
  printf("remedy: %s\n", plumb_error_remedy(e.code));
  return monitor != NULL; /* refused: there is none */
}
