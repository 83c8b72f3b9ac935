/// Noise for tests of the run-time floors (splitmix64 and Box-Muller): not that of the scenario room, which lies above
/// these floors.
#pragma once

#include <cmath>
#include <cstdint>

#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb_test {

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  double uniform() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    z ^= z >> 31U;
    return static_cast<double>(z >> 11U) * 0x1.0p-53;
  }
  double normal() {
    const double u = 1.0 - uniform();
    const double v = uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * plumb::kPi * v);
  }

 private:
  std::uint64_t state_;
};

inline plumb::Vec3 random_direction(Noise& noise) {
  const double z = 2.0 * noise.uniform() - 1.0;
  const double a = 2.0 * plumb::kPi * noise.uniform();
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(a), r * std::sin(a), z};
}

}  // namespace plumb_test
