/// `Verdict`: everything that plumb says about one sample. Plain data, trivially copyable.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/array/geometry.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/detection/detail/triple_set.hpp"
#include "plumb/detection/isolation.hpp"
#include "plumb/health/calibration_check.hpp"
#include "plumb/health/detail/episode.hpp"
#include "plumb/health/recalibration_progress.hpp"
#include "plumb/health/reference_study.hpp"
#include "plumb/health/rotation.hpp"
#include "plumb/health/state.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Written once per change of state or of a mask (property S15). A notice (from = to) records what the host or the
/// evidence said without changing either: inhibited, released, common scale, common bias (event none), and the first
/// alarm of an episode where it changes nothing, as before validation (event alarm).
struct TransitionRecord {
  std::uint32_t sequence = 0;  ///< 1, 2, 3, ... ; 0 = no record in this verdict
  double time_s = 0.0;
  HealthState from = HealthState::suspect;
  HealthState to = HealthState::suspect;
  HealthEvent event = HealthEvent::none;
  Cause cause = Cause::none;
  Grade grade = Grade::none;
  SensorSet sensors;  ///< sensors that the event names (excluded, lost, back)
  double statistic = 0.0;
  double limit = 0.0;

  static constexpr auto fields() noexcept {
    using R = TransitionRecord;
    return field_list(&R::sequence, &R::time_s, up_to(&R::from, HealthState::failed),
                      up_to(&R::to, HealthState::failed), up_to(&R::event, HealthEvent::none),
                      up_to(&R::cause, kLastCause), up_to(&R::grade, Grade::assumed), &R::sensors, any(&R::statistic),
                      any(&R::limit));
  }
};

/// s_i value that stands for "no consistent hypothesis keeps sensor i healthy".
inline constexpr std::uint8_t kNoHypothesis = 255;

/// What of a verdict may be used, one bit each; `validity` says how far.
struct Usable {
  static constexpr std::uint16_t vector = 1;
  static constexpr std::uint16_t inclination = 2;
  static constexpr std::uint16_t toolface = 4;          ///< inclination at least 3 deg away from vertical
  static constexpr std::uint16_t protection_level = 8;  ///< available
  static constexpr std::uint16_t monitored = 16;        ///< the sensors in service check one another
  static constexpr std::uint16_t stationary = 32;
  static constexpr std::uint16_t temperature = 64;   ///< within the calibrated span and its margin, and not in a hurry
  static constexpr std::uint16_t calibration = 128;  ///< accepted, and not one that none could check
  static constexpr std::uint16_t reference = 256;    ///< there is no norm mismatch
};

struct Verdict {
  double time_s = 0.0;
  std::uint32_t sample = 0;  ///< samples offered since power-on, those refused included
  HealthState state = HealthState::suspect;
  std::uint16_t qualifiers = 0;  ///< bits of Qualifier
  Validity validity = Validity::invalid;
  Cause cause = Cause::none;
  bool tick = false;            ///< this sample completed a block: statistic, s_i and vector are new
  bool accepted = false;        ///< the sample was used (time in order, enough channels)
  int block_fill = 0;           ///< samples of the block that is being collected
  TransitionRecord transition;  ///< sequence != 0 where something changed at this sample

  // The test that decided the last block: parity and norm in standard deviations of the block mean, mae in m/s^2.
  Cause decided_by = Cause::none;  ///< parity, norm or mae
  double statistic = 0.0;
  double limit = 0.0;
  double margin = 0.0;  ///< 1 - statistic/limit; negative = alarm

  // Who. configured = in service + provisionally excluded + excluded + absent (property S4).
  SensorSet configured, in_service, provisionally_excluded, excluded, absent;
  SensorSet suspects;                           ///< sensors that are faulty in some consistent hypothesis
  SensorSet clipped, scattering, not_finite;    ///< of this block: channels that did so at all
  SensorSet noisy, stuck, contradicted_clip;    ///< facts of the last block at rest that the others corroborate
  std::array<Cause, kCapacity> sensor_cause{};  ///< why a sensor is out of service or suspected; none = it is not
  std::array<std::uint8_t, kCapacity> minimum_faults{};  ///< s_i: fewest faults that explain the data with i healthy
  Grade grade = Grade::none;                             ///< of the last exclusion
  int confirmed_grade = 0;                               ///< m_strict of the sensors not excluded
  int provisional_grade = 0;
  int consistent_hypotheses = 0;  ///< test subsets still consistent in this episode
  int stations_on_record = 0;     ///< distinct attitudes under suspicion, which count towards the timeout
  bool wants_rotation = false;    ///< another attitude would help: `rotation` says which
  RotationRequest rotation;

  RecalibrationProgress recalibration;  ///< `wanted_direction` in the output frame

  // Figures of the paper: sliding MAE over the window, m/s^2.
  double mae_all_mps2 = 0.0;    ///< of the sensors in service
  double mae_worst_mps2 = 0.0;  ///< largest over the monitored triples in service
  double mae_worst_limit_mps2 = 0.0;
  TripleSet triples_tested,
      triples_passed;   ///< of the last block: in service, well-conditioned, window full; within limit
  double parity = 0.0;  ///< whitened parity residual of the last block
  double parity_limit = 0.0;
  double norm_error_mps2 = 0.0;                             ///< |x| - G of the last block
  double reference_mps2 = 0.0, reference_sigma_mps2 = 0.0;  ///< G and its 1 sigma
  NormMismatch norm_mismatch;                               ///< its kind and size; bias in the output frame
  CalibrationFinding calibration;                           ///< what its first attitudes say against the calibration
  /// Slow drift below the limits, for each sensor as if it alone drifted [m/s^2 per hour]: positive where the sensor's
  /// own reading grows, in the sense of `Reads`. 0 = none found.
  std::array<float, kCapacity> drift_mps2_per_h{};
  /// Noise of all sensors in stated sigmas, as blocks at rest have shown it; above 1 the stated ones are too small, and
  /// every limit is wider for it.
  double noise_factor = 1.0;
  /// Samples that are worth one independent one: above 1 each shares its noise with the one before.
  double noise_correlation = 1.0;
  double temperature_degc = 0.0;               ///< last finite one
  double temperature_rate_degc_per_min = 0.0;  ///< over the last half to whole minute; 0 = not known yet

  // Which way is down.
  Vec3 gravity_mps2{};  ///< last block at rest, sensors in service, positive down, output frame
  Mat3 covariance{};    ///< [(m/s^2)^2], noise and calibration; no acceleration of the tool
  double age_s = 0.0;   ///< since the block that gave the vector
  Vec3 latest_mps2{};   ///< this one sample, no claim made
  // Bounds on the angle between gravity_mps2 and the truth, for every steady acceleration up to the bound that the host
  // stated; 0 where `protection_available` is not set. The first is in the frame of the calibrated axes: how that sits
  // in the housing is not observable from gravity (a common rotation of all axes). The second has `alignment_bound_rad`
  // on top, and speaks of the housing.
  double protection_level_calibrated_axes_rad = 0.0;
  double protection_level_housing_rad = 0.0;
  double toolface_protection_housing_rad = 0.0;  ///< asin(sin PL / sin I) of the second; pi near the vertical
  std::uint16_t usable = 0;                      ///< bits of Usable
  /// K: the level holds for every consistent explanation with at most so many faulty sensors among those monitored;
  /// 0 where there is none. It is the priors' number, and more while faults are suspected (`faults_covered`).
  std::uint8_t faults_covered = 0;
  bool protection_available = false;
  bool alert = true;  ///< unless valid, and the level in the frame of the alert limit within that limit

  Errc snapshot_refusal = Errc::ok;  ///< why the monitor runs without the history that was offered to it
  /// Of what the monitor was configured with (`SnapshotHeader::identity`): equal setups, gravity apart, have equal
  /// ones.
  std::uint64_t config_hash = 0;

  /// What a sample alone changes.
  static constexpr auto changing() noexcept {
    using V = Verdict;
    return field_list(&V::time_s, &V::sample, &V::tick, &V::accepted, &V::transition, &V::clipped, &V::not_finite,
                      &V::mae_all_mps2, &V::temperature_degc, &V::temperature_rate_degc_per_min, &V::block_fill,
                      &V::age_s, &V::latest_mps2);
  }
  /// What a host steers by.
  static constexpr auto core() noexcept {
    using V = Verdict;
    return field_list(&V::state, &V::qualifiers, &V::validity, &V::configured, &V::in_service,
                      &V::provisionally_excluded, &V::excluded, &V::absent, &V::gravity_mps2,
                      &V::protection_level_calibrated_axes_rad, &V::protection_level_housing_rad,
                      &V::toolface_protection_housing_rad, &V::usable, &V::faults_covered, &V::protection_available,
                      &V::alert);
  }
  static constexpr auto fields() noexcept {
    using V = Verdict;
    return field_list(
        any(&V::time_s), &V::sample, up_to(&V::state, HealthState::failed), &V::qualifiers,
        up_to(&V::validity, Validity::valid), up_to(&V::cause, kLastCause), &V::tick, &V::accepted,
        within(&V::block_fill, 0, kWindowCapacity), &V::transition, up_to(&V::decided_by, kLastCause), &V::statistic,
        &V::limit, &V::margin, &V::configured, &V::in_service, &V::provisionally_excluded, &V::excluded, &V::absent,
        &V::suspects, &V::clipped, &V::scattering, &V::not_finite, &V::noisy, &V::stuck, &V::contradicted_clip,
        within(&V::sensor_cause, 0, static_cast<int>(kLastCause)), &V::minimum_faults, up_to(&V::grade, Grade::assumed),
        within(&V::confirmed_grade, 0, kCapacity), within(&V::provisional_grade, 0, kCapacity),
        within(&V::consistent_hypotheses, 0, kVotingCapacity), within(&V::stations_on_record, 0, DirectionRecord::kMax),
        &V::wants_rotation, &V::rotation, &V::recalibration, &V::mae_all_mps2, &V::mae_worst_mps2,
        &V::mae_worst_limit_mps2, &V::triples_tested, &V::triples_passed, &V::parity, &V::parity_limit,
        &V::norm_error_mps2, &V::reference_mps2, &V::reference_sigma_mps2, &V::norm_mismatch, &V::calibration,
        any(&V::drift_mps2_per_h), &V::noise_factor, &V::noise_correlation, &V::temperature_degc,
        &V::temperature_rate_degc_per_min, &V::gravity_mps2, &V::covariance, &V::age_s, &V::latest_mps2,
        &V::protection_level_calibrated_axes_rad, &V::protection_level_housing_rad, &V::toolface_protection_housing_rad,
        &V::usable, &V::faults_covered, &V::protection_available, &V::alert, up_to(&V::snapshot_refusal, kLastErrc),
        not_stored(&V::config_hash));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
