/// Specific force at the reference point, and how wrong it can be: solution separation over the faults that explain the
/// evidence, on top of what noise and the stated errors of healthy sensors allow (docs/theory.md, T11).
#pragma once

#include <limits>

#include "plumb/motion/motion_evidence.hpp"
#include "plumb/motion/motion_parity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

enum class ForceValidity : std::uint8_t {
  none,       ///< too few sensors deliver, the rotation is unknown, or several units failed and are not excluded yet
  unchecked,  ///< the bound holds while no further unit fails: the loss of one leaves no vector to compare with
  bounded     ///< the bound holds whichever one further unit fails
};
const char* to_string(ForceValidity validity) noexcept;

/// What a bound is made of; `fault` is how far the estimate would move without a unit that may have failed.
enum class ForceTerm : std::uint8_t { noise, lever_arm, rotation, lag, rectification, scale, axis, bias, fault };
inline constexpr int kForceTerms = 9;
const char* to_string(ForceTerm term) noexcept;

/// Tool frame, SI. A triangle-weighted mean over two adjacent blocks.
struct SpecificForce {
  ForceValidity validity = ForceValidity::none;
  double time_s = 0.0;  ///< the instant that it belongs to: the middle of the samples behind it
  double span_s = 0.0;  ///< length of each of the two blocks
  Vec3 force_mps2{};
  Mat3 covariance_m2ps4{};                                      ///< of the noise alone
  double bound_mps2 = std::numeric_limits<double>::infinity();  ///< of the length of the error; infinite: none
  ForceTerm dominant = ForceTerm::noise;                        ///< the largest part of the bound
  bool gyro_assumed = false;  ///< it holds while the only gyro is healthy: nothing corroborates that one
  SensorSet used;
};

/// What is known when a force is estimated.
struct ForceEvidence {
  const RejectedSets* rejected = nullptr;  ///< what is on record, this pair of blocks included
  SensorSet isolated;  ///< faulty in every explanation, and not in the force: one unit more may have failed
  bool gyro_assumed = false;
  const MotionReadings* without_gyro = nullptr;  ///< where a faulty gyro explains what is on record too
};

/// Least squares of the sensors in use, and of them without each unit.
class ForceEstimator {
 public:
  ForceEstimator() noexcept = default;
  ForceEstimator(const SensorArray& array, SensorSet sensors) noexcept;

  const LeastSquares& all() const noexcept { return all_.map; }
  SpecificForce estimate(const MotionSetup& setup, const SensorUnits& units, const MotionMeans& means,
                         const MotionReadings& readings, const ForceEvidence& evidence) const noexcept;

 private:
  struct Fit {
    LeastSquares map;
    double noise_mps2 = 0.0;  ///< what noise of one sample may add to the estimate
    std::array<double, static_cast<std::size_t>(kMotionCapacity)> gain{};  ///< lengths of the columns
  };
  /// What the estimate is if one explanation is true.
  struct Explanation {
    const Fit* fit = nullptr;
    const MotionReadings* readings = nullptr;
    double force_mps2 = 0.0;  ///< its length
    double away_mps2 = 0.0;   ///< from the published one
    double reach_mps2 = 0.0;  ///< and wrong by at most, together
  };
  static Fit fit_of(const SensorArray& array, SensorSet sensors) noexcept;
  static Explanation explain(const Fit& fit, const MotionSetup& setup, const MotionReadings& readings,
                             const SpecificForce& force, double noise) noexcept;
  static ForceTerm dominant_of(const Explanation& one, const MotionSetup& setup, double noise) noexcept;

  Fit all_;
  std::array<Fit, static_cast<std::size_t>(kMotionCapacity)> without_{};
};

}  // namespace PLUMB_ABI
}  // namespace plumb
