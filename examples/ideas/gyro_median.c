/* C: three gyro triads, one of them fails: the median stays right, and what it may be off by is known. */
#include <math.h>
#include <stdio.h>

#include "plumb/c/plumb_rates.h"

int main(void) {
  const double turn_radps[3] = {2.0, 1.0, -1.5};
  plumb_triad_rates triads;
  plumb_triad_bounds bounds;
  plumb_motion_sample s; /* what a monitor of accelerometers takes */
  double* const w = s.rate_radps[0];
  int32_t given;
  plumb_triad_rates_defaults(&triads), triads.triads = 3, triads.given = 7;
  plumb_triad_bounds_defaults(&bounds), bounds.scale = 0.01, bounds.axis_rad = 0.005, bounds.bias_radps = 0.005;
  plumb_motion_sample_defaults(&s);
  for (int k = 0; k < 3; ++k) /* within 1 %; the third is stuck at full scale */
    for (int i = 0; i < 3; ++i) triads.rate_radps[k][i] = k == 2 ? 35.0 : turn_radps[i] * (k == 0 ? 1.004 : 0.997);
  if (plumb_median_rate(&triads, w, &given).code || !given) return 1;
  s.rates_given = 1; /* with gyros = 1, gyro_corroborated = 1, and no gyro bound in the config but that of its lag */
  const double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  if (plumb_median_error(&bounds, length, &s.rate_error_radps[0]).code) return 1;
  printf("%.3f %.3f %.3f rad/s, off by at most %.3f rad/s in length\n", w[0], w[1], w[2], s.rate_error_radps[0]);
}
