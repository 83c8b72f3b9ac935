// A chip fails in flight, and what three autopilots are told of it, whenever that changes. Argument, optional: the
// seed.
#include <cstdio>
#include <cstdlib>

#include "autopilots.hpp"

namespace {

using plumb::scenario::FlightFaultKind;

bool fly(const char* name, const plumb::scenario::FlightSpec& spec) {
  static plumb::MotionMonitor monitor;
  Drone drone(spec);
  if (!monitor.configure(drone.array(), drone.setup())) return false;
  Autopilots autopilots;
  std::string last;
  std::printf("\nchip %d %s from %.0f s on\n   time  PX4  healthy  ArduPilot  MAVLink\n", kFailedChip + 1, name,
              kFailure_s);
  for (int k = 0; k <= 20000; ++k) {
    const plumb::MotionSample sample = drone.next();
    const std::string line = autopilots.step(sample, monitor.step(sample));
    if (line != last || k == 20000) std::printf("%7.3f%s\n", sample.time_s, line.c_str());
    last = line;
  }
  std::printf("delta velocities published: %d\n", autopilots.velocities());
  return true;
}

}  // namespace

int main(int count, char** arguments) {
  const std::uint64_t seed = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 1;
  return fly("reads 0.1 g too much", Drone::spec_of(seed, FlightFaultKind::bias, 0.1 * plumb::kG0_mps2)) &&
                 fly("is dead", Drone::spec_of(seed, FlightFaultKind::dead, 0.0))
             ? 0
             : 1;
}
