/// The rate of redundant gyro triads, right at every sample while few of them fail: the median, component by component.
#pragma once

#include <array>

#include "plumb/core/config.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/motion/motion_setup.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

inline constexpr int kMostTriads = 8;

/// One sample of several gyro triads, each calibrated and turned to the tool frame [rad/s].
struct TriadRates {
  std::array<Vec3, kMostTriads> rate_radps{};
  std::array<bool, kMostTriads> given{};  ///< a rate that is not finite counts as not given
  int triads = 0;
};

struct MedianRate {
  bool given = false;  ///< enough triads deliver to outvote `faults` of them
  Vec3 rate_radps{};
};

/// Of an even number of triads the mean of the two in the middle. While at most `faults` (0 or more) of those that
/// deliver are faulty, each component lies between those of two healthy triads (docs/theory.md, T15): it is off by no
/// more than a healthy triad may be, whatever the faulty ones read and from the first sample on. It takes 2 `faults` +
/// 1 triads that deliver; with fewer, or with `faults` below 0, nothing is given.
///
/// What it is for: a monitor of motion corrects for lever arms by a rate (`MotionSample::rate_radps[0]`), and one gyro
/// alone may blame healthy accelerometers. With this rate, and `MotionSetup::gyro_corroborated`, no single gyro can.
/// Each component may be another triad's at each sample, so what such a gyro is off by has no slope: state it by
/// `median_error_radps` in `MotionSample::interpolation_radps[0]`, and 0 for all of `MotionSetup::gyro` but the lag
/// that all triads have in common against the accelerometers. What they lag each other by is no delay of the median,
/// which jumps between one that leads and one that lags: add sqrt(3) times the largest lag times the angular
/// acceleration.
MedianRate median_rate(const TriadRates& rates, int faults) noexcept;

/// What the median at this length of the rate is off by at most, in length (T15), while the errors of healthy triads
/// are within `triad`, its lag left out (above), and noise within `noise_sigmas` sigmas of each sample. Infinite where
/// scale and axes may be off by so much that the rate says nothing.
double median_error_radps(const GyroErrors& triad, double rate_radps, double noise_sigmas) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
