/* C: static memory, and a power cycle by way of a snapshot; a bit that flipped in it is noticed. */
#include <stdio.h>

#include "plumb/c/plumb.h"

#define ROOM 65536u /* more than plumb_monitor_size(), plumb_workspace_size(), plumb_snapshot_size_max() */
static uint64_t storage[ROOM / 8], workspace[ROOM / 8], flash[ROOM / 8];

int main(void) {
  plumb_sensor sensor[3];
  plumb_config config;
  plumb_monitor* m;
  size_t size;
  for (int i = 0; i < 3; ++i) {
    plumb_sensor_defaults(&sensor[i]), sensor[i].id[0] = "xyz"[i];
    sensor[i].axis[i] = 1, sensor[i].sigma_mps2 = 0.002;
  }
  plumb_config_defaults(&config), config.sensors = 3, config.sensor = sensor;
  if (plumb_monitor_init(storage, ROOM, workspace, ROOM, &config, &m).code) return 1;
  if (plumb_monitor_snapshot(m, (uint8_t*)flash, ROOM, &size).code) return 1;
  for (int flip = 0; flip < 2; ++flip, flash[9] ^= 1) { /* whole, then damaged */
    const plumb_error e = plumb_monitor_restore(storage, ROOM, workspace, ROOM, &config, (uint8_t*)flash, size, &m);
    printf("%s\n", plumb_error_text(e.code));
  }
}
