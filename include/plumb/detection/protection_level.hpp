/// How far off a vector may be under one explanation of a block: these sensors are healthy, whatever the others read.
#pragma once

#include "plumb/detection/detail/block_tests.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What the protection level covers beside the separation of the consistent explanations.
struct ProtectionTerms {
  int faults = 1;            ///< fault sets of at most so many members: those that the priors leave to be covered
  double k_integrity = 0.0;  ///< sigmas of noise and calibration
  int provisional = 0;       ///< sensors that are provisionally excluded: so many are suspected at least
  bool doubted = false;      ///< an alarm is on record: so many as explain it at least are suspected
  bool unvalidated = false;  ///< some sensor has not been seen to follow a turn since power-on: one more may be faulty

  /// Faults that are suspected, if the alarm on record takes `least` to explain.
  int suspected(int least) const noexcept {
    const int by_alarm = doubted ? least : 0;
    return by_alarm > provisional ? by_alarm : provisional;
  }
};

/// K: so many faults the protection level covers (docs/theory.md, section 7.3). The priors' number; where some are
/// suspected, the confirmed grade, at most three, and no fewer than those; where some sensor is not validated, one more
/// than the priors' number, as far as that grade goes. With four sensors one is all.
int faults_covered(const ProtectionTerms& terms, int suspected, int confirmed_grade) noexcept;

/// Largest angle between `x_mps2` and the truth if the sensors `rest`, with their test, are the healthy ones: their own
/// estimate, `k_integrity` sigmas of its noise and calibration, and drift within the tolerances of the block.
double separation_rad(const BlockTests& tests, const Vec3& x_mps2, SensorSet rest, const SetTest& test,
                      const ProtectionTerms& terms) noexcept;

/// The same where the axes of `rest` lie in one plane. They tell the part of the vector in it, and the length of
/// gravity the part across it but for its sign: the truth is one of two, mirrored in the plane. 0 where no vector of
/// gravity's length can explain them; pi where they do not span a plane.
double mirror_separation_rad(const BlockTests& tests, const Vec3& x_mps2, SensorSet rest,
                             const ProtectionTerms& terms) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
