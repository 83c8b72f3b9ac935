/// Parity of two adjacent blocks while the tool moves: what the lever arms add is taken off, what healthy sensors may
/// still be off by is bounded, and every minimal dependent set of axes is held against its own limit (theorem T11).
#pragma once

#include "plumb/motion/motion_sets.hpp"
#include "plumb/motion/motion_window.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Omega = w w' - |w|^2 1 + [alpha]x, so that a sensor at r feels the specific force of the reference point and Omega
/// r.
struct RotationTerm {
  bool known = false;         ///< some bound of the rotation exists
  Mat3 omega_per_s2{};        ///< what is taken off; zero where only a bound is known
  double error_per_s2 = 0.0;  ///< what the true one differs by, operator norm
  /// Two gyros read more apart than both could within their bounds: one of them is faulty, whichever.
  bool gyros_disagree = false;
};

/// What the rotation rests on.
enum class RotationSource : std::uint8_t {
  gyro,  ///< one gyro, right where that gyro is healthy; with two of them, right where either is
  bound  ///< the fastest that the tool turns: right without any gyro
};

RotationTerm rotation_term(const MotionSetup& setup, const MotionMeans& means, RotationSource source,
                           double noise_quantile) noexcept;

/// What a healthy reading may be off by, apart: lever arm, rotation, lag, rectification, scale, axis, bias.
inline constexpr int kErrorParts = 7;
using ErrorParts = std::array<double, kErrorParts>;

/// Readings of a pair of blocks as they would be at the reference point.
struct MotionReadings {
  SensorSet usable;
  SensorSet at_least, at_most;  ///< at full scale throughout: the true one is beyond the reading, but for its error
  Readings corrected_mps2{};
  Readings error_mps2{};  ///< of a healthy one at most: the parts together; noise, and what a turned axis mixes in of
                          ///< the force, are left out
  std::array<ErrorParts, kMotionCapacity> part_mps2{};
  double noise_factor = 0.0;  ///< times sigma: what noise may add to a reading
};
/// All are unusable where nothing bounds the rotation.
MotionReadings corrected(const SensorArray& array, const MotionSetup& setup, const MotionMeans& means,
                         const RotationTerm& rotation, double noise_quantile) noexcept;

/// Whether the readings of a set contradict each other. Only they and the rotation decide about it (REQ-202). A member
/// at full scale counts as an inequality (theorem T11).
bool rejects(const SensorArray& array, const MotionSetup& setup, const MotionSet& set,
             const MotionReadings& readings) noexcept;

/// False only where no set of `sets` within `fit.used` is rejected: then they need not be asked one by one.
bool may_reject(const SensorArray& array, const MotionSets& sets, const MotionReadings& readings,
                const LeastSquares& fit) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
