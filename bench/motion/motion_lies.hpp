/// What faulty sensors and a faulty gyro make of the readings of a flight, sample by sample.
#pragma once

#include <cstdint>
#include <vector>

#include "flight_case.hpp"

namespace plumb_bench {

/// splitmix64: the same numbers on every machine.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }
  int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
  double uniform() { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in the logarithm.
  double scale(double low, double high);
  plumb::Vec3 direction();

 private:
  std::uint64_t state_;
};

/// What the false part of a reading follows.
enum class LieShape : std::uint8_t {
  force,    ///< all liars read as if one false force were added: they agree with each other
  turned,   ///< all liars read the true force turned by an angle
  apart,    ///< each liar an error of its own sign
  scale,    ///< the reading times a factor
  copy,     ///< the reading of another sensor
  late,     ///< the own reading of some samples ago
  stuck,    ///< the reading at which the lie began
  garbage,  ///< not a number, infinite, 1e300 and the like
  silent,   ///< not delivered
  clipped,  ///< told to be at full scale
};
inline constexpr int kLieShapes = 10;
const char* to_string(LieShape shape) noexcept;

/// How the size changes from sample to sample.
enum class LieCourse : std::uint8_t { constant, ramp, sine, square, pulses, stairs, noise };
inline constexpr int kLieCourses = 7;
const char* to_string(LieCourse course) noexcept;

struct Lie {
  LieShape shape = LieShape::force;
  LieCourse course = LieCourse::constant;
  double size_mps2 = 0.0;
  plumb::Vec3 direction{};
  int other = 0;   ///< the sensor that is copied
  int period = 1;  ///< samples: of the course, and of the delay of a late reading
  std::uint64_t seed = 0;
};

/// One flight of an adversary: who lies, and the array it is about.
struct LieScene {
  plumb::SensorArray array;
  plumb::LeastSquares map;  ///< of all sensors: the force that is turned
  plumb::SensorSet liars;
  int gyro = -1;  ///< the gyro that lies; -1: none does
};

/// A lie of any kind; every second one of a false force is one with which two honest sensors agree.
Lie drawn_lie(const LieScene& scene, Draw& draw);
/// The same with one part of it changed.
Lie changed_lie(const Lie& lie, const LieScene& scene, Draw& draw);

/// `told` is what a flight gives; sample `k` since the lie began, `begin + k` of the flight.
plumb::MotionSample with_lie(const std::vector<plumb::MotionSample>& told, std::size_t begin, std::size_t k,
                             const LieScene& scene, const Lie& sensors, const Lie& gyro);

}  // namespace plumb_bench
