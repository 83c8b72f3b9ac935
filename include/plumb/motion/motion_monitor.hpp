/// `MotionMonitor`: what of redundant accelerometers may be trusted while the tool moves. Parity of blocks of 1, 4, 32
/// and 256 samples rejects sets of sensors; who is in every explanation is isolated, and provisionally excluded after a
/// dwell. At every sample it publishes the specific force of the others and how wrong that can be at most.
///
/// It needs neither gravity nor rest, and decides nothing about either: confirmed exclusion, calibration and
/// readmission stay with `HealthMonitor`. Plain data, no heap, no clock; `step` is total over all bit patterns.
#pragma once

#include "plumb/motion/motion_force.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Why no sensor is isolated although readings contradict each other, or why nothing is judged.
enum class MotionCause : std::uint8_t {
  none,               ///< nothing contradicts, or a sensor is isolated
  parity,             ///< readings contradict each other and several explanations are left
  gyro_inconsistent,  ///< a faulty gyro would explain it too
  too_many_faults,    ///< no fault set of as many units as can be searched for explains it
  rotation_unknown,   ///< no gyro and no bound of the rate: nothing is judged
  no_redundancy,      ///< the sensors left do not check each other
  irregular_time,     ///< fewer samples in a row at the stated period than two blocks have: nothing is judged yet
};

const char* to_string(MotionCause cause) noexcept;

struct MotionVerdict {
  SpecificForce sample;      ///< of the last two samples
  SpecificForce block;       ///< of the last two blocks of `block_samples[2]` samples, as a rule 32: tighter and later
  bool block_ended = false;  ///< `block` is new with this sample
  bool alarm = false;        ///< some rejected set is on record
  SensorSet rejected;        ///< members of the sets that the last sample's blocks rejected
  SensorSet suspects;        ///< in some of the smallest explanations
  SensorSet isolated;        ///< in every explanation
  SensorSet excluded;        ///< provisionally, by this monitor
  int least_faults = 0;      ///< units that it takes at least to explain what is on record
  MotionCause cause = MotionCause::none;
  /// The two gyros have read more apart than their bounds allow, within the last `quiet_s`: one of them is faulty, and
  /// which one is not told. Bounds hold all the same; no sensor is blamed for it.
  bool gyros_disagree = false;
};

class MotionMonitor {
 public:
  /// Errors: those of `check`.
  Expected<void> configure(const SensorArray& array, const MotionSetup& setup) noexcept;
  const MotionVerdict& step(const MotionSample& sample) noexcept;
  const MotionVerdict& verdict() const noexcept { return verdict_; }

  /// The sensors that others, a monitor at rest above all, leave in service. What this monitor has excluded itself
  /// stays out; evidence about sensors that leave is dropped.
  void set_in_service(SensorSet sensors) noexcept;
  /// Takes back exclusions and evidence: after rest has confirmed or refuted them. Rest says nothing of gyros.
  void forget() noexcept;

 private:
  /// Whether a gyro that failed is a hypothesis: a single one that nothing corroborates.
  bool doubts_gyro() const noexcept { return setup_.gyros == 1 && !setup_.gyro_corroborated; }
  /// Bit s: the blocks of scale s are judged.
  unsigned judged_scales() const noexcept;
  /// `lowest`: the first of the scales that are judged at this sample.
  void judge(int scale, int lowest) noexcept;
  void decide(double time_s) noexcept;
  void answer(double time_s) noexcept;
  void exclude(double time_s) noexcept;
  void refit() noexcept;
  void trust() noexcept;
  bool reject(const MotionReadings& readings, RejectedSets* record) noexcept;
  SpecificForce force_of(const MotionMeans& means, const MotionReadings& readings,
                         const MotionReadings& without_gyro) const noexcept;
  SensorSet monitored() const noexcept { return in_service_ - verdict_.excluded; }
  int most_faults() const noexcept;
  bool check_each_other(SensorSet sensors) const noexcept;

  SensorArray array_;
  MotionSetup setup_;
  MotionSets sets_;
  MotionWindow window_;
  RejectedSets with_gyro_;     ///< sound while the gyro is, or one of two
  RejectedSets without_gyro_;  ///< sound whatever the gyro reads
  ForceEstimator force_;       ///< of the sensors trusted
  MotionVerdict verdict_;
  SensorSet in_service_;
  SensorSet trusted_;  ///< those that make the force: isolated ones are not among them, where the others determine it
  int grade_ = 0;
  bool redundant_ = false;  ///< those that are monitored check each other
  double noise_quantile_ = 0.0;
  double last_rejection_s_ = 0.0;
  double last_disagreement_s_ = 0.0;
  double isolated_since_s_ = 0.0;
  bool news_ = false;                     ///< a set was rejected that had not been, or evidence was dropped
  MotionCause open_ = MotionCause::none;  ///< why what is on record names nobody
  /// Why the last samples were not judged, until the next block that is.
  MotionCause unjudged_ = MotionCause::irregular_time;
  bool gyro_explains_ = false;  ///< a faulty gyro, with or without sensors beside it, would explain what is on record
  bool configured_ = false;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
