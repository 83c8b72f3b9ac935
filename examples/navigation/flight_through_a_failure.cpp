// A navigator in flight through the failure of a chip: once the chip reads 0.1 g too much on all axes, once it is dead.
// Arguments, both of them optional: the seed of the flight, a file to be written for flight_through_a_failure.gp.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "drone.hpp"
#include "navigators.hpp"

namespace {

using plumb::scenario::FlightFaultKind;

std::string chips_of(plumb::SensorSet sensors) {
  std::string out;
  for (int chip = 0; chip < kChips; ++chip) {
    if (!(sensors & sensors_of(chip)).empty()) out += std::to_string(chip + 1);
  }
  return out.empty() ? "-" : out;
}

bool fly(const char* name, const plumb::scenario::FlightSpec& spec, std::FILE* csv) {
  static plumb::MotionMonitor monitor;
  Drone drone(spec);
  if (!monitor.configure(drone.array(), drone.setup())) return false;
  Navigators navigators;
  plumb::SensorSet isolated, excluded;
  std::printf("\nchip %d %s from %.0f s on\n  time   with  (bound)  without  isolated  excluded\n", kFailedChip + 1,
              name, kFailure_s);
  for (int k = 0; k <= 20000; ++k) {
    const plumb::MotionSample sample = drone.next();
    const plumb::MotionVerdict& v = monitor.step(sample);
    navigators.step(sample, v, drone.truth());
    const double with_mps = navigators.with_mps(), without_mps = navigators.without_mps();
    const bool news = !isolated.contains(v.isolated) || !excluded.contains(v.excluded);
    if (news || (k > 0 && k % 2000 == 0)) {
      std::printf("%6.3f  %5.3f  (%5.2f)  %7.3f  %5s  %8s\n", sample.time_s, with_mps, navigators.allowed_mps(),
                  without_mps, chips_of(v.isolated).c_str(), chips_of(v.excluded).c_str());
    }
    isolated = isolated | v.isolated;
    excluded = excluded | v.excluded;
    if (csv != nullptr && k % 50 == 0)
      std::fprintf(csv, "%s,%.2f,%.4f,%.4f,%.4f\n", name, sample.time_s, with_mps, navigators.allowed_mps(),
                   without_mps);
  }
  std::printf("force and rate are of %.1f ms ago, the mean of two samples; the velocity is of %.1f ms ago\n",
              1e3 * navigators.force_age_s(), 1e3 * (navigators.force_age_s() - 0.5 * kPeriod_s));
  return true;
}

}  // namespace

int main(int count, char** arguments) {
  const std::uint64_t seed = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 1;
  std::FILE* csv = count > 2 ? std::fopen(arguments[2], "w") : nullptr;
  if (count > 2 && csv == nullptr) return 1;
  std::printf("Error of the velocity [m/s] with plumb, what its bound allows, and without plumb.\n");
  const bool flown = fly("biased", Drone::spec_of(seed, FlightFaultKind::bias, 0.1 * plumb::kG0_mps2), csv) &&
                     fly("dead", Drone::spec_of(seed, FlightFaultKind::dead, 0.0), csv);
  if (csv != nullptr) std::fclose(csv);
  return flown ? 0 : 1;
}
