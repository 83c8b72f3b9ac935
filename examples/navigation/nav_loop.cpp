// plumb in a navigation loop: one sample in, one verdict out, and only what may be believed goes on to the filter.
#include <cstdio>

#include "body.hpp"

static plumb::HealthMonitor monitor;  // 33 kB of plain state: static
static Body body(30.0);               // yours: axes, noise and samples of your sensors; here the second dies at 30 s

int main() {
  if (!monitor.configure(body.setup())) return 1;
  for (int k = 0; k < 6000; ++k) {
    const plumb::Verdict& v = monitor.step(body.next());
    const bool good = v.validity == plumb::Validity::valid || v.validity == plumb::Validity::degraded;
    if (v.tick && good)
      std::printf("%6.2f s  %+.3f %+.3f %+.3f\n", v.time_s, v.gravity_mps2[0], v.gravity_mps2[1], v.gravity_mps2[2]);
    if (v.transition.sequence != 0)
      std::printf("%6.2f s  %s, %s\n", v.time_s, plumb::to_string(v.state), plumb::to_string(v.cause));
  }
}
