/// `HealthMonitor`: one `step(sample)` at a time it says which sensors may be believed, which way is
/// down and within what bound. No heap, no exceptions, no clock, no global state; bounded work in every
/// step; plain copyable state, so a snapshot is an assignment and a replay is a loop.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/calibration/calibration.hpp"
#include "plumb/detection/channel_monitor.hpp"
#include "plumb/detection/combination_mae.hpp"
#include "plumb/detection/isolation.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/health/decision.hpp"
#include "plumb/health/episode.hpp"
#include "plumb/health/intake.hpp"
#include "plumb/health/monitor_config.hpp"
#include "plumb/health/recalibration.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Everything a monitor is built from.
struct MonitorSetup {
  SensorModel model;  ///< of an accepted calibration, common-frame form
  SensorArray array;  ///< calibrated axes with their uncertainty
  GravityReference gravity;
  MonitorConfig config;
  std::array<double, kCapacity> full_scale_raw{};  ///< 0 = unknown
  Mat3 output_frame{1, 0, 0, 0, 1, 0, 0, 0, 1};    ///< tool frame -> output frame, applied to published vectors only
};

/// Checks a setup but for its configuration. Errors: too_few_sensors; not_calibrated; range_too_small; out_of_range
/// (index = sensor whose sigma is too large beside the least, 0: gravity).
Expected<void> checked(const MonitorSetup& setup) noexcept;

class HealthMonitor {
 public:
  HealthMonitor() noexcept = default;

  /// Checks the setup and powers on: suspect, unproven. On an error the monitor is left unconfigured
  /// and every step answers `invalid`. Errors: wrong_mode (paper); those of `checked(config)`; too_few_sensors;
  /// not_calibrated (misalignment terms left in the model, or its size is not the array's);
  /// range_too_small (index = sensor) where a full scale does not reach gravity plus
  /// kFullScaleMargin beside the bias (value = reach, limit = needed [m/s^2]).
  Expected<void> configure(const MonitorSetup& setup) noexcept;

  /// One sample in, one verdict out. Accepts any bit pattern. The reference stays valid until the next call.
  const Verdict& step(const Sample& sample) noexcept;
  const Verdict& verdict() const noexcept { return verdict_; }

  /// Leaves `failed` at the next step: the named sensors return to service where they deliver.
  /// Error: wrong_key. Ignored in any other state (design, section 5).
  Expected<void> reset(std::uint64_t key, SensorSet sensors) noexcept;

  /// Asks for new biases and scales of the sensors in service (design, section 5): taken at the next step. Error:
  /// wrong_state (value = HealthState) unless the monitor is nominal, isolated or degraded with no alarm on record, or
  /// suspect for a reason that no sensor is accused of (reference, contradiction) and with sensors to spare.
  Expected<void> request_recalibration() noexcept;

  /// Another length of gravity (depth has changed). Error: out_of_range.
  Expected<void> set_gravity(const GravityReference& gravity) noexcept;

  const SensorArray& array() const noexcept { return array_; }
  const SensorModel& model() const noexcept { return model_; }
  const Recalibration& recalibration() const noexcept { return recalibration_; }
  const MonitorConfig& config() const noexcept { return config_; }
  const ChannelMonitor& channels() const noexcept { return gate_; }
  const CombinationMae& mae() const noexcept { return mae_; }
  Mode mode() const noexcept { return mode_; }

 private:
  struct BlockView;  // what one quiet block said

  // health_monitor.cpp: the flow of one step
  void power_on(const MonitorSetup& setup) noexcept;
  void empty_windows() noexcept;
  void publish(const Sample& sample, bool tick) noexcept;
  Validity validity() const noexcept;
  void publish_vector() noexcept;

  // evidence.cpp: one block
  EventMask tick(const Sample& sample) noexcept;
  double clear_fraction() const noexcept;
  BlockView judge(const BlockEvidence& evidence) const noexcept;
  void judge_mae(const BlockEvidence& evidence, BlockView& view) const noexcept;
  void follow_station(const Sample& sample, const Vec3& direction) noexcept;
  void vote(const BlockEvidence& evidence, const BlockView& view) noexcept;
  void count_clean(const BlockView& view) noexcept;
  EventMask raise_block_events(const BlockView& view) noexcept;
  SensorSet culprits() const noexcept;
  void examine_probation(const BlockEvidence& evidence, const BlockView& view) noexcept;
  void rescan() noexcept;
  void collect(const BlockView& view, const RawBlock& raw, EventMask raised) noexcept;

  // recalibrating.cpp: the shadow fit
  bool may_recalibrate() const noexcept;
  bool expected(HealthEvent event) const noexcept;
  EventMask advance_recalibration(double time_s) noexcept;
  SensorSet serve_fit(Action::Bits actions) noexcept;
  void adopt() noexcept;
  void follow_suspicion(HealthEvent event, Mode from) noexcept;
  Mode published_mode() const noexcept { return mode_ == Mode::recalibrating ? base_ : mode_; }

  // decision.cpp: one event
  HealthEvent decide(EventMask raised, double time_s) noexcept;                        // the event that was taken
  SensorSet carry_out(const Decision& decision, const DecisionState& after) noexcept;  // the sensors that it names
  void forget_episode() noexcept;
  void sets_changed() noexcept;
  SizeClass classify(SensorSet set) const noexcept;

  // What was configured.
  MonitorConfig config_;
  SensorModel model_;
  SensorArray array_;
  GravityReference gravity_;
  Mat3 frame_{1, 0, 0, 0, 1, 0, 0, 0, 1};
  TestLimits limits_;
  double restless_factor_ = 0.0;
  double mae_quantile_ = 0.0;
  double k_integrity_ = 0.0;
  int protection_faults_ = 1;
  int asserted_left_ = -1;
  bool configured_ = false;

  // What is remembered.
  Mode mode_ = Mode::suspect;
  SizeClass size_class_ = SizeClass::rank_lost;  ///< of the sensors in service
  int live_ = 0;                                 ///< voting sets alive
  SensorSet in_service_, set_aside_, excluded_, absent_;
  SensorSet readmitted_, banned_;
  bool unproven_ = true, exhausted_ = false, moving_ = false, temperature_out_ = false;
  bool partial_ = false;  ///< a sensor in service was silent in the last block: nobody vouches for it
  bool have_evidence_ = false;
  double evidence_time_s_ = 0.0, last_temperature_degc_ = 25.0;
  SampleClock clock_;
  SilenceCounter silence_;
  EventMask pending_ = 0;  ///< block events that a channel event pushed back
  SensorSet block_usable_;
  double drift_rad_ = 0.0;  ///< turn since the block before, at one station
  int unbounded_run_ = 0;   ///< blocks in a row whose protection level was beyond the alert limit
  std::uint32_t sequence_ = 0;
  int clean_run_ = 0;
  std::array<double, kCapacity> least_prediction_{}, most_prediction_{};  ///< over clean blocks while unproven
  bool have_predictions_ = false;
  DirectionRecord probation_;
  SensorSet on_probation_;
  SensorSet reset_sensors_;
  bool reset_pending_ = false;
  Grade last_grade_ = Grade::none;

  Mode base_ = Mode::suspect;      ///< what recalibrating was entered from
  Cause suspicion_ = Cause::none;  ///< the last block event that keeps the monitor in suspect
  bool recalibration_asked_ = false, recalibration_due_ = false;  ///< by the host; by the policy, after an exclusion
  bool three_sensor_fit_ = false;
  double store_g_mps2_ = 0.0;  ///< gravity when the store was last empty

  // Evidence.
  ChannelMonitor gate_;
  BlockAccumulator block_;
  RawBlock raw_;  ///< the same samples before the sensor model
  CombinationMae mae_;
  Isolation isolation_;
  Episode episode_;
  StationTrack station_;
  LeastSquares map_;        ///< of the sensors in service
  BlockEvidence evidence_;  ///< last quiet block
  IsolationAnswer answer_;
  FaultSetScan scan_;
  SensorSet clipped_, not_finite_;
  Recalibration recalibration_;
  Verdict verdict_;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
