/// What the stations leave open, sensor by sensor: the null directions of a fit report turned into combinations of as
/// few datasheet values as possible. A null space has no natural basis, and that of an eigenvalue routine mixes every
/// sensor into every direction.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/calibration/calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

enum class ParameterKind : std::uint8_t { bias, scale, axis };

/// One datasheet value that takes part in a null direction.
struct NullTerm {
  ParameterKind kind = ParameterKind::bias;
  int sensor = 0;
  double amount = 0.0;  ///< in prior sigmas; signed for bias and scale, the length of the tilt for an axis
  Vec3 turn{};          ///< axis: unit vector across the nominal axis about which it turns; else zero
};

/// One unobservable combination.
struct NullCombination {
  NullDirection direction;  ///< unit length, prior units, common rotations left in where that needs fewer values
  int terms = 0;
  std::array<NullTerm, std::size_t{3} * kCapacity> term{};  ///< the largest first; below kNullTermShare omitted
  bool rotates_all = false;                                 ///< the axis terms are one rotation of all sensors
  Vec3 rotation{};                                          ///< then its unit vector
};

/// Terms below this part of the largest one are not named.
inline constexpr double kNullTermShare = 0.2;

using NullCombinations = std::array<NullCombination, kMaxNullDirections>;

/// Writes as many combinations as the report holds null directions (at most kMaxNullDirections) and returns their
/// number. Together with the gauge they span what the null directions span: nothing is added or lost, the order is from
/// one value of one sensor to all values of all sensors.
int null_combinations(const Datasheet& datasheet, const FitReport& report, NullCombinations& out) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
