/// Flights that several tests fly.
#pragma once

#include <array>
#include <cstring>
#include <vector>

#include "plumb/scenario/flight.hpp"
#include "plumb/scenario/random.hpp"

namespace plumb {
namespace scenario {
namespace flight_test {

inline constexpr std::array<FlightKind, kFlightKinds> kKinds = {FlightKind::drone, FlightKind::drilling,
                                                                FlightKind::car, FlightKind::launch};

/// Eight sensors in random directions, 30 mm from the reference point.
inline FlightSpec spec_of(FlightKind kind, std::uint64_t seed, int sensors = 8) {
  FlightSpec spec;
  spec.kind = kind;
  spec.seed = seed;
  const Stream draws(17, Purpose::test);
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(sensors); ++i) {
    spec.axis.push_back(draws.direction(i));
    spec.lever_arm_m.push_back(scaled(draws.direction(100 + i), 0.03));
  }
  return spec;
}

/// The same without any errors and noise.
inline FlightSpec perfect_spec(FlightKind kind, std::uint64_t seed, int sensors = 8) {
  FlightSpec spec = spec_of(kind, seed, sensors);
  spec.box = FlightErrorBox::none();
  spec.noise_mps2 = 0.0;
  spec.gyro_noise_radps = 0.0;
  spec.full_scale_mps2 = 1000.0 * kG0_mps2;
  return spec;
}

inline std::vector<FlightSample> fly(const FlightSpec& spec, int samples) {
  Flight flight(spec);
  std::vector<FlightSample> out;
  for (int k = 0; k < samples; ++k) out.push_back(flight.next());
  return out;
}

inline bool same_bits(const FlightSample& a, const FlightSample& b) {
  static_assert(sizeof(FlightSample) == sizeof(double) * (1 + kCapacity + 3 * (kMostGyros + 3)), "no padding");
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace flight_test
}  // namespace scenario
}  // namespace plumb
