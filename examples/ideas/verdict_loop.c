/* C: a monitor in memory of the caller, one sample in, one verdict out. */
#include <stdio.h>

#include "plumb/c/plumb.h"

static uint64_t storage[8192], workspace[4096]; /* yours */
static const double axis[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.60, 0.64, 0.48}};

int main(void) {
  plumb_sensor s[4];
  plumb_config config;
  plumb_sample sample;
  plumb_verdict v;
  plumb_monitor* monitor;
  plumb_config_defaults(&config), plumb_sample_defaults(&sample), plumb_verdict_defaults(&v);
  for (int i = 0; i < 4; ++i) plumb_sensor_defaults(&s[i]), s[i].id[0] = "wxyz"[i], s[i].sigma_mps2 = 2e-3;
  for (int k = 0; k < 12; ++k) s[k / 3].axis[k % 3] = axis[k / 3][k % 3];
  config.sensors = 4, config.sensor = s, sample.delivered = 15u;
  if (plumb_monitor_init(storage, sizeof storage, workspace, sizeof workspace, &config, &monitor).code) return 1;
  for (int k = 0; k < 64; ++k, sample.time_s += 0.01) {
    for (int i = 0; i < 4; ++i) sample.raw[i] = 9.80665 * axis[i][2] + (k & 1 ? 2e-3 : -2e-3); /* your converter */
    plumb_monitor_step(monitor, &sample, &v);
  }
  printf("%s: %.3f m/s^2 down along z\n", plumb_validity_text(v.validity), v.gravity_mps2[2]);
}
