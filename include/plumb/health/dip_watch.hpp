/// `DipWatch`: the dip of the Earth's field beside a monitor that has three sensors left. What it says is a report
/// beside the verdict: the monitor does not hear of it, and a build that does not use it has none of it.
///
///   static plumb::DipWatch watch;
///   const plumb::Verdict& v = monitor.step(sample);
///   if (v.tick && v.in_service.size() == 3) {
///     const plumb::DipReport r = watch.add(monitor, setup, field_of_this_block, reference);
///     if (r.answer.verdict == plumb::DipVerdict::fault) warn(r.answer.named);   // -1: one of r.answer.suspects
///     if (r.protected_by_dip) use(r.gravity_mps2, r.protection_level_calibrated_axes_rad);
///   }
#pragma once

#include "plumb/detection/dip_evidence.hpp"
#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What the last block of a monitor with three sensors in service says, ready for `judge_dip`; `sigmas` as there. Field
/// and axes are in the tool frame. Where the monitor has just now no block of three
/// sensors at rest its `used` is empty, and `judge_dip` answers `too_few_sensors`.
///
/// Errors are those that the limits of the monitor rest on: noise as learned, what calibration leaves, drift within
/// the stability that is stated, half a code, gravity here and where the tool was calibrated, acceleration.
DipStation dip_station(const HealthMonitor& monitor, const MonitorSetup& setup, const FieldReading& field,
                       const FieldReference& reference) noexcept;

struct DipReport {
  DipAnswer answer;  ///< `gravity_mps2` in the tool frame
  /// The bounds below are made with the dip. False: those of the verdict stand.
  bool protected_by_dip = false;
  Vec3 gravity_mps2{};  ///< output frame; without a sensor that is named, the verdict's
  /// Bounds on the angle between that and the truth while no more than one of the three is faulty and every error is
  /// within what was stated, those of the magnetometers included; as in the verdict, without and with the turn of the
  /// axes in the housing.
  double protection_level_calibrated_axes_rad = kPi, protection_level_housing_rad = kPi;
};

class DipWatch {
 public:
  DipWatch() noexcept = default;
  explicit DipWatch(DipAssumption assumption) noexcept : evidence_(assumption) {}

  /// After a step whose verdict is a tick. Begins anew where other sensors serve than before. The bound is given in
  /// place of the verdict's where it is the smaller one or the verdict has none, the monitor is not failed, and its
  /// `fault_prior` and `integrity_risk` leave no more than one faulty sensor to be covered.
  DipReport add(const HealthMonitor& monitor, const MonitorSetup& setup, const FieldReading& field,
                const FieldReference& reference) noexcept;
  void forget() noexcept { evidence_.forget(); }
  const DipEvidence& evidence() const noexcept { return evidence_; }

 private:
  DipEvidence evidence_;
  SensorSet used_;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept { return field_list(&DipWatch::evidence_, &DipWatch::used_); }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
