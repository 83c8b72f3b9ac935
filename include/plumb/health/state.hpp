/// The six states, the events and the causes: the closed vocabulary of the monitor.
#pragma once

#include <cstdint>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

enum class HealthState : std::uint8_t { nominal, suspect, isolated, degraded_3_sensor, recalibrating, failed };
inline constexpr int kStateCount = 6;
const char* to_string(HealthState state) noexcept;

/// Events in rank order: the first that applies is taken (model/state_table.txt).
enum class HealthEvent : std::uint8_t {
  reset,
  channel_lost,
  channel_back,
  exclusion,
  provisional_exclusion,
  isolation_timeout,
  no_consistent_hypothesis,
  alarm,
  norm_mismatch,
  fit_accepted,
  fit_rejected,
  probation_passed,
  recalibrate,
  passed_block,
  none,
};
inline constexpr int kEventCount = 15;
const char* to_string(HealthEvent event) noexcept;

/// Why the verdict says what it says.
enum class Cause : std::uint8_t {
  none,
  power_on,                  ///< not yet validated since power-on
  parity,                    ///< parity residual beyond its limit
  norm,                      ///< three sensors: length of the vector beyond its limit
  mae,                       ///< a triple's mean absolute error beyond its limit
  norm_mismatch,             ///< parity good, norm off: gravity, common scale, common bias, steady acceleration
  moving,                    ///< spread above the noise: evidence suspended
  isolated_fault,            ///< a sensor was excluded, provisionally or for good
  no_consistent_hypothesis,  ///< no set of sensors is consistent any more
  channel_lost,
  channel_back,
  temperature,  ///< outside the calibrated span
  isolation_timeout,
  calibration,
  probation,
  host_request,  ///< reset, recalibrate
  time_fault,    ///< time not increasing; the sample was refused
  gap,
  passed_block,
  noisy,             ///< a channel scatters by itself: the others are at rest
  stuck,             ///< a channel repeats one value while the others predict a change
  clipped,           ///< a channel is at full scale while the others predict it inside its range
  rotating,          ///< the tool turns and what that does to the readings is not known
  inhibited,         ///< the host inhibited exclusion and recalibration
  released,          ///< ... and let them go
  common_scale,      ///< norm mismatch explained: common scale or gravity, direction usable
  common_bias,       ///< norm mismatch explained: a bias that the sensors share, direction not usable
  snapshot_refused,  ///< switched on without its history: the snapshot that was offered is of no use
  memory,            ///< the memory of the monitor was corrupted: configure the monitor again or restore a snapshot
  calibration_contradicted,  ///< the first attitudes do not keep to what the calibration says of itself
  parity_in_motion,          ///< readings contradict each other while the tool moves: a monitor in motion found it
};
inline constexpr Cause kLastCause = Cause::parity_in_motion;
const char* to_string(Cause cause) noexcept;

/// The cause that an event stands for; `of_block` is what the last block said, for an alarm.
Cause cause_of(HealthEvent event, Cause of_block) noexcept;

/// What the output may be used for, in ascending order: storage that was cleared, and a verdict that was not written,
/// are invalid.
enum class Validity : std::uint8_t { invalid, held, unconfirmed, degraded, valid };
const char* to_string(Validity validity) noexcept;

/// Qualifier bits beside the state.
struct Qualifier {
  static constexpr std::uint16_t not_yet_validated = 1;
  static constexpr std::uint16_t moving = 2;
  static constexpr std::uint16_t initial_calibration = 4;
  static constexpr std::uint16_t provisional = 8;
  static constexpr std::uint16_t no_redundancy = 16;
  static constexpr std::uint16_t timed_out = 32;
  /// The coefficients in force come from a fit that none could check.
  static constexpr std::uint16_t three_sensor_fit = 64;
  static constexpr std::uint16_t inhibited = 128;  ///< the host inhibited exclusion and recalibration
  /// No acceleration bound was stated: vector, protection level and alert hold for a tool that does not accelerate.
  static constexpr std::uint16_t standstill_assumed = 256;
  static constexpr std::uint16_t stability_unstated = 512;  ///< of some sensor: no limit holds its drift
  /// Of some sensor: the calibration states no uncertainty, and every limit and bound takes its row for exact.
  static constexpr std::uint16_t uncertainty_unstated = 1024;
  /// No alignment bound was stated: the calibrated axes are taken for those of the housing.
  static constexpr std::uint16_t alignment_unstated = 2048;
};

/// Grade of an exclusion (docs/theory.md, section 5.1).
enum class Grade : std::uint8_t { none, provisional, confirmed, assumed };
const char* to_string(Grade grade) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
