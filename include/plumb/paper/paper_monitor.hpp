/// `PaperMonitor`: the paper's algorithm, steps 2 to 11, run sample by sample through plumb's state machine. It speaks
/// the same `Verdict` and `TransitionRecord` as `HealthMonitor` and takes its steps from the same transition table, so
/// that the two can be set side by side on one log.
///
/// A class of its own, because its calibration (a fit of all sensors and one per triple, 65 kB at capacity 8) must not
/// burden `HealthMonitor`; in a library of its own (`plumb::paper`), for no instrument needs it. It is meant for
/// comparison on a host and not for bare metal: everything in `step` is bounded and free of heap, but a step that ends
/// a recalibration runs one whole fit (at most kMaxPaperIterations iterations, 100 kB of stack); every block at rest
/// after an alarm reads every triple by its own coefficients.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/health/detail/intake.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/paper/paper_rule.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Everything a paper monitor is built from.
struct PaperSetup {
  /// plumb's own accepted calibration of the same sensors tells motion from rest and gives the parity that is shown;
  /// `config.mode` is paper. Of the configuration these count: window, delta_f_mps2 (0: kPaperDeltaF_mps2),
  /// false_alarm_rate (of the parity limit that is shown), isolation_stations (attitudes pooled before the triples
  /// decide; 1 is the paper's least), isolation_timeout, passed_blocks, forget_blocks, missing_confirm, max_gap_s,
  /// max_age_s, distinct_attitude_angle_rad, clear_fraction, reset_key and the span of temperatures.
  MonitorSetup base;
  Datasheet datasheet;     ///< where the fits start, that of step 10 included
  PaperCalibration paper;  ///< step 1
};

/// Attitudes that differ from each other, by the distance of their vectors rather than by an angle:
/// a sensor that stands still adds nothing to a difference, however far off it stands, and does not hide a turn.
class AttitudeRecord {
 public:
  static constexpr int kMax = 24;
  void clear() noexcept { size_ = 0; }
  int size() const noexcept { return size_; }
  /// Counts the vector if it is that far from all on record; true where it did. A full record counts no more.
  bool add(const Vec3& vector, double distance) noexcept {
    for (int k = 0; k < size_; ++k) {
      if (!(norm(minus(vector_[static_cast<std::size_t>(k)], vector)) >= distance)) return false;
    }
    if (size_ == kMax) return false;
    vector_[static_cast<std::size_t>(size_)] = vector;
    ++size_;
    return true;
  }

 private:
  std::array<Vec3, kMax> vector_{};
  int size_ = 0;
};

/// Where the paper leaves a choice:
/// - Steps 2 to 5: the gate is the MAE of a block (`window` samples at rest) over all sensors used. A block that moves
///   is no evidence, as in `HealthMonitor`.
/// - Step 3: from the block that trips the gate on, all samples at rest are pooled, until the tool has been at
///   `isolation_stations` attitudes. Then steps 4 to 8 judge the pool once, and a new pool begins.
///   Until then a block below the limit does not end the suspicion unless the whole pool is below it (step 5).
/// - Step 9: the MAE of those that would remain, over the means of the pooled attitudes. Where it fails no sensor is
///   excluded: a contradiction, as where no triple passes (Table 2, rows 18 to 23).
/// - Step 10: more than three that remain get a fit of their own: recalibrating. One block at rest per attitude is
///   collected; at 12, 18 and 24 attitudes the fit is tried, and after the last it is refused. Until then, and after a
///   refusal, they are read by the fit of all.
/// - Step 11: three that remain are read by the fit of their triple: degraded.
/// - The paper has no return and no end: an excluded sensor comes back by `reset` alone, and a suspicion that outlives
///   `isolation_timeout` attitudes ends in failed, for no bound on the error can be given.
/// The published vector is in the frame of the fit that made it; how the frames of the fits differ the paper leaves
/// open. Its covariance holds noise alone. Parity is shown and decides nothing.
class PaperMonitor {
 public:
  /// Attitudes that are kept, for step 9 and step 10.
  static constexpr int kMaxStations = AttitudeRecord::kMax;

  PaperMonitor() noexcept = default;

  /// Checks the setup and powers on: suspect, not yet validated. On an error the monitor is left unconfigured and every
  /// step answers `invalid`. Errors: wrong_mode; those of `checked(config)` and `checked(setup.base)`; too_many_sensors
  /// (limit kPaperCapacity); those of `Datasheet::array`; not_calibrated (index -1: the sizes of datasheet, model and
  /// fits differ; 0: the fit of all sensors is not sound, value = its rank, limit = kPaperRank).
  Expected<void> configure(const PaperSetup& setup) noexcept;

  /// One sample in, one verdict out. Accepts any bit pattern. The reference stays valid until the next call.
  const Verdict& step(const Sample& sample) noexcept;
  const Verdict& verdict() const noexcept { return verdict_; }

  /// Leaves `failed` at the next step, as `HealthMonitor::reset` does. Error: wrong_key.
  Expected<void> reset(std::uint64_t key, SensorSet sensors) noexcept;

  /// Always refused (wrong_mode): the paper calibrates anew by its own rule alone, step 10.
  Expected<void> request_recalibration() noexcept { return fail(Errc::wrong_mode); }

  /// Another length of gravity (depth has changed); the pool begins anew. Error: out_of_range.
  Expected<void> set_gravity(const GravityReference& gravity) noexcept;

  const SensorArray& array() const noexcept { return array_; }
  const MonitorConfig& config() const noexcept { return config_; }
  Mode mode() const noexcept { return mode_; }
  /// The fit of those that remain (step 10); not sound where there is none.
  const PaperFit& rest() const noexcept { return rest_; }
  /// What the triples said when they last decided (steps 4 to 7).
  const PaperFinding& finding() const noexcept { return finding_; }

 private:
  /// Raw values of one sample in which all sensors in use delivered.
  struct Kept {
    std::array<double, kPaperCapacity> raw{};
    double temperature_degc = 0.0;
  };

  PaperFits fits() const noexcept { return {nominal_, calibration_, rest_}; }
  std::array<double, kCapacity> raw_of(const Kept& kept) const noexcept;

  // paper_monitor.cpp: the flow of one step
  void power_on() noexcept;
  void refuse_time(const Sample& sample) noexcept;
  void collect(const Sample& sample, GateResult& gate) noexcept;
  void empty_block() noexcept;
  Validity validity() const noexcept;
  void publish(const Sample& sample, bool ticked) noexcept;

  // paper_monitor_evidence.cpp: one block, steps 2 to 7 and 9
  EventMask tick(const Sample& sample) noexcept;
  bool read_block(const BlockJudgement& judged) noexcept;
  PaperMae mae_of_block() const noexcept;
  void show_parity(const BlockEvidence& evidence) noexcept;
  void show_vector() noexcept;
  void pool_block() noexcept;
  void restart_pool() noexcept;
  EventMask decide_triples() noexcept;
  double mae_over_stations(SensorSet of) const noexcept;
  bool add_to(AttitudeRecord& record) const noexcept;
  bool add_station() noexcept;
  EventMask judge(double mae_mps2) noexcept;
  void count_clean(bool clean, bool over) noexcept;
  EventMask recalibrate(bool clean) noexcept;
  bool fit_rest() noexcept;

  // paper_monitor_decision.cpp: one event
  HealthEvent decide(EventMask raised, double time_s) noexcept;
  SensorSet act(Action::Bits actions) noexcept;
  SensorSet move_channels(Action::Bits actions) noexcept;
  SizeClass classify() const noexcept;
  void sets_changed(SensorSet before) noexcept;
  void forget_episode() noexcept;

  // What was configured.
  MonitorConfig config_;
  SensorModel model_;  ///< plumb's own, for motion and parity
  SensorArray array_;
  SensorArray nominal_;
  Datasheet datasheet_;
  PaperCalibration calibration_;
  GravityReference gravity_;
  Mat3 frame_{1, 0, 0, 0, 1, 0, 0, 0, 1};
  TestLimits limits_;
  double restless_factor_ = 0.0;
  double delta_f_mps2_ = kPaperDeltaF_mps2;
  bool configured_ = false;

  // What is remembered.
  Mode mode_ = Mode::suspect;
  SizeClass size_class_ = SizeClass::rank_lost;
  SensorSet in_service_, excluded_, absent_;
  bool not_yet_validated_ = true, timed_out_ = false, moving_ = false, temperature_out_ = false, have_evidence_ = false;
  bool reset_pending_ = false, episode_open_ = false;
  double evidence_time_s_ = 0.0, last_temperature_degc_ = 25.0;
  SampleClock clock_;
  ChannelMonitor gate_;
  SilenceCounter silence_;
  EventMask pending_ = 0;  ///< block events that a channel event pushed back
  std::uint32_t sequence_ = 0;
  SensorSet reset_sensors_;

  // Steps 2 to 5.
  BlockAccumulator block_;
  std::array<Kept, kWindowCapacity> kept_{};
  int kept_count_ = 0;
  Kept mean_;                  ///< of the last block at rest
  double mean_samples_ = 0.0;  ///< raw samples behind it
  Vec3 vector_mps2_{};         ///< of the last block at rest
  Vec3 attitude_mps2_{};       ///< the same without the channels that shake by themselves: tells attitudes apart
  SensorSet clipped_, not_finite_;

  // Steps 3 to 9.
  AttitudeRecord alarmed_;  ///< attitudes with an alarm in this episode (isolation timeout)
  AttitudeRecord clean_;    ///< clean attitudes since the last alarm
  int clean_run_ = 0;
  PaperRule pool_;
  PaperFinding finding_;
  SensorSet accused_;
  AttitudeRecord attitudes_;  ///< of the stations below
  std::array<Station, kMaxStations> stations_{};

  // Step 10.
  PaperFit rest_, candidate_;
  SensorSet refused_;  ///< whose fit was refused: not tried again

  Verdict verdict_;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
