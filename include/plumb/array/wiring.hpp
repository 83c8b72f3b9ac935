/// Mistakes of wiring and polarity, and what is left of them once all sensors are read together. Some are an exact
/// turn or mirror image of the tool: no test on gravity sees those, at any attitude.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Channel i carries `sign[i]` times the reading of sensor `source[i]`.
struct Wiring {
  std::array<std::uint8_t, kCapacity> source{};
  std::array<signed char, kCapacity> sign{};

  static Wiring correct() noexcept;
  static Wiring reversed(int i) noexcept;
  static Wiring swapped(int i, int j) noexcept;
  /// Swapped, and both polarities the wrong way round.
  static Wiring swapped_reversed(int i, int j) noexcept;
  /// Channel i carries sensor j, j carries k, k carries i.
  static Wiring cycled(int i, int j, int k) noexcept;
};

/// Largest effects over all attitudes, for gravity of length 1.
struct WiringEffect {
  double parity = 0.0;    ///< length of the residual that the sensors leave: they contradict one another
  double length = 0.0;    ///< change of the length of the vector
  double turn_rad = 0.0;  ///< of the direction, where neither shows: the angle of the turn, pi for a mirror image
  double inclination_rad = 0.0;  ///< of that, how far the inclination can be off

  /// Both are below what their tests can see.
  bool unseen(double parity_visible, double length_visible) const noexcept {
    return parity <= parity_visible && length <= length_visible;
  }
};

/// All zero where the array has no rank.
WiringEffect wiring_effect(const SensorArray& array, const Wiring& wiring) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
