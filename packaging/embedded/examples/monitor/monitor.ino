// Four accelerometers of a redundant cone, one loop: a line for every change of state.
#include <plumb.h>

static uint64_t storage[8192], workspace[4096];  // plumb_monitor_size() and plumb_workspace_size() say what is needed
static plumb_monitor* monitor = nullptr;
static plumb_sample sample;
static plumb_verdict verdict;

static bool refused(const plumb_error& e) {
  if (e.code == PLUMB_OK) return false;
  Serial.print(plumb_error_text(e.code));
  Serial.print("; ");
  Serial.println(plumb_error_remedy(e.code));
  return true;
}

void setup() {
  Serial.begin(115200);
  const double across = 0.9428090415820634, axes[4][3] = {{across, 0, -1.0 / 3.0},
                                                          {-across / 2, across * 0.8660254037844386, -1.0 / 3.0},
                                                          {-across / 2, -across * 0.8660254037844386, -1.0 / 3.0},
                                                          {0, 0, 1}};
  plumb_sensor sensor[4];
  for (int i = 0; i < 4; ++i) {
    plumb_sensor_defaults(&sensor[i]);
    sensor[i].id[0] = 'a';
    sensor[i].id[1] = static_cast<char>('1' + i);
    sensor[i].sigma_mps2 = 0.002;      // noise of one sample
    sensor[i].stability_mps2 = 0.001;  // drift since the calibration
    for (int c = 0; c < 3; ++c) sensor[i].axis[c] = axes[i][c];
  }
  plumb_config config;
  plumb_config_defaults(&config);
  config.sensors = 4;
  config.sensor = sensor;
  refused(plumb_monitor_init(storage, sizeof storage, workspace, sizeof workspace, &config, &monitor));
  plumb_sample_defaults(&sample);
  plumb_verdict_defaults(&verdict);
}

void loop() {
  if (monitor == nullptr) return;
  sample.time_s = 1e-6 * micros();
  sample.delivered = 15;
  for (int i = 0; i < 4; ++i) sample.raw[i] = (analogRead(A0 + i) - 2048) * (2.0 * 9.80665 / 2048.0);  // m/s^2
  if (refused(plumb_monitor_step(monitor, &sample, &verdict)) || verdict.transition.sequence == 0) return;
  Serial.print(plumb_state_text(verdict.state));
  Serial.print(", ");
  Serial.println(plumb_cause_text(verdict.cause));
}
