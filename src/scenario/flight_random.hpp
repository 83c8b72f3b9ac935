/// Which stream of a flight's seed is for what, and numbers of them in order (private to src/scenario).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/scenario/random.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// Sub-streams of Purpose::flight. The numbers are part of every recorded result: never renumber, only append.
namespace flight_stream {
inline constexpr std::uint32_t kCourse = 0;            ///< numbers of the whole flight
inline constexpr std::uint32_t kForce = 1;             ///< targets of the specific force
inline constexpr std::uint32_t kRate = 2;              ///< targets of the angular rate
inline constexpr std::uint32_t kLevel = 3;             ///< targets of the level of vibration
inline constexpr std::uint32_t kShock = 4;             ///< shocks
inline constexpr std::uint32_t kBroadband = 8;         ///< + axis
inline constexpr std::uint32_t kTone = 0x100;          ///< + number of the tone
inline constexpr std::uint32_t kErrors = 0x1000;       ///< + sensor
inline constexpr std::uint32_t kGyroErrors = 0x1800;   ///< + triad
inline constexpr std::uint32_t kNoise = 0x2000;        ///< + sensor
inline constexpr std::uint32_t kGyroNoise = 0x2800;    ///< + 3 triad + axis
inline constexpr std::uint32_t kFaultNoise = 0x10000;  ///< + 32 position in the list + sensor
}  // namespace flight_stream

inline Stream flight_stream_of(std::uint64_t seed, std::uint32_t sub) noexcept {
  return Stream(seed, Purpose::flight, sub);
}

/// Standard normals of one stream in order, drawn many at a time.
class NormalSource {
 public:
  explicit NormalSource(const Stream& stream) noexcept : stream_(stream) {}

  double next() noexcept {
    if (used_ == kAtOnce) {
      stream_.normals(first_, static_cast<int>(kAtOnce), values_.data());
      first_ += kAtOnce;
      used_ = 0;
    }
    return values_[used_++];
  }

 private:
  static constexpr std::size_t kAtOnce = 64;
  Stream stream_;
  std::uint64_t first_ = 0;
  std::size_t used_ = kAtOnce;
  std::array<double, kAtOnce> values_{};
};

/// Numbers of one stream in the order in which they are asked for.
class Draws {
 public:
  explicit Draws(const Stream& stream) noexcept : stream_(stream) {}
  double uniform(double low, double high) noexcept { return stream_.uniform(next_++, low, high); }
  /// Logarithm uniform; 0 < low <= high.
  double log_uniform(double low, double high) noexcept;
  Vec3 direction() noexcept { return stream_.direction(next_++); }

 private:
  Stream stream_;
  std::uint64_t next_ = 0;
};

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
