// A run of survey stations: drill, pumps off, wait for a still block, take the station or say why not, pumps on. The
// second accelerometer of four dies at 30 s: no station after that is a go until the tool has a redundant set again.
#include "survey_station.hpp"

#include <cstdio>

#include "body.hpp"

namespace {
constexpr double kDegrees = 57.29577951308232;
plumb::HealthMonitor monitor;
Body body(30.0, 0.0);  // pumps off, it lies on rock: no acceleration is allowed for
}  // namespace

int main() {
  if (!monitor.configure(body.setup())) return 1;
  std::printf("station  inclination   toolface  bound (deg)\n");
  double pumps_off_s = -1.0;
  SurveyStation taken;
  for (int k = 0; k < 6000; ++k) {
    const plumb::Verdict& v = monitor.step(body.next());
    const int phase = k % 400;  // the body turns in the first 100 samples of each 400: that is drilling
    if (phase == 100) {
      pumps_off_s = v.time_s;
      taken = {};
    }
    if (pumps_off_s >= 0.0 && taken.go != Go::go) taken = survey(v, pumps_off_s);
    if (phase != 399) continue;
    pumps_off_s = -1.0;  // 3 s were given: pumps on
    if (taken.go == Go::go) {
      std::printf("%7d  %11.2f %10.2f  %11.2f  go: %s\n", k / 400, taken.tilt.inclination_rad * kDegrees,
                  taken.tilt.toolface_rad * kDegrees, taken.protection_level_housing_rad * kDegrees, taken.reason);
    } else {
      std::printf("%7d            -          -            -  %s: %s\n", k / 400,
                  taken.go == Go::wait ? "wait" : "no go", taken.reason);
    }
  }
}
