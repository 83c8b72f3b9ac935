/// Random numbers for simulations: counter-based streams on Random123's Philox4x32-10.
///
/// Value number k of a stream is a pure function of (seed, stream, k). It does not depend on what was
/// drawn before, so threads and ranks agree without talking to each other. Std distributions are not
/// used (their streams differ between standard libraries), nor is libm (portable_math.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// What a stream is for. The numbers are part of every recorded result: never renumber, only append.
enum class Purpose : std::uint8_t {
  truth = 1,      ///< errors of a drawn tool; sub-stream = sensor
  noise = 2,      ///< white noise; sub-stream = sensor
  vibration = 3,  ///< body acceleration between stations
  attitude = 4,   ///< random stations, toolface jitter
  fault = 5,      ///< random faults; sub-stream = position in the list of faults
  seed = 6,       ///< seeds derived from seeds
  test = 7,
  instability = 8,  ///< slow wander of a bias; sub-stream = sensor
  walk = 9,         ///< random walk of a bias; sub-stream = sensor
  link = 10,        ///< rows that are lost; sub-stream = position in the list of faults
  campaign = 11,    ///< what happens in a scenario of a campaign
  flight = 12,      ///< motion, errors and noise of a simulated flight; sub-stream by part
  clock = 13,       ///< of a chip: what it is off by, where its samples lie, their noise; sub-stream by part
};

class Stream {
 public:
  /// `sub` < 2^24 tells streams of one purpose apart (by sensor, by fault).
  Stream(std::uint64_t seed, Purpose purpose, std::uint32_t sub = 0) noexcept;

  /// 64 random bits, value number `index`. `bits`, `uniform` and `normal` at one index are independent.
  std::uint64_t bits(std::uint64_t index) const noexcept;
  /// In [0, 1), a multiple of 2^-53.
  double uniform(std::uint64_t index) const noexcept;
  /// In [low, high].
  double uniform(std::uint64_t index, double low, double high) const noexcept;
  /// Standard normal: Marsaglia and Tsang's ziggurat of 256 layers with 53-bit abscissae and exact tail.
  double normal(std::uint64_t index) const noexcept;
  /// `normal` of `count` numbers from `first` on, bit for bit, several at a time.
  void normals(std::uint64_t first, int count, double* out) const noexcept;
  /// Uniform on the unit sphere.
  Vec3 direction(std::uint64_t index) const noexcept;

 private:
  enum class Kind : std::uint8_t { bits = 0, uniform = 1, normal = 2 };
  struct Block {
    std::uint64_t first = 0, second = 0;
  };
  Block block(std::uint64_t index, Kind kind, std::uint32_t attempt) const noexcept;
  double normal_from(const Block& first, std::uint64_t index) const noexcept;
  double normal_tail(std::uint64_t index, std::uint32_t attempt) const noexcept;

  std::uint64_t seed_;
  std::uint32_t id_;
};

/// Seed number `index` derived from `seed`: independent runs of one campaign, parts of one demo.
std::uint64_t derive_seed(std::uint64_t seed, std::uint64_t index) noexcept;

/// Philox4x32-10 itself, for the known-answer test.
std::array<std::uint32_t, 4> philox_block(const std::array<std::uint32_t, 4>& counter,
                                          const std::array<std::uint32_t, 2>& key) noexcept;

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
