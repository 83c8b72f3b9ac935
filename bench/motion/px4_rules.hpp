/// Two rules of PX4 that choose between units of three accelerometers each, re-stated from its sources (named in
/// px4_rules.cpp), with the parameters that those ship with. For comparison only: not in the library. What PX4 knows
/// beside accelerometers (GNSS, barometer, driver errors) is not simulated and stays silent.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plumb/core/vec3.hpp"

namespace plumb_bench {

inline constexpr std::size_t kMostUnits = 8;

/// What each unit reads, in one common frame [m/s^2]; a set of units is a mask, bit u.
struct UnitVectors {
  std::size_t count = 0;
  std::array<plumb::Vec3, kMostUnits> vector{};
  std::uint32_t delivered = 0;
};

/// PX4 hands its readings on as velocity gained over 5 ms (IMU_INTEG_RATE), still at the place of each unit.
class Px4Means {
 public:
  static constexpr double kPeriod_s = 0.005;
  explicit Px4Means(double rate_hz) noexcept;
  /// True when a mean is complete; a unit that missed a sample of it is not in `delivered`.
  bool add(const UnitVectors& reading) noexcept;
  const UnitVectors& mean() const noexcept { return mean_; }
  /// 5 ms, or a sample where those are longer.
  double period_s() const noexcept { return samples_ * period_s_; }

 private:
  double period_s_;
  int samples_;
  UnitVectors mean_;
  int count_ = 0;
};

/// PX4's estimator selector: how far each unit lies from the mean of all, smoothed, is integrated where it exceeds
/// EKF2_SEL_IMU_ACC. Once an integral exceeds EKF2_SEL_IMU_VEL, the unit with the largest one is at fault. A faulty
/// unit stays in the mean. The selector's other reasons are innovations against GNSS and barometer.
class Px4Selector {
 public:
  /// The unit at fault, as a mask; 0: none.
  std::uint32_t step(const UnitVectors& reading, double period_s) noexcept;

 private:
  std::array<plumb::Vec3, kMostUnits> smooth_{};
  std::array<double, kMostUnits> excess_mps_{};
};

/// PX4's sensor voter compares no unit with another: it trusts one less after driver errors, silence, or when it
/// repeats itself, which is all that can happen here. Repetitions of the three axes add up; one that moves ends them.
class Px4Voter {
 public:
  /// The units that it no longer trusts.
  std::uint32_t step(const UnitVectors& reading, double period_s) noexcept;

 private:
  std::array<plumb::Vec3, kMostUnits> last_{};
  std::array<int, kMostUnits> repeats_{};
  std::array<double, kMostUnits> silent_s_{};
};

}  // namespace plumb_bench
