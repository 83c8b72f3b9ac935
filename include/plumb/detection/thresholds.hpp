/// What an array can find: least faults that are detected and isolated, and how far the direction can be off before
/// anything shows. For a geometry under design, or for a host at start-up; nothing of it runs per sample.
#pragma once

#include <array>

#include "plumb/array/fault_bounds.hpp"
#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// The tests as the monitor is set up to make them (see `MonitorConfig`).
struct TestSettings {
  double samples = 32.0;           ///< N of a block
  double false_alarm_rate = 1e-5;  ///< per block and test
  double rejection_rate = 1e-6;    ///< per block and hypothesis
  double missed_detection = 1e-3;  ///< how often a fault of just the detectable size may be missed, per block
  double integrity_risk = 1e-6;    ///< of the noise in the protection level, two-sided
  int isolation_attitudes = 4;     ///< E: distinct attitudes over which an isolation is confirmed
  double acceleration_mps2 = 0.0;  ///< largest steady acceleration of the tool
  Readings tolerance_mps2{};       ///< tau_i: drift of each sensor that the limits allow for, of either sign
};

/// What limits the sensors of one array: everything as 1 block of `TestSettings::samples`.
struct ErrorBudget {
  Readings noise_mps2{};           ///< sigma_i / sqrt(N)
  Readings calibration_mps2{};     ///< what calibration leaves, k_c sigmas of the worst attitude with the misfit
  Readings systematic_mps2{};      ///< that, and drift within its tolerance
  double noise_factor = 0.0;       ///< k_e: all n sensors stay within k_e sigmas but for the rejection rate
  double parity_systematic = 0.0;  ///< largest b_S of the parity rows at any attitude, in sigmas of a block mean
  double gravity_mps2 = 0.0;       ///< what the length felt may be off: `TestLimits::gravity` sigmas, and acceleration
  TestLimits limits;
};
ErrorBudget error_budget(const SensorArray& array, const GravityReference& gravity,
                         const TestSettings& settings) noexcept;

/// Infinite where the geometry cannot do it at all.
struct SensorThresholds {
  /// Minimum detectable bias: by parity, one block, any attitude, missed with `missed_detection`.
  double detectable_mps2 = 0.0;
  /// Single fault that the provisional grade provisionally excludes with its first block at any attitude, but for
  /// `missed_detection`.
  double provisional_exclusion_mps2 = 0.0;
  /// Raises the parity alarm with every block, at any attitude, while the noise in parity stays below its quantile at
  /// the rejection rate.
  double guaranteed_detection_mps2 = 0.0;
  /// Vector error per unit of bias, |column of H^+|.
  double gain = 0.0;
};

struct Thresholds {
  std::array<SensorThresholds, kCapacity> sensor{};
  /// T7 with the errors of the budget and the limits of the tests [m/s^2]: fault[m] is detected by parity beside m - 1
  /// other units, fault[2m] is suspected by every explanation with at most m faulty units.
  FaultBounds sure{};
  /// Bound on the tilt error at any attitude while nothing alarms: the worst single bias that can go undetected, noise
  /// and calibration (docs/theory.md, section 7.1), and the turn by the acceleration allowed for. pi where parity does
  /// not check every sensor.
  double protection_rad = 0.0;
};

/// `SensorThresholds::guaranteed_detection_mps2` of sensor i, with `ErrorBudget::parity_systematic` for what parity may
/// be off by: at single attitudes it is less than at any.
double guaranteed_detection_mps2(const SensorArray& array, const TestSettings& settings, const ErrorBudget& budget,
                                 int i) noexcept;

/// `Thresholds::protection_rad` alone: cheap enough for a sweep.
double protection_level_rad(const SensorArray& array, const GravityReference& gravity,
                            const TestSettings& settings) noexcept;

/// Units beyond kStrictCapacity: `provisional_exclusion_mps2` for grades up to kScanDepth, as the vote does it.
Thresholds thresholds_of(const SensorArray& array, const GravityReference& gravity,
                         const TestSettings& settings) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
