/// `HealthMonitor`: one `step(sample)` at a time it says which sensors may be believed, which way is
/// down and within what bound. No heap, no exceptions, no clock, no global state; bounded work in every
/// step; plain copyable state, so a copy is an assignment and a replay is a loop. What outlives a power cycle is
/// written by `snapshot` and taken up by `restore` (health/snapshot.hpp).
///
///   static plumb::HealthMonitor monitor;                     // large: not on a small stack
///   if (!monitor.configure(setup)) return refused();         // MonitorSetup: calibrated axes, noise, settings
///   for (;;) {
///     const plumb::Verdict& v = monitor.step(next_sample());
///     if (v.validity == plumb::Validity::valid) use(v.gravity_mps2, v.protection_level_calibrated_axes_rad);
///     if (v.transition.sequence != 0) log(v.transition);     // something changed: a good time for a snapshot
///   }
///
/// examples/ideas has a program of 25 lines for each thing that can be asked of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plumb/health/detail/monitor_state.hpp"
#include "plumb/health/detail/publish.hpp"
#include "plumb/health/monitor_setup.hpp"
#include "plumb/health/motion_finding.hpp"
#include "plumb/health/snapshot.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class HealthMonitor {
 public:
  HealthMonitor() noexcept = default;

  /// Checks the setup and powers on: suspect, not yet validated; recalibrating, qualifier initial_calibration, where
  /// the setup has no calibration: output is invalid until the monitor has accepted its own. On an error the monitor is
  /// left unconfigured and every step answers `invalid`. Errors: wrong_mode (paper); those of `checked(config)`;
  /// too_few_sensors; not_calibrated (misalignment terms left in the model, or its size is not the array's, or a setup
  /// without a calibration for a build without `kCalibratesItself`);
  /// range_too_small (index = sensor) where a full scale does not reach gravity plus
  /// kFullScaleMargin beside the bias (value = reach, limit = needed [m/s^2]).
  Expected<void> configure(const MonitorSetup& setup) noexcept;

  /// `configure`, then takes up what `snapshot` wrote under an equal setup, but for gravity: that in force is the
  /// snapshot's until `set_gravity`. The next step answers as the monitor that wrote it would have, bit for bit. Bytes
  /// behind the snapshot are not read. Errors: those of `configure`, with the monitor left unconfigured; snapshot_...,
  /// with the monitor as after `configure`, not yet validated, and the cause in its verdict (`snapshot_refusal`).
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

  /// Leaves `failed` at the next step: the named sensors serve again where they deliver; of a chip the named axes.
  /// Error: wrong_key. Ignored in any other state (model/state_table.txt).
  Expected<void> reset(std::uint64_t key, SensorSet sensors) noexcept;

  /// Asks for new biases and scales of the sensors in service: taken at the next step. Error:
  /// wrong_state (value = HealthState) unless the monitor is nominal, isolated or degraded with no alarm on record, or
  /// suspect for a cause that suspects no sensor (norm mismatch, no consistent hypothesis), redundancy left; always in
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
  static constexpr double kStillRate_radps = Intake::kStillRate_radps;
  Expected<void> set_rotation(const Rotation& rotation) noexcept;

  /// What a monitor in motion found at this sample (`motion_finding` in health/motion_link.hpp), before every step
  /// while one runs beside. While the tool moves, an alarm leads to `suspect` and its exclusions are taken over,
  /// provisionally; nothing else comes of it (REQ-200). Then rest decides. A host that never calls it has the monitor
  /// without motion.
  void set_motion(const MotionFinding& finding) noexcept;

  /// The next sample may have any time: a recording has been played and the run begins, or the clock was set. What was
  /// measured before is no evidence of now: the output is held until that sample, and invalid from it to the next block
  /// at rest. What the monitor has learned stays: validation, exclusions, suspicions.
  void begin_time_base() noexcept;

  /// Freezes exclusion, provisional exclusion, reinstatement, and the start and the adoption of a recalibration, until
  /// released. Never held back: a lost channel, rank < 3, failed. The isolation timeout goes on, too: who freezes the
  /// way out of a doubt has not ended it, and beyond the alert limit nothing else would warn. Either is recorded as a
  /// notice.
  void inhibit(bool frozen) noexcept;

  const MonitorCounters& counters() const noexcept { return state_.counters; }
  const SensorArray& array() const noexcept { return state_.in_force.array; }
  const SensorModel& model() const noexcept { return state_.in_force.model; }
  const Recalibration& recalibration() const noexcept { return state_.recalibration; }
  /// Sensors whose calibration has been accepted: all, or those in service when the monitor made its own. The others do
  /// not serve any more.
  SensorSet calibrated() const noexcept { return state_.in_force.calibrated; }
  const MonitorConfig& config() const noexcept { return state_.settings.config; }
  const ChannelMonitor& channels() const noexcept { return state_.intake.gate; }
  const CombinationMae& mae() const noexcept { return state_.window.mae; }
  Mode mode() const noexcept { return state_.machine.mode; }

 private:
  struct Block;  // the one that is complete

  // configure.cpp: how it begins
  void set_up(const MonitorSetup& setup) noexcept;
  void derive_limits() noexcept;
  void power_on(const MonitorSetup& setup) noexcept;

  // health_monitor.cpp: the order of a step
  bool is_eventful(Arrival arrival, const GateResult& gate) const noexcept;
  void collect_sample(const Sample& sample, GateResult& gate) noexcept;
  void compare_with_block(const Sample& sample, GateResult& gate) noexcept;
  void compare_in_motion(const Readings& y, SensorSet usable) noexcept;
  void refuse(const Sample& sample) noexcept;
  void serve(const Sample& sample, Arrival arrival, GateResult& gate) noexcept;
  void serve_gap(Arrival arrival) noexcept;
  EventMask serve_rows(const Sample& sample, GateResult& gate, bool& ticked) noexcept;
  HealthEvent take_event(EventMask raised, EventMask from_motion, double time_s) noexcept;
  void empty_windows() noexcept;
  void publish_now(const Sample& sample, bool ticked) noexcept;

  // serve_block.cpp: a block that is complete
  EventMask tick(const Sample& sample) noexcept;
  BlockNoise learn_noise() noexcept;
  SensorSet witnesses_of_rest(const BlockNoise& noise) const noexcept;
  Block close_block(double time_s, bool turning) noexcept;
  bool moves_slowly(const BlockNoise& noise, bool turning, BlockJudgement& judged) const noexcept;
  bool bears_motion(const BlockReport& report) const noexcept;
  void follow_motion(const BlockTests& tests, const BlockReport& report) noexcept;
  void leave_to_motion(bool turning) noexcept;
  EventMask serve_block_at_rest(const Sample& sample, const BlockTests& tests, const BlockReport& report,
                                const RawBlock& raw, bool as_stated) noexcept;
  EventMask serve_slow_block(const Sample& sample, const BlockTests& tests, const BlockReport& report) noexcept;
  bool check_calibration(const BlockReport& report) noexcept;
  void study_gravity(const BlockReport& report) noexcept;
  void collect_station(const BlockReport& report, const RawBlock& raw, EventMask raised) noexcept;
  void keep_report(const BlockReport& report) noexcept;
  void keep_vector(const BlockTests& tests) noexcept;

  // serve_event.cpp: one event
  HealthEvent decide(EventMask raised, EventMask from_motion, double time_s) noexcept;
  SensorSet carry_out(const Decision& decision, const SensorLedger& before) noexcept;
  void sets_changed() noexcept;
  void judge_again() noexcept;
  void follow_finding(const Decision& decision) noexcept;
  void record(HealthEvent event, Mode from, Cause cause, SensorSet named, double time_s) noexcept;
  void give_notice(double time_s) noexcept;

  // recalibrating.cpp: the shadow fit
  void drop_request() noexcept;
  EventMask advance_recalibration(double time_s) noexcept;
  SensorSet serve_fit(Action::Bits actions) noexcept;
  void adopt() noexcept;
  void follow_first_calibration(Mode from) noexcept;
  void take_span(const StationStore& store) noexcept;
  void follow_suspicion(HealthEvent event, Mode from, Cause cause) noexcept;

  // memory.cpp: storage that changed though no program wrote to it
  bool core_holds() const noexcept;
  bool steady_holds() const noexcept;
  std::uint64_t steady_now() const noexcept;
  bool whole() const noexcept;
  void seal() noexcept;
  const Verdict& lose_memory(const Sample& sample) noexcept;

  // snapshot.cpp: what outlives a power cycle
  std::uint64_t identity(const MonitorSetup& setup) const noexcept;
  Expected<void> take_up(const MonitorSetup& setup, const std::uint8_t* bytes, std::size_t size) noexcept;
  bool resume(const MonitorSetup& setup) noexcept;

  MonitorState state_;
  Verdict verdict_;  ///< what was said last

  /// Stands for the sum in a monitor that was never configured, or whose memory was lost. It is not zero: storage that
  /// somebody cleared holds no verdict, and must not pass for a monitor that waits to be configured.
  static constexpr std::uint32_t kNeverConfigured = 0x706c756d;
  std::uint64_t steady_sum_ = 0;               ///< over all but `changing()`
  std::uint32_t core_sum_ = kNeverConfigured;  ///< over `core()`; both are made whenever that was written to
  Flag configured_;

  friend struct FieldsOf;
  friend struct StorageAccess;  // of the tests: they forge storage so that the sums do not tell
  /// What a step writes to that ends no block and raises no event.
  static constexpr auto changing() noexcept {
    return field_list(&HealthMonitor::core_sum_, &HealthMonitor::steady_sum_);
  }
  static constexpr auto core() noexcept { return field_list(&HealthMonitor::state_, &HealthMonitor::verdict_); }
  static constexpr auto fields() noexcept {
    using M = HealthMonitor;
    return field_list(&M::state_, &M::verdict_, not_stored(&M::steady_sum_), not_stored(&M::core_sum_),
                      not_stored(&M::configured_));
  }
};

constexpr std::size_t HealthMonitor::snapshot_size_max() noexcept {
  return kSnapshotFrameSize + stored_size_max<HealthMonitor>();
}

}  // namespace PLUMB_ABI
}  // namespace plumb
