// Writes the flight that host and target play: metal_motion_record SENSORS FILE. A drone with that many sensors of a
// cone and two gyros; one sensor reads 0.5 g too much from the middle on, and one gyro dies later.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "motion_recording.hpp"
#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/scenario/flight.hpp"

namespace {

using namespace plumb;

constexpr std::uint64_t kRows = 4000;

scenario::FlightSpec flight_of(int sensors) {
  AxisList axes{};
  cone(axes, sensors);
  scenario::FlightSpec out;
  out.seed = 7;
  out.gyros = 2;
  for (int i = 0; i < sensors; ++i) {
    out.axis.push_back(axes[static_cast<std::size_t>(i)]);
    out.lever_arm_m.push_back({0.02 * ((i & 1) == 0 ? 1.0 : -1.0), 0.01 * ((i & 2) == 0 ? 1.0 : -1.0), 0.005});
  }
  out.faults = {{scenario::FlightFaultKind::bias, SensorSet::of(1), 0.5 * kG0_mps2, 2.0}};
  out.gyro_faults = {{scenario::GyroFaultKind::dead, 1, 0.0, 3.0}};
  return out;
}

/// From data sheets, beyond what the simulator draws.
MotionSetup setup_of(const scenario::FlightSpec& flight) {
  MotionSetup out;
  for (std::size_t i = 0; i < flight.axis.size(); ++i) {
    out.lever_arm_m[i] = flight.lever_arm_m[i];
    out.errors[i] = {1e-3, 70e-6, 2e-5, 1e-3, 1.5e-3, 1e-3 * kG0_mps2};
  }
  out.gyro = {0.01, 0.01, rad_from_deg(0.35), rad_from_deg(0.1), 20e-6};
  out.rate_bound_radps = 8.0;
  return out;
}

/// Counted first, then written.
void write_flight(metal::WordWriter& words, const scenario::FlightSpec& spec) {
  const std::size_t sensors = spec.axis.size();
  words.word(metal::kMotionMagic);
  words.word(sensors);
  words.word(kRows);
  words.number(spec.noise_mps2);
  for (const Vec3& axis : spec.axis) {
    for (const double part : axis) words.number(part);
  }
  MotionSetup setup = setup_of(spec);
  metal::transfer_motion_setup(words, setup, sensors);
  scenario::Flight flight(spec);
  for (std::uint64_t k = 0; k < kRows; ++k) {
    const scenario::FlightSample truth = flight.next();
    MotionSample sample;
    sample.time_s = truth.time_s;
    sample.reading_mps2 = truth.reading_mps2;
    for (std::size_t g = 0; g < sample.rate_radps.size(); ++g) sample.rate_radps[g] = truth.rate_radps[g];
    metal::transfer_motion_row(words, sample, sensors);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int sensors = argc == 3 ? std::atoi(argv[1]) : 0;
  if (sensors < 4 || sensors > 8) {
    std::fputs("usage: metal_motion_record 4..8 FILE\n", stderr);
    return 2;
  }
  const scenario::FlightSpec spec = flight_of(sensors);
  metal::WordWriter count(nullptr, 0);
  write_flight(count, spec);
  std::vector<std::uint64_t> words(count.used() + 1);
  words[0] = count.used();
  metal::WordWriter writer(words.data() + 1, count.used());
  write_flight(writer, spec);
  std::ofstream out(argv[2], std::ios::binary);
  out.write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(8 * words.size()));
  out.close();
  if (out) return 0;
  std::fprintf(stderr, "%s cannot be written\n", argv[2]);
  return 3;
}
