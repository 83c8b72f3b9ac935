/// Readings of several inertial units on one rigid body, and the units brought to one clock and one frame by their
/// gyros: each unit may run on a clock of its own and be mounted anyhow.
#pragma once

#include <cstddef>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/motion/motion_window.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

/// Errors of this module are texts that say what was found and what to do.
template <class T>
using CommissionExpected = tl::expected<T, std::string>;

/// One unit: three accelerometer and three gyro axes that share a clock and a frame.
struct UnitLog {
  std::vector<Vec3> force_mps2;
  std::vector<Vec3> rate_radps;
};

/// Samples of all units by their number, at a regular period; 2 to kMotionCapacity / 3 units of equal length. A rate
/// that is not finite counts as not given: that is how a gyro at full scale is told.
struct MotionLog {
  double period_s = 0.0;
  double full_scale_mps2 = 0.0;  ///< a force that reaches it is clipped; 0: unknown
  std::vector<UnitLog> unit;

  std::size_t samples() const noexcept { return unit.empty() ? 0 : unit.front().rate_radps.size(); }
};

/// Clock and mounting of a unit against the first one.
struct UnitAlignment {
  double delay_s = 0.0;  ///< what the first unit reads at t, this one reads at t + delay
  double delay_sigma_s = 0.0;
  Mat3 to_frame{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< turns its vectors into the first unit's frame
  Vec3 turn_sigma_rad{};                     ///< about the axes of that frame
  Vec3 bias_radps{};                         ///< to be added to the turned rate, so that both have the same mean
  double residual_radps = 0.0;               ///< rms of a smoothed component, after the alignment
  double slip_s = 0.0;                       ///< delay in the second half of the log less that in the first
};

struct AlignmentLimits {
  double delay_s = 0.2;          ///< searched to both sides
  int smoothed_samples = 8;      ///< what is faster tells nothing about delays; 1 where the body turns as fast
  double turn_sigma_rad = 0.01;  ///< a mounting that is known less well is refused
  double slip_s = 0.002;         ///< so is a clock that moves more: a row was lost, or one is there twice
};

/// From the gyros alone. Refused where the body has turned too little, or about one axis only, where the best delay
/// lies at the end of the search, where a clock moves within the log, and where the log is too short or a force not
/// finite.
CommissionExpected<std::vector<UnitAlignment>> align_by_gyros(const MotionLog& log, const AlignmentLimits& limits = {});

/// All units at the instants of the first one, rates in its frame, forces still along the axes of each unit. Shorter
/// than the log by the delays.
MotionLog aligned(const MotionLog& log, const std::vector<UnitAlignment>& alignment);

/// Sample k of an aligned log, as the window and the monitor take it: sensors in the order of the units; one gyro is
/// the mean of the first half of the units, the other that of the second half.
MotionSample sample_of(const MotionLog& aligned_log, std::size_t k);

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
