/// `HealthMonitor`: one `step(sample)` at a time it says which sensors may be believed, which way is
/// down and within what bound. No heap, no exceptions, no clock, no global state; bounded work in every
/// step; plain copyable state, so a copy is an assignment and a replay is a loop. What outlives a power cycle is
/// written by `snapshot` and taken up by `restore` (health/snapshot.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plumb/detection/channel_monitor.hpp"
#include "plumb/detection/combination_mae.hpp"
#include "plumb/detection/isolation.hpp"
#include "plumb/detection/near_lengths.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/health/calibration_check.hpp"
#include "plumb/health/decision.hpp"
#include "plumb/health/episode.hpp"
#include "plumb/health/freshness.hpp"
#include "plumb/health/intake.hpp"
#include "plumb/health/monitor_config.hpp"
#include "plumb/health/monitor_setup.hpp"
#include "plumb/health/noise_study.hpp"
#include "plumb/health/recalibration.hpp"
#include "plumb/health/reference_study.hpp"
#include "plumb/health/rest_reference.hpp"
#include "plumb/health/rotation.hpp"
#include "plumb/health/slow_motion.hpp"
#include "plumb/health/snapshot.hpp"
#include "plumb/health/temperature_rate.hpp"
#include "plumb/health/trend.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What was not used, and why.
struct MonitorCounters {
  std::uint32_t samples = 0;          ///< offered
  std::uint32_t time_refused = 0;     ///< time not finite or not increasing
  std::uint32_t gaps = 0;             ///< longer than the longest gap, or no channel at all
  std::uint32_t temperature_out = 0;  ///< outside the calibrated span and its margin, or not finite
  std::uint32_t moving_blocks = 0;
  std::uint32_t rotating_blocks = 0;

  static constexpr auto fields() noexcept {
    using C = MonitorCounters;
    return field_list(&C::samples, &C::time_refused, &C::gaps, &C::temperature_out, &C::moving_blocks,
                      &C::rotating_blocks);
  }
};

class HealthMonitor {
 public:
  HealthMonitor() noexcept = default;

  /// Checks the setup and powers on: suspect, unproven; recalibrating, qualifier initial_calibration, where the setup
  /// has no calibration: output is invalid until the monitor has accepted its own. On an error the monitor is left
  /// unconfigured and every step answers `invalid`. Errors: wrong_mode (paper); those of `checked(config)`;
  /// too_few_sensors; not_calibrated (misalignment terms left in the model, or its size is not the array's, or a setup
  /// without a calibration for a build without `kCalibratesItself`);
  /// range_too_small (index = sensor) where a full scale does not reach gravity plus
  /// kFullScaleMargin beside the bias (value = reach, limit = needed [m/s^2]).
  Expected<void> configure(const MonitorSetup& setup) noexcept;

  /// `configure`, then takes up what `snapshot` wrote under an equal setup, but for gravity: that in force is the
  /// snapshot's until `set_gravity`. The next step answers as the monitor that wrote it would have, bit for bit. Bytes
  /// behind the snapshot are not read. Errors: those of `configure`, with the monitor left unconfigured; snapshot_...,
  /// with the monitor as after `configure`, unproven, and the cause in its verdict (`snapshot_refusal`).
  Expected<void> restore(const MonitorSetup& setup, const std::uint8_t* bytes, std::size_t size) noexcept;

  /// Writes all that the monitor remembers; returns the bytes written. Not during a step. Errors: not_calibrated (not
  /// configured: there is nothing to write); buffer_too_small.
  Expected<std::size_t> snapshot(std::uint8_t* to, std::size_t room) const noexcept;
  /// Bytes that `snapshot` would write now. It varies with what there is to remember.
  std::size_t snapshot_size() const noexcept;
  /// Never more than so many bytes.
  static constexpr std::size_t snapshot_size_max() noexcept;

  /// One sample in, one verdict out. Accepts any bit pattern. The reference stays valid until the next call.
  const Verdict& step(const Sample& sample) noexcept;
  const Verdict& verdict() const noexcept { return verdict_; }

  /// Leaves `failed` at the next step: the named sensors return to service where they deliver.
  /// Error: wrong_key. Ignored in any other state (model/state_table.txt).
  Expected<void> reset(std::uint64_t key, SensorSet sensors) noexcept;

  /// Asks for new biases and scales of the sensors in service: taken at the next step. Error:
  /// wrong_state (value = HealthState) unless the monitor is nominal, isolated or degraded with no alarm on record, or
  /// suspect for a reason that no sensor is accused of (reference, contradiction) and with sensors to spare; always in
  /// a build without `kRecalibrates`. may_accelerate (value = the bound [m/s^2]) where an acceleration is allowed for:
  /// a fit would take it for biases.
  Expected<void> request_recalibration() noexcept;

  /// Offers a calibration made elsewhere, both parts of it, over all configured sensors. Biases and scales of the
  /// sensors in service are tried in the shadow at stations visited from now on, by every test that a fit of the
  /// monitor's own must pass, and adopted or refused; the calibration in force is untouched until then. What is wrong
  /// with it at sight is refused at once: errors those of `request_recalibration`, then those of
  /// `Recalibration::offer`. It takes the place of a request that
  /// waits, lapses as one does, and after a day without the stations to try it. An acceleration bound widens what it is
  /// tried by and does not keep it out.
  Expected<void> offer_calibration(const SensorModel& model, const SensorArray& array) noexcept;

  /// Another length of gravity (depth has changed). Error: implausible_gravity; then nothing changes.
  Expected<void> set_gravity(const GravityReference& gravity) noexcept;

  /// How the tool turns. Error: not_finite (rate). With known lever arms and a known constant rate what the sensors
  /// feel of it is taken off; else evidence rests while the tool turns by more than kStillRate_radps.
  static constexpr double kStillRate_radps = 0.02;  ///< 0.04 mm/s^2 at 0.1 m
  Expected<void> set_rotation(const Rotation& rotation) noexcept;

  /// The next sample may have any time: a recording has been played and the run begins, or the clock was set. What was
  /// measured before is no evidence of now: the output is held until that sample, and invalid from it to the next block
  /// at rest. What the monitor has learned stays: validation, exclusions, doubts.
  void begin_time_base() noexcept;

  /// Freezes exclusion, setting aside, reinstatement, and the start and the adoption of a recalibration, until
  /// released. Never held back: a lost channel, rank < 3, failed. Patience goes on, too: who freezes the way out of a
  /// doubt has not ended it, and beyond the alert limit nothing else would warn. Either is recorded as a notice.
  void inhibit(bool frozen) noexcept;

  const MonitorCounters& counters() const noexcept { return counters_; }
  const SensorArray& array() const noexcept { return array_; }
  const SensorModel& model() const noexcept { return model_; }
  const Recalibration& recalibration() const noexcept { return recalibration_; }
  /// Sensors whose calibration has been accepted: all, or those in service when the monitor made its own. The others do
  /// not serve any more.
  SensorSet calibrated() const noexcept { return calibrated_; }
  const MonitorConfig& config() const noexcept { return config_; }
  const ChannelMonitor& channels() const noexcept { return gate_; }
  const CombinationMae& mae() const noexcept { return mae_; }
  Mode mode() const noexcept { return mode_; }

 private:
  struct BlockView;  // what one quiet block said
  /// What a block said is a level: a channel event that ranks before it must not make it unsaid.
  static constexpr EventMask kKeptEvents =
      bit(HealthEvent::alarm) | bit(HealthEvent::contradiction) | bit(HealthEvent::reference);

  // health_monitor.cpp: the flow of one step
  void derive_limits() noexcept;
  void power_on(const MonitorSetup& setup) noexcept;
  void empty_windows() noexcept;
  void refuse(const Sample& sample) noexcept;
  void collect_sample(const Sample& sample, GateResult& gate) noexcept;
  void compare_with_block(const Sample& sample, GateResult& gate) noexcept;
  void compare_in_motion(const Readings& y, SensorSet usable) noexcept;
  void forget_studies() noexcept;
  bool joins_block(SensorSet usable) noexcept;
  Readings readings_now(const Sample& sample, GateResult& gate) noexcept;
  bool is_rotation_modelled() const noexcept { return rotation_.rate_known && lever_arms_known_; }
  void add_readings(const Readings& y, SensorSet usable, double count) noexcept;
  bool is_eventful(Arrival arrival, const GateResult& gate) const noexcept;
  void serve(const Sample& sample, Arrival arrival, GateResult& gate) noexcept;
  EventMask allowed(EventMask raised) const noexcept;
  void take_rotation_off(Readings& y, GateResult& gate) const noexcept;

  // memory.cpp: storage that changed though nobody wrote to it
  bool core_holds() const noexcept;
  bool steady_holds() const noexcept;
  std::uint64_t steady_now() const noexcept;
  bool whole() const noexcept;
  void seal() noexcept;
  const Verdict& lose_memory(const Sample& sample) noexcept;

  // publish.cpp: the verdict
  void give_notice(double time_s) noexcept;
  std::uint16_t usable_bits() const noexcept;
  Validity validity() const noexcept;
  void publish_claims(Validity validity) noexcept;
  bool is_fresh() const noexcept;
  void publish_decision(const BlockView& view) noexcept;
  void publish_vector(const BlockTests& tests) noexcept;
  bool protected_now(Validity validity) const noexcept;
  void publish_sample(const Sample& sample) noexcept;
  bool news() const noexcept;
  void publish(const Sample& sample, bool tick) noexcept;

  // evidence.cpp: one block
  EventMask tick(const Sample& sample) noexcept;
  double clear_fraction() const noexcept;
  BlockView judge(const BlockTests& tests) const noexcept;
  void judge_mae(const BlockTests& tests, BlockView& view) const noexcept;
  BlockNoise learn_noise() noexcept;
  void note_block(const BlockNoise& noise) noexcept;
  BlockJudgement close_block(double time_s, bool turning, bool& slow) noexcept;
  void leave_to_motion(bool turning) noexcept;
  EventMask serve_block_at_rest(const Sample& sample, const BlockTests& tests, const BlockView& view,
                                const RawBlock& raw) noexcept;
  void allow_for_drift(BlockEvidence& evidence) const noexcept;
  void allow_for_steps(BlockEvidence& evidence) const noexcept;
  bool moves_slowly(const BlockNoise& noise, bool turning, BlockJudgement& judged) const noexcept;
  bool bears_motion(const BlockView& view) const noexcept;
  EventMask serve_slow_block(const Sample& sample, const BlockTests& tests, const BlockView& view) noexcept;
  EventMask raise_block_events(const BlockView& view) noexcept;
  void collect(const BlockView& view, const RawBlock& raw, EventMask raised) noexcept;

  // facts.cpp: what single channels did
  double predicted(int sensor, const BlockEvidence& evidence) const noexcept;
  bool note_facts(const BlockJudgement& judged, bool moving) noexcept;
  SensorSet noise_confirmed() const noexcept;
  SensorSet witnesses() const noexcept;
  void note_stuck(const BlockEvidence& evidence) noexcept;
  void name_causes(SensorSet named, Cause cause) noexcept;
  SensorSet doubted() const noexcept { return (noisy_ | stuck_ | full_scale_) & in_service_; }

  // check_calibration.cpp: the calibration's first attitudes
  bool check_calibration(const BlockView& view) noexcept;
  bool may_convict(SensorSet culprits) const noexcept;

  // gravity_finding.cpp: the length of gravity
  void study_reference(const BlockView& view) noexcept;
  void tell_reference(bool trusted) noexcept;
  void widen_gravity(const ReferenceFinding& found) noexcept;

  // rotation_request.cpp: what the host could do about doubt
  double proving_change_mps2(int sensor) const noexcept;
  RotationRequest rotation_request() const noexcept;
  RotationRequest proving_turn() const noexcept;
  RotationRequest resolving_turn() const noexcept;

  // record.cpp: what is kept from block to block
  Vec3 known_direction(const SetTest& test) const noexcept;
  bool is_still_there() const noexcept;
  void leave_station() noexcept;
  void follow_station(const Sample& sample, const SetTest& pose) noexcept;
  bool answers_by_scatter(const BlockTests& tests) const noexcept;
  void vote(const BlockTests& tests) noexcept;
  void count_doubt(const BlockView& view) noexcept;
  bool is_out_of_stations() const noexcept;
  bool is_out_of_blocks() const noexcept;
  bool patience_is_over() const noexcept;
  bool is_isolable() const noexcept;
  void count_unbounded(const BlockTests& tests, const BlockView& view) noexcept;
  void count_clean(const BlockTests& tests, const BlockView& view) noexcept;
  SensorSet culprits() const noexcept;
  void examine_probation(const BlockTests& tests, const BlockView& view) noexcept;
  double motion_in_bound_rad() const noexcept;
  double least_share_felt(SensorSet usable) const noexcept;
  double hidden_turn_rad(SensorSet usable) const noexcept;
  void rescan(const BlockTests& tests) noexcept;

  // recalibrating.cpp: the shadow fit
  bool may_recalibrate() const noexcept;
  void drop_request() noexcept;
  bool expected(HealthEvent event) const noexcept;
  EventMask advance_recalibration(double time_s) noexcept;
  SensorSet serve_fit(Action::Bits actions) noexcept;
  void adopt() noexcept;
  void follow_first_calibration(Mode from) noexcept;
  void take_span(const StationStore& store) noexcept;
  bool owes_calibration() const noexcept { return kCalibratesItself && calibrated_.empty(); }
  void follow_suspicion(HealthEvent event, Mode from) noexcept;
  Mode published_mode() const noexcept { return mode_ == Mode::recalibrating ? base_ : mode_; }

  // decision.cpp: one event
  HealthEvent decide(EventMask raised, double time_s) noexcept;                        // the event that was taken
  SensorSet carry_out(const Decision& decision, const DecisionState& after) noexcept;  // the sensors that it names
  void forget_episode() noexcept;
  void sets_changed() noexcept;
  void judge_again(const BlockTests& tests) noexcept;
  SizeClass classify(SensorSet set) const noexcept;

  // snapshot.cpp: what outlives a power cycle
  std::uint64_t identity(const MonitorSetup& setup) const noexcept;
  Expected<void> take_up(const MonitorSetup& setup, const std::uint8_t* bytes, std::size_t size) noexcept;
  bool resume(const MonitorSetup& setup) noexcept;
  bool calibration_is_plausible(const MonitorSetup& setup) const noexcept;
  bool sets_are_plausible() const noexcept;
  bool mode_is_plausible() const noexcept;
  bool verdict_is_plausible() const noexcept;

  // What was configured.
  MonitorConfig config_;
  SensorModel model_;
  CoefficientsAt coefficients_;  ///< of that model
  SensorArray array_;
  GravityReference gravity_;
  Mat3 frame_{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<float, kCapacity> resolution_mps2_{};
  std::array<StabilityNow, kCapacity> stability_{};
  TestLimits limits_;
  double restless_factor_ = 0.0;
  double mae_quantile_ = 0.0;
  double k_integrity_ = 0.0;
  int protection_faults_ = 1;
  int asserted_left_ = -1;
  std::uint64_t identity_ = 0;  ///< of the setup, gravity left out

  // What is remembered.
  Mode mode_ = Mode::suspect;
  SizeClass size_class_ = SizeClass::rank_lost;  ///< of the sensors in service
  ReferenceKind told_reference_ = ReferenceKind::none, reference_notice_ = ReferenceKind::none;
  double gravity_widened_mps2_ = 0.0;  ///< part of three sigma of gravity that the monitor found, not the host stated
  int live_ = 0;                       ///< voting sets alive
  SensorSet in_service_, set_aside_, excluded_, absent_;
  SensorSet readmitted_;
  SensorSet calibrated_;
  bool unproven_ = true, exhausted_ = false, moving_ = false;
  Flag temperature_out_;
  bool partial_ = false;  ///< a sensor in service was silent or doubted in the last block: nobody vouches for it
  bool have_evidence_ = false;
  bool have_predictions_ = false;
  Flag configured_;                ///< not remembered, but here is room for it
  bool stability_stated_ = false;  ///< of every sensor; not remembered either
  double evidence_time_s_ = 0.0, last_temperature_degc_ = 25.0;
  Freshness freshness_;  ///< of the evidence
  SampleClock clock_;
  SilenceCounter silence_;
  EventMask pending_ = 0;  ///< block events that a channel event pushed back
  SensorSet block_usable_;
  double drift_rad_ = 0.0;  ///< turn since the block before, at one station
  int unbounded_run_ = 0;   ///< blocks in a row without a bound within the alert limit, and without a way out
  std::uint32_t sequence_ = 0;
  int clean_run_ = 0;
  /// Stands for the sum in a monitor that was never configured, or whose memory was lost. It is not zero: storage that
  /// somebody cleared holds no verdict, and must not pass for a monitor that waits to be configured.
  static constexpr std::uint32_t kNeverConfigured = 0x706c756d;
  std::uint32_t core_sum_ = kNeverConfigured;  ///< not remembered: over `core()`, made whenever that was written to
  std::array<float, kCapacity> least_prediction_{}, most_prediction_{};  ///< over clean blocks while unproven
  DirectionRecord probation_;
  SensorSet on_probation_;
  SensorSet reset_sensors_;
  bool reset_pending_ = false;
  Grade last_grade_ = Grade::none;

  Mode base_ = Mode::suspect;      ///< what recalibrating was entered from
  Cause suspicion_ = Cause::none;  ///< the last block event that keeps the monitor in suspect
  bool recalibration_asked_ = false, recalibration_due_ = false;  ///< by the host; by the policy, after an exclusion
  bool three_sensor_fit_ = false;
  bool lever_arms_known_ = false;  // beside other single bytes: here they cost no room
  Flag rotation_locked_;
  bool inhibited_ = false, inhibit_notice_ = false, calibration_notice_ = false;
  double store_g_mps2_ = 0.0;  ///< gravity when the store was last empty
  /// Calibrated span: as configured, else that of the stations of the monitor's own calibration.
  double temperature_min_degc_ = 0.0, temperature_max_degc_ = 0.0;

  // Facts about single channels.
  std::array<Cause, kCapacity> sensor_cause_{};
  std::array<std::uint8_t, kCapacity> noisy_run_{};  ///< quiet blocks in a row for certain
  std::array<double, kCapacity> stuck_since_{};      ///< what the others predicted when the reading stopped changing
  SensorSet noisy_, stuck_, full_scale_;             ///< the others insist on it
  SensorSet calm_, stuck_watch_, aside_;
  MonitorCounters counters_;

  // What the host said.
  std::array<Vec3, kCapacity> lever_arm_m_{};
  Rotation rotation_;

  // Evidence.
  ScatterRecord scatter_;
  NoiseStudy noise_study_;
  SlowMotion slow_motion_;
  ReferenceStudy reference_study_;
  CalibrationCheck check_;
  Trend trend_;
  TemperatureRate temperature_rate_;
  ChannelMonitor gate_;
  BlockAccumulator block_;
  RawBlock raw_;  ///< the same samples before the sensor model
  CombinationMae mae_;
  Isolation isolation_;
  Episode episode_;
  StationTrack station_;
  RestReference rest_;
  LeastSquares map_;  ///< of the sensors in service
#if PLUMB_SINGLE
  NearLengths near_;  ///< of the block at hand, by that map
  void forget_near() noexcept { near_.forget(); }
  bool near_holds() const noexcept { return near_.holds(); }
#else
  void forget_near() noexcept {}
  bool near_holds() const noexcept { return true; }
#endif
  BlockEvidence evidence_;  ///< last quiet block
  IsolationAnswer answer_;
  FaultSetScan scan_;
  SensorSet clipped_, not_finite_;
  Recalibration recalibration_;
  Verdict verdict_;

  std::uint64_t steady_sum_ = 0;  ///< the same over all but `changing()`

  friend struct FieldsOf;
  friend struct StorageAccess;  // of the tests: they forge storage so that the sums do not tell
  /// What a step writes to that ends no block and raises no event.
  static constexpr auto changing() noexcept {
    using M = HealthMonitor;
    return field_list(&M::coefficients_, &M::temperature_out_, &M::last_temperature_degc_, &M::clock_, &M::counters_,
                      &M::rotation_locked_, &M::block_, &M::raw_, &M::mae_, &M::clipped_, &M::not_finite_,
                      &M::core_sum_,
#if PLUMB_SINGLE
                      &M::near_,
#endif
                      &M::steady_sum_);
  }
  static constexpr auto core() noexcept {
    using M = HealthMonitor;
    return field_list(&M::mode_, &M::size_class_, &M::live_, &M::in_service_, &M::set_aside_, &M::excluded_,
                      &M::absent_, &M::readmitted_, &M::calibrated_, &M::unproven_, &M::exhausted_, &M::moving_,
                      &M::partial_, &M::have_evidence_, &M::configured_, &M::stability_stated_, &M::reset_pending_,
                      &M::recalibration_asked_, &M::recalibration_due_, &M::three_sensor_fit_, &M::lever_arms_known_,
                      &M::inhibited_, &M::inhibit_notice_, &M::calibration_notice_, &M::rotation_, &M::gate_,
                      &M::freshness_, &M::verdict_);
  }
  static constexpr auto fields() noexcept {
    using M = HealthMonitor;
    return field_list(
        // configured
        not_stored(&M::config_), &M::model_, not_stored(&M::coefficients_), &M::array_, &M::gravity_,
        not_stored(&M::frame_), not_stored(&M::resolution_mps2_), not_stored(&M::stability_), not_stored(&M::limits_),
        not_stored(&M::restless_factor_), not_stored(&M::mae_quantile_), not_stored(&M::k_integrity_),
        not_stored(&M::protection_faults_), within(&M::asserted_left_, -1, 3), not_stored(&M::identity_),
        // remembered
        up_to(&M::mode_, Mode::failed), not_stored(&M::size_class_),
        up_to(&M::told_reference_, ReferenceKind::common_bias),
        up_to(&M::reference_notice_, ReferenceKind::common_bias), &M::gravity_widened_mps2_,
        within(&M::live_, 0, kVotingCapacity), &M::in_service_, &M::set_aside_, &M::excluded_, &M::absent_,
        &M::readmitted_, &M::calibrated_, &M::unproven_, &M::exhausted_, &M::moving_, &M::temperature_out_,
        &M::partial_, &M::have_evidence_, &M::have_predictions_, not_stored(&M::configured_),
        not_stored(&M::stability_stated_), &M::evidence_time_s_, &M::last_temperature_degc_, &M::freshness_, &M::clock_,
        &M::silence_, &M::pending_, &M::block_usable_, &M::drift_rad_, within(&M::unbounded_run_, 0, kMostCleanBlocks),
        &M::sequence_, within(&M::clean_run_, 0, kMostCleanBlocks), not_stored(&M::core_sum_),
        per_sensor(&M::least_prediction_), per_sensor(&M::most_prediction_), &M::probation_, &M::on_probation_,
        &M::reset_sensors_, &M::reset_pending_, up_to(&M::last_grade_, Grade::asserted), up_to(&M::base_, Mode::failed),
        up_to(&M::suspicion_, kLastCause), &M::recalibration_asked_, &M::recalibration_due_, &M::three_sensor_fit_,
        not_stored(&M::lever_arms_known_), &M::rotation_locked_, &M::inhibited_, &M::inhibit_notice_,
        &M::calibration_notice_, &M::store_g_mps2_, &M::temperature_min_degc_, &M::temperature_max_degc_,
        within(&M::sensor_cause_, 0, static_cast<int>(kLastCause)), per_sensor(&M::noisy_run_),
        per_sensor(any(&M::stuck_since_)), &M::noisy_, &M::stuck_, &M::full_scale_, &M::calm_, &M::stuck_watch_,
        &M::aside_, &M::counters_, not_stored(&M::lever_arm_m_), &M::rotation_,
        // evidence
        &M::scatter_, &M::noise_study_, &M::slow_motion_, &M::reference_study_, &M::check_, &M::trend_,
        &M::temperature_rate_, &M::gate_, &M::block_, &M::raw_, &M::mae_, &M::isolation_, &M::episode_, &M::station_,
        &M::rest_, not_stored(&M::map_),
#if PLUMB_SINGLE
        not_stored(&M::near_),
#endif
        &M::evidence_, &M::answer_, &M::scan_, &M::clipped_, &M::not_finite_, &M::recalibration_, &M::verdict_,
        not_stored(&M::steady_sum_));
  }
};

constexpr std::size_t HealthMonitor::snapshot_size_max() noexcept {
  return kSnapshotFrameSize + stored_size_max<HealthMonitor>();
}

}  // namespace PLUMB_ABI
}  // namespace plumb
