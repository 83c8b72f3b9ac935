/// Settings of a `HealthMonitor`. Every number has a unit, a default and a reason.
#pragma once

#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/error.hpp"
#include "plumb/core/units.hpp"
#include "plumb/detection/alarm_form.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Whose decisions: `HealthMonitor` takes plumb, `PaperMonitor` takes paper.
enum class MonitorMode : std::uint8_t { plumb, paper };

/// Whose direction the alert limit is about: that of the housing, or of the calibrated axes as the sensors show them.
enum class AlertFrame : std::uint8_t { housing, calibrated_axes };

/// Largest values of settings that bound a counter.
inline constexpr int kMostConfirm = 60000;
inline constexpr int kMostPassedBlocks = 1000;
inline constexpr int kMostIsolationTimeoutBlocks = 1000000;
inline constexpr int kMostAgeSamples = 1000000;

struct MonitorConfig {
  MonitorMode mode = MonitorMode::plumb;
  int window = 32;                 ///< samples per block and length of the sliding MAE window, 1 .. kWindowCapacity
  double delta_f_mps2 = 0.0;       ///< given MAE limit (the paper's); 0 = computed from noise and geometry
  double false_alarm_rate = 1e-5;  ///< per block: of parity, of the norm, of all triples' MAE together; 1e-9 .. 1e-2
  double rejection_rate = 1e-6;    ///< per block and hypothesis: how seldom the true one may be rejected
  int assumed_faults = -1;         ///< the integrator's claim "never more than M faults"; -1 = no claim
  int isolation_stations = 4;      ///< E: excited stations over which an answer must stay unique before it is latched
  int isolation_timeout = 6;       ///< P: distinct attitudes under suspicion before suspect must be bounded
  int passed_blocks = 3;           ///< R: passed blocks in a row that end suspicion
  int forget_blocks = 3;           ///< M: clean excited blocks that end an episode
  int probation_stations = 6;      ///< K: excited stations before an excluded sensor may return
  int missing_confirm = 3;         ///< samples in a row without a usable value: the channel is lost
  int max_age_samples = 0;  ///< T_age in samples, those refused and those that brought nothing included; 0 = two blocks
  double max_gap_s = 5.0;   ///< a longer gap between samples empties windows and ends the station
  /// T_age: without a block at rest for this long nothing is published as valid; 0 = 1 s, or two blocks where they take
  /// longer.
  double max_age_s = 0.0;
  double station_angle_rad = rad_from_deg(2.0);            ///< change of direction that begins a new station
  double distinct_attitude_angle_rad = rad_from_deg(5.0);  ///< directions at least this far apart count as excited
  double clear_fraction = 0.7;                 ///< clean means below this fraction of the limit while in suspect
  double alert_limit_rad = rad_from_deg(1.0);  ///< largest tilt error that the user can bear
  double integrity_risk = 1e-6;                ///< allocation to fault sets that the protection level omits
  double fault_prior = 1e-4;                   ///< probability that one given sensor is faulty
  std::uint64_t reset_key = 0x706c756d62ULL;   ///< what `reset` must be called with
  double temperature_min_degc = -1e9;          ///< calibrated span; beyond it by > 5 degC output is unconfirmed
  double temperature_max_degc = 1e9;
  int isolation_timeout_blocks = 0;              ///< W: the same in blocks at any attitude; 0 = attitudes alone count
  AlarmForm alarm_form = AlarmForm::every_tool;  ///< what false_alarm_rate means with a calibration behind the limits
  bool recalibrate_after_exclusion = false;      ///< estimate biases and scales anew once the survivors are validated
  AlertFrame alert_frame = AlertFrame::housing;  ///< of `alert_limit_rad`
  /// Largest angle of the calibrated axes, as a whole, from the frame of the housing, about any axis. Gravity turns
  /// with it, and no test sees it. 0: the two are taken for one, and every verdict says so (`alignment_unstated`).
  float alignment_bound_rad = 0.0F;
  /// Largest steady acceleration of the tool, in any direction. Gravity and a steady acceleration are one vector to
  /// every accelerometer: across gravity it changes the length by a^2 / 2 G only, which no test sees. 0: the tool
  /// stands still whenever it counts as at rest, and every verdict says that this was assumed (`standstill_assumed`).
  double acceleration_bound_mps2 = 0.0;
  double triple_false_alarm_rate = 0.0;  ///< per block, of each triple's MAE alone; 0 = its share of the above

  /// What a snapshot is bound to: all of it, but never stored.
  static constexpr auto fields() noexcept {
    using C = MonitorConfig;
    return field_list(up_to(&C::mode, MonitorMode::paper), within(&C::window, 1, kWindowCapacity), &C::delta_f_mps2,
                      &C::false_alarm_rate, &C::rejection_rate, within(&C::assumed_faults, -1, 3),
                      within(&C::isolation_stations, 1, 20), within(&C::isolation_timeout, 1, 24),
                      within(&C::passed_blocks, 1, kMostPassedBlocks), within(&C::forget_blocks, 1, 24),
                      within(&C::probation_stations, 1, 24), within(&C::missing_confirm, 1, kMostConfirm),
                      within(&C::max_age_samples, 0, kMostAgeSamples), &C::max_gap_s, &C::max_age_s,
                      &C::station_angle_rad, &C::distinct_attitude_angle_rad, &C::clear_fraction, &C::alert_limit_rad,
                      &C::integrity_risk, &C::fault_prior, &C::reset_key, &C::temperature_min_degc,
                      &C::temperature_max_degc, within(&C::isolation_timeout_blocks, 0, kMostIsolationTimeoutBlocks),
                      up_to(&C::alarm_form, AlarmForm::average_tool), &C::recalibrate_after_exclusion,
                      up_to(&C::alert_frame, AlertFrame::calibrated_axes), &C::alignment_bound_rad,
                      &C::acceleration_bound_mps2, &C::triple_false_alarm_rate);
  }
};

/// `alignment_bound_rad` of any double: what no bound can be comes out beyond the range that `checked` allows.
inline float alignment_bound_of(double bound_rad) noexcept {
  if (bound_rad > 4.0) return 4.0F;
  return bound_rad < -1.0 ? -1.0F : static_cast<float>(bound_rad);
}

/// What the alert limit leaves for an error in the frame of the calibrated axes; no bound is within a limit below 0.
inline double alert_limit_in_axes_rad(const MonitorConfig& config) noexcept {
  const bool turned = config.alert_frame == AlertFrame::housing && config.alignment_bound_rad > 0.0F;
  return turned ? config.alert_limit_rad - static_cast<double>(config.alignment_bound_rad) : config.alert_limit_rad;
}

/// Checks every field. Error: out_of_range or not_finite with the index of the field in the order above. An
/// acceleration bound beside `recalibrate_after_exclusion` is out_of_range (limit 0): a fit takes the length at every
/// station for gravity's, and so what accelerates the tool for biases of its sensors.
Expected<MonitorConfig> checked(const MonitorConfig& config) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
