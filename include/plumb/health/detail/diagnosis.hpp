/// Who is at fault, over blocks and stations: hypotheses, votes, the isolation timeout, validation and probation.
#pragma once

#include <array>

#include "plumb/detection/isolation.hpp"
#include "plumb/health/calibration_check.hpp"
#include "plumb/health/detail/block_report.hpp"
#include "plumb/health/detail/channel_facts.hpp"
#include "plumb/health/detail/decision.hpp"
#include "plumb/health/detail/episode.hpp"
#include "plumb/health/detail/last_block.hpp"
#include "plumb/health/detail/rest_reference.hpp"
#include "plumb/health/rotation.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// The direction of a tested set, zero where noise leaves it too open to tell one attitude from another.
Vec3 known_direction(const SetTest& test, double distinct_attitude_angle_rad) noexcept;
/// By how much the prediction of a sensor must have moved before the sensor is validated.
double proving_change_mps2(const InForce& in_force, int sensor, double samples) noexcept;
/// Whether a monitor in this mode takes sensors out of service on evidence.
constexpr bool may_accuse(Mode mode) noexcept {
  return mode == Mode::nominal || mode == Mode::isolated || mode == Mode::suspect || mode == Mode::recalibrating;
}

/// What one block leads to.
struct Conclusion {
  SensorSet isolated;    ///< to be excluded
  SensorSet aside;       ///< to be provisionally excluded
  bool refuted = false;  ///< the integrator assumed no more faults, and here is one
};

class Diagnosis {
 public:
  /// What the questions are asked with. It is read and never written to.
  struct Terms {
    const Settings& settings;
    const InForce& in_force;
    const DecisionState& machine;
    const ChannelFacts& facts;
    const LastBlock& last;
    const CalibrationCheck& check;
  };

  void clear(const InForce& in_force, SensorSet in_service, int assumed_faults) noexcept;

  // ---- One block at rest, in this order
  /// An alarm opens an episode: votes are counted from it.
  bool follow_alarm(const BlockReport& report, bool calibrated) noexcept;
  /// So does a sensor that was provisionally excluded in motion and contradicts the others at rest: that it is
  /// confirmed or refuted takes votes, and those in service have nothing to alarm about.
  void ask_about(const Terms& terms, const BlockTests& tests, const BlockReport& report,
                 SensorSet found_in_motion) noexcept;
  /// The station that the block belongs to, with `tag` as the host gave it.
  void follow_station(const Terms& terms, const BlockTests& tests, const BlockReport& report,
                      std::uint32_t tag) noexcept;
  /// Asks who is at fault, and keeps the answer.
  void vote(const Terms& terms, const BlockTests& tests) noexcept;
  void count_doubt(const Terms& terms, const BlockTests& tests, const BlockReport& report) noexcept;
  /// Passed blocks in a row, and what they prove: written to `machine`.
  void count_clean(const Terms& terms, const BlockTests& tests, const BlockReport& report,
                   DecisionState& machine) noexcept;
  /// The readings that an array which bears no further fault is held against.
  void follow_rest(const Terms& terms, const BlockReport& report) noexcept;
  /// The explanations that are left, and the protection level over them. On top of it comes what motion and
  /// acceleration may turn the vector by, and what may have turned it beside an offset that gravity was widened for.
  void rescan(const Terms& terms, const BlockTests& tests, double turn_rad, double reference_turn_rad) noexcept;
  void count_unbounded(const Terms& terms, const BlockTests& tests, const BlockReport& report,
                       double turn_rad) noexcept;
  void examine_probation(const Terms& terms, const BlockTests& tests, const BlockReport& report) noexcept;
  /// What is known of the noise of the sensors.
  struct NoiseKnowledge {
    bool learned = false;           ///< enough blocks have shown it
    bool others_as_stated = false;  ///< those that scatter least in this block do so by what is stated
  };
  /// Who is suspected by it.
  Conclusion conclude(const Terms& terms, const BlockReport& report, NoiseKnowledge noise) noexcept;

  // ---- What ends
  void leave_station() noexcept;
  void end_rest() noexcept { rest_.clear(); }
  void end_turn() noexcept { drift_rad_ = 0.0; }
  void forget_episode() noexcept;
  void forget_votes() noexcept;  ///< gravity is another: what the former rejected may be consistent with it
  void forget_predictions() noexcept { have_predictions_ = false; }
  void forget_probation() noexcept;
  void forget_probation_of(SensorSet sensors) noexcept { on_probation_ = on_probation_ - sensors; }
  /// Behind an adoption: what was seen through the old coefficients says nothing about the new ones.
  void begin_anew() noexcept;
  /// The sensors that are asked about are others: what was answered does not carry over.
  void withdraw_answer() noexcept;
  void pose(const SensorArray& array, SensorSet monitored) noexcept {
    isolation_.pose(array, monitored);
    consistent_ = isolation_.live();
  }
  void resume(const SensorArray& array, SensorSet monitored) noexcept { isolation_.resume(array, monitored); }
  /// An exclusion uses up so many of the faulty units that the integrator asserts.
  void spend_asserted(int faults) noexcept;
  void grade_by_parity() noexcept { last_grade_ = Grade::provisional; }
  void suspect_for(Cause cause) noexcept { suspicion_ = cause; }

  // ---- What it says
  const Isolation& isolation() const noexcept { return isolation_; }
  const Episode& episode() const noexcept { return episode_; }
  const StationTrack& station() const noexcept { return station_; }
  const IsolationAnswer& answer() const noexcept { return answer_; }
  const FaultSetScan& scan() const noexcept { return scan_; }
  int live() const noexcept { return consistent_; }
  bool rested() const noexcept { return rest_.holds(); }
  double drift_rad() const noexcept { return drift_rad_; }
  int unbounded_run() const noexcept { return unbounded_run_; }
  Grade last_grade() const noexcept { return last_grade_; }
  Cause suspicion() const noexcept { return suspicion_; }
  SensorSet aside() const noexcept { return aside_; }
  SensorSet on_probation() const noexcept { return on_probation_; }
  bool probation_passed(const MonitorConfig& config) const noexcept;
  /// Isolated at the confirmed or the assumed grade, over the stations that it takes.
  SensorSet isolated(const Terms& terms) const noexcept;
  /// Those that scatter by themselves for long enough, with the chips that they are on.
  SensorSet noise_confirmed(const SensorArray& array, const ChannelFacts& facts) const noexcept;
  bool isolation_timed_out(const Terms& terms) const noexcept;
  bool bounded(double alert_limit_rad) const noexcept {
    return scan_.protection_available && scan_.protection_rad <= alert_limit_rad;
  }
  /// The condition for which the host asked for a fit is no change while that is being made.
  bool expected(HealthEvent event, const DecisionState& machine) const noexcept;
  /// Which turn would validate the sensors, or tell the explanations apart.
  RotationRequest rotation_request(const Terms& terms) const noexcept;

 private:
  /// Whether these sensors together, or those of one unit among them, determine a vector of the length of gravity.
  static bool some_measure_gravity(const Terms& terms, const BlockTests& tests, SensorSet sensors) noexcept;
  static bool is_rest_witnessed(const Terms& terms, const BlockTests& tests) noexcept;
  bool is_still_there(const Terms& terms, const BlockTests& tests, SensorSet voters) const noexcept;
  /// Who is at fault by one station.
  struct Suspicion {
    SensorSet isolated;
    bool by_scatter = false;  ///< their own scatter is all that names them
  };
  bool is_vote_due(const BlockTests& tests) const noexcept;
  SensorSet isolated_by_scatter(const Terms& terms, const BlockTests& tests) const noexcept;
  Suspicion suspect(const Terms& terms, const BlockTests& tests, const IsolationAnswer& voted) const noexcept;
  void note_suspicion(const Terms& terms, const BlockTests& tests, const Suspicion& suspected) noexcept;
  bool is_out_of_stations(const Terms& terms) const noexcept;
  bool is_out_of_blocks(const Terms& terms) const noexcept;
  bool is_isolable(const SensorArray& array, const BlockEvidence& evidence) const noexcept;
  bool may_exclude(const Terms& terms, SensorSet isolated) const noexcept;
  bool note_predictions(const Terms& terms, const Vec3& x_mps2) noexcept;
  SensorSet corroborating(const Terms& terms) const noexcept;
  RotationRequest validating_turn(const Terms& terms) const noexcept;
  RotationRequest resolving_turn(const Terms& terms) const noexcept;

  Isolation isolation_;
  Episode episode_;
  StationTrack station_;
  RestReference rest_;
  IsolationAnswer answer_;
  FaultSetScan scan_;
  int consistent_ = 0;      ///< test subsets consistent
  int asserted_left_ = -1;  ///< faults that the integrator still assumes; -1 = none assumed
  int unbounded_run_ = 0;   ///< blocks in a row without a bound within the alert limit, and without a way out
  double drift_rad_ = 0.0;  ///< turn since the block before, at one station
  SensorSet aside_;         ///< those that the provisional grade, or their own scatter, isolates
  SensorSet on_probation_;
  DirectionRecord probation_;
  std::array<float, kCapacity> least_prediction_{}, most_prediction_{};  ///< over passed blocks before validation
  bool have_predictions_ = false;
  Grade last_grade_ = Grade::none;
  Cause suspicion_ = Cause::none;  ///< the last block event that keeps the monitor in suspect

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using D = Diagnosis;
    return field_list(&D::isolation_, &D::episode_, &D::station_, &D::rest_, &D::answer_, &D::scan_,
                      within(&D::consistent_, 0, kVotingCapacity), within(&D::asserted_left_, -1, 3),
                      within(&D::unbounded_run_, 0, kMostPassedBlocks), &D::drift_rad_, &D::aside_, &D::on_probation_,
                      &D::probation_, per_sensor(&D::least_prediction_), per_sensor(&D::most_prediction_),
                      &D::have_predictions_, up_to(&D::last_grade_, Grade::assumed), up_to(&D::suspicion_, kLastCause));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
