/* plumb from C: four sensors, one loop, one verdict per sample. The twin of monitor_loop.cpp. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "plumb/c/plumb.h"

/* Yours, static: plumb_monitor_size() and plumb_workspace_size() say how much the library at hand needs. */
static uint64_t storage[8192], workspace[4096];

static int refused(plumb_error e) {
  printf("refused: %s; %s (%d)\n", plumb_error_text(e.code), plumb_error_remedy(e.code), (int)e.index);
  return 1;
}

/* Stands in for the converter: a new attitude every 4 s, 100 samples a second, and a2 is dead from 30 s on. */
static void simulated(const plumb_sensor* sensor, int k, plumb_sample* sample) {
  static uint32_t random = 1;
  const double tilt = 0.3 + 0.15 * (k / 400 % 6), turn = 1.1 * (k / 400);
  const double down[3] = {sin(tilt) * cos(turn), sin(tilt) * sin(turn), cos(tilt)};
  sample->time_s = 0.01 * k;
  sample->delivered = 15u;
  for (int i = 0; i < 4; ++i) {
    const double* h = sensor[i].axis;
    random = random * 1664525u + 1013904223u;
    sample->raw[i] = 9.80665 * (h[0] * down[0] + h[1] * down[1] + h[2] * down[2]) +
                     sqrt(12.0) * sensor[i].sigma_mps2 * ((random >> 8) / 16777216.0 - 0.5);
  }
  if (sample->time_s >= 30.0) sample->raw[1] = 0.0;
}

int main(void) {
  const double across = sqrt(8.0) / 3.0, axes[4][3] = {{across, 0, -1.0 / 3.0},
                                                       {-across / 2, across * sqrt(0.75), -1.0 / 3.0},
                                                       {-across / 2, -across * sqrt(0.75), -1.0 / 3.0},
                                                       {0, 0, 1}};
  plumb_sensor sensor[4];
  plumb_config config;
  plumb_sample sample;
  plumb_verdict verdict;
  plumb_monitor* monitor;
  for (int i = 0; i < 4; ++i) {
    plumb_sensor_defaults(&sensor[i]);
    sensor[i].id[0] = 'a';
    sensor[i].id[1] = (char)('1' + i);
    sensor[i].sigma_mps2 = 0.002;
    sensor[i].stability_mps2 = 0.001; /* drift since the calibration, 1 sigma, from its datasheet */
    for (int c = 0; c < 3; ++c) sensor[i].axis[c] = axes[i][c];
  }
  plumb_config_defaults(&config);
  config.sensors = 4;
  config.sensor = sensor;
  const plumb_error made = plumb_monitor_init(storage, sizeof storage, workspace, sizeof workspace, &config, &monitor);
  if (made.code != PLUMB_OK) return refused(made);
  plumb_sample_defaults(&sample);
  plumb_verdict_defaults(&verdict);
  for (int k = 0; k < 6000; ++k) {
    simulated(sensor, k, &sample);
    const plumb_error stepped = plumb_monitor_step(monitor, &sample, &verdict);
    if (stepped.code != PLUMB_OK) return refused(stepped);
    if (verdict.transition.sequence == 0) continue;
    printf("%6.2f s  %s -> %s  cause %s, output %s\n", verdict.time_s, plumb_state_text(verdict.transition.from),
           plumb_state_text(verdict.state), plumb_cause_text(verdict.cause), plumb_validity_text(verdict.validity));
  }
  return 0;
}
