// A block that is complete: what moved in it, what it says of the sensors, which events it raises.
#include <cmath>

#include "plumb/detection/estimate_error.hpp"
#include "plumb/health/detail/motion_bound.hpp"
#include "plumb/health/detail/tolerance.hpp"
#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

/// Blocks at rest that show the noise, before a sensor is provisionally excluded by parity alone.
constexpr double kBlocksOfNoise = 3.0;

/// Blocks that show how correlated the noise is, before a doubt keeps more from being learned.
constexpr double kBlocksOfSmoothness = 8.0;

/// What noise the sensors have is not known from fewer blocks; it may be all that is wrong.
bool is_noise_known(const MonitorState& s) noexcept {
  return s.settings.config.window < NoiseStudy::kLeastWindow || s.studies.noise.blocks() >= kBlocksOfNoise;
}

/// Whether the sensors at rest scatter as stated, on average: their own noise is no more than that, and the tool
/// is at rest. Four sensors of 1.5 times the stated noise pass for such in 1 of 200 blocks of 32, of the stated one in
/// all but 1 of 10 000.
bool is_as_stated(const BlockAccumulator& block, SensorSet calm, const BlockNoise& noise) noexcept {
  constexpr double kMostOfStated = 1.5;
  double sum = 0.0;
  for (int i = 0; i < kCapacity; ++i) {
    if (calm.has(i)) sum += block.covariance(i, i) / noise.stated_of(i);
  }
  return !calm.empty() && sum <= kMostOfStated * calm.size();
}

/// The events of a block at rest.
EventMask events_of(const MonitorState& s, const BlockReport& report, const Conclusion& concluded) noexcept {
  const Diagnosis& d = s.diagnosis;
  EventMask raised = 0;
  const auto raise = [&](HealthEvent event) {
    if (!d.expected(event, s.machine)) raised |= bit(event);
  };
  if (!concluded.isolated.empty()) raise(HealthEvent::exclusion);
  if (!concluded.aside.empty() && rank_of(s.in_force.array, s.in_service() - concluded.aside) == 3)
    raise(HealthEvent::provisional_exclusion);
  if (report.kind != BlockKind::reference && d.isolation_timed_out(s.diagnosis_terms()))
    raise(HealthEvent::isolation_timeout);
  const bool nothing_explains = d.answer().no_consistent_hypothesis || concluded.refuted;
  if (report.kind == BlockKind::alarm)
    raise(nothing_explains ? HealthEvent::no_consistent_hypothesis : HealthEvent::alarm);
  if (s.studies.check.refused()) raise(HealthEvent::no_consistent_hypothesis);
  if (report.kind == BlockKind::reference) raise(HealthEvent::norm_mismatch);
  if (report.kind == BlockKind::clean && !s.studies.check.refused()) raise(HealthEvent::passed_block);
  if (d.probation_passed(s.settings.config)) raise(HealthEvent::probation_passed);
  return raised;
}

}  // namespace

struct HealthMonitor::Block {
  BlockJudgement judged;
  bool slow = false;       ///< in slow motion
  bool as_stated = false;  ///< the noise of its sensors at rest
};

/// What the block says of the noise of all sensors, and what is expected of each of them with that.
BlockNoise HealthMonitor::learn_noise() noexcept {
  MonitorState& s = state_;
  const SensorArray& array = s.in_force.array;
  const LeastSquares& map = s.service.map;
  NoiseStudy& study = s.studies.noise;
  const BlockNoise stated = noise_of(array, 1.0, s.settings.resolution_mps2);
  const bool whole = map.valid && map.used == s.in_service() && s.window.block.complete().contains(s.in_service());
  // A sensor that scatters beside a tool that moves would pass for noise of all.
  const bool learns = whole && !s.studies.slow_motion.lately() && !s.diagnosis.episode().open;
  const bool learned = learns && study.add(array, s.window.block, map, stated);
  // An alarm of the first blocks may be correlated noise of which nothing is known yet. That is learned all the same.
  const bool early = whole && s.diagnosis.episode().open && study.smooth_blocks() < kBlocksOfSmoothness;
  if (learned || early) study.add_smoothness(array, s.window.mae, s.in_service());
  s.last.noise_factor = study.factor();
  return s.last.noise_factor > 1.0 ? noise_of(array, s.last.noise_factor, s.settings.resolution_mps2) : stated;
}

/// Whether a block that is not at rest is one of a tool in slow motion.
bool HealthMonitor::moves_slowly(const BlockNoise& noise, bool turning, BlockJudgement& judged) const noexcept {
  const MonitorState& s = state_;
  const SensorSet used = s.in_service() & s.last.usable;
  if (judged.quiet || turning || !used.contains(s.in_service()) || s.intake.temperature_out ||
      s.in_force.owes_calibration())
    return false;
  if (!(s.intake.gate.clipped_beyond(0.0) & used).empty()) return false;
  return moves_together(s.in_force.array, s.window.block, used, s.settings.scatter_factor, s.in_force.gravity.g_mps2,
                        noise, judged);
}

/// The sensors by which a block is judged to be one at rest. A dead chip is quiet while the tool moves: those that a
/// monitor in motion has excluded are asked only where the others, which determine a vector, are at rest without them.
SensorSet HealthMonitor::witnesses_of_rest(const BlockNoise& noise) const noexcept {
  const MonitorState& s = state_;
  const SensorArray& array = s.in_force.array;
  const SensorSet all = s.in_service() & s.last.usable, others = all - s.requests.motion.to_exclude(all);
  if (others == all || rank_of(array, others) < 3) return all;
  const BlockJudgement without =
      judge_block(array, s.window.block, others, s.settings.scatter_factor, s.in_force.gravity.g_mps2, noise);
  return without.quiet ? all : others;
}

/// The block that is complete, judged: what moved in it, and how far its means may be off. The next one begins.
HealthMonitor::Block HealthMonitor::close_block(double time_s, bool turning) noexcept {
  MonitorState& s = state_;
  const SensorArray& array = s.in_force.array;
  const BlockAccumulator& block = s.window.block;
  const double scattering = s.settings.scatter_factor, g_mps2 = s.in_force.gravity.g_mps2;
  // Of the blocks before: a turn that begins in this one, and that a sensor hides, may pass for noise.
  const BlockNoise before = noise_of(array, s.studies.noise.factor(), s.settings.resolution_mps2);
  const BlockNoise noise = learn_noise();
  s.last.note_rows(block, s.window.delivered(), noise, scattering);
  Block out;
  out.as_stated = is_as_stated(block, s.last.calm & s.in_service(), noise);
  BlockJudgement& judged = out.judged;
  judged = judge_block(array, block, witnesses_of_rest(noise), scattering, g_mps2, noise, &s.facts.scatter(),
                       &s.service.map);
  const double alike = s.studies.noise.correlation(block.size());
  judged.evidence.samples /= s.last.noise_factor * s.last.noise_factor * alike;
  s.last.noise_correlation = alike;
  judged.evidence.usable = judged.evidence.usable & s.last.usable;
  TemperatureRate& rate = s.studies.temperature_rate;
  rate.add(time_s, s.intake.temperature_degc);
  allow_for_drift(s.settings, s.in_force, s.intake.temperature_degc, rate.lag_degc_per_min(),
                  s.studies.check.tolerance_mps2(), judged.evidence);
  allow_for_steps(s.settings, array, block, s.in_service(), judged.evidence);
  out.slow = moves_slowly(noise, turning, judged);
  s.freshness.measure(array, block, before, block.size() / alike, s.settings.resolution_mps2, judged.noisy);
  s.window.begin_block();
  s.last.scattering = judged.scattering;
  const ChannelFacts::Terms terms{array, s.in_force.gravity, s.settings.resolution_mps2, s.settings.config.window,
                                  s.in_service()};
  s.last.moving = !s.facts.note(terms, judged, s.intake.gate, !judged.quiet || turning) && !out.slow;
  s.last.partial = !s.last.usable.contains(s.in_service()) || !s.doubted().empty();
  return out;
}

/// Whether a block in slow motion still gives a vector: within the alert limit for what the tool moves by until the
/// next, and of gravity's length within what it scattered. Parity is no matter of motion.
bool HealthMonitor::bears_motion(const BlockReport& report) const noexcept {
  const bool off =
      report.kind == BlockKind::reference || (report.kind == BlockKind::alarm && report.cause != Cause::parity);
  return !off &&
         state_.studies.slow_motion.bound_rad(state_.in_force.gravity.g_mps2) <= state_.settings.config.alert_limit_rad;
}

/// By how much the vector turned since the block before, or may have turned unseen where there is none.
void HealthMonitor::follow_motion(const BlockTests& tests, const BlockReport& report) noexcept {
  const MonitorState& s = state_;
  SlowMotion& motion = state_.studies.slow_motion;
  const double sigma_rad = tilt_sigma_rad(report.used.x_mps2, report.used.covariance);
  const double rms_rad = std::sqrt(tests.block().spread_mps2_sq) / s.in_force.gravity.g_mps2;
  const double row_rad = sigma_rad * std::sqrt(report.used.samples);
  const double hidden_rad = motion.known()
                                ? 0.0
                                : hidden_turn_rad(s.in_force, s.in_service(), s.in_service() & tests.block().usable,
                                                  s.settings.scatter_factor, s.last.noise_factor);
  motion.add_turn(report.used.x_mps2, sigma_rad, s.settings.config.alert_limit_rad, rms_rad, row_rad, hidden_rad);
}

/// A block that is no evidence, and whose vector is no change.
void HealthMonitor::leave_to_motion(bool turning) noexcept {
  MonitorState& s = state_;
  s.last.moving = true;
  s.last.cause = turning ? Cause::rotating : Cause::moving;
  s.studies.slow_motion.lapse();
  count_up(turning ? s.counters.rotating_blocks : s.counters.moving_blocks);
  s.window.mae.clear();
  s.diagnosis.leave_station();
  s.diagnosis.end_rest();
}

void HealthMonitor::keep_report(const BlockReport& report) noexcept {
  state_.last.statistic = report.statistic;
  state_.last.limit = report.limit;
  publish_report(state_, report, verdict_);
}

void HealthMonitor::keep_vector(const BlockTests& tests) noexcept {
  LastBlock& last = state_.last;
  const SensorSet used = state_.in_service() & last.evidence.usable;
  const SetTest& t = tests.of(used);
  if (!t.tested) return;
  Mat3 covariance = calibration_covariance(state_.in_force.array, t, used);
  for (std::size_t k = 0; k < 9; ++k) covariance[k] += t.covariance[k];
  last.covariance = turned_covariance(state_.settings.frame, covariance);
  last.gravity_mps2 = times(state_.settings.frame, t.x_mps2);
  last.norm_error_mps2 = t.norm_error_mps2;
}

/// One attitude more. With it the calibration may be believed, or contradicted (true): then what was held against
/// single sensors is forgotten, for it rested on limits that do not hold, and the bound of this block rests on them,
/// too.
[[gnu::noinline]] bool HealthMonitor::check_calibration(const BlockReport& report) noexcept {
  MonitorState& s = state_;
  CalibrationCheck& check = s.studies.check;
  const int grade = s.diagnosis.isolation().confirmed_grade();
  if (grade < 1) return false;  // three sensors: what is wrong with one is wrong with all
  if (!check.open() || check.refused() || s.in_force.owes_calibration() || s.machine.mode == Mode::failed) return false;
  check.count(report.kind == BlockKind::clean);
  const CalibrationCheck::Terms terms{s.in_force.array, s.in_force.gravity, s.settings.limits};
  const SensorSet monitored = s.diagnosis.isolation().monitored();
  if (!check.searches()) {
    // Of a tool whose calibration is believed so far: the length is gravity's matter, and that is another now.
    const bool other_gravity = report.kind == BlockKind::reference && s.diagnosis.suspicion() != Cause::norm_mismatch;
    if (check.corroborated() && other_gravity) check.forget_readings();
    if (check.add(s.diagnosis.station().direction, s.last.evidence, s.settings.config.distinct_attitude_angle_rad))
      check.weigh(terms, monitored, s.in_service(), s.diagnosis.episode().open);
  }
  if (!check.search(terms, monitored, grade)) return false;
  s.diagnosis.forget_episode();
  s.machine.timed_out = false;
  s.machine.clean_run = 0;
  s.requests.calibration_notice = true;
  return true;
}

/// The length over many attitudes, and gravity widened for an offset that is found.
void HealthMonitor::study_gravity(const BlockReport& report) noexcept {
  MonitorState& s = state_;
  const Mode mode = s.machine.mode;
  const bool trusted = report.kind == BlockKind::clean && mode != Mode::suspect && mode != Mode::recalibrating;
  const bool corroborated = s.in_service() == s.in_force.array.all() && !s.last.partial &&
                            !s.diagnosis.episode().open && s.facts.noisy().empty();
  const GravityFinding::Terms terms{s.settings, s.in_force, s.last.evidence, s.in_service(), trusted, corroborated};
  const GravityFinding::News news = s.studies.gravity.study(terms, report);
  if (!news.told) return;
  if (news.noticed) s.requests.reference_notice = news.finding.kind;
  verdict_.norm_mismatch = news.finding;
  if (!(news.widen_mps2 > 0.0)) return;
  s.in_force.gravity.sigma_mps2 += news.widen_mps2 / TestLimits::gravity;
  s.window.forget_near();
}

/// What the store of recalibration makes of a block. A block that speaks against the tool takes the last station back.
void HealthMonitor::collect_station(const BlockReport& report, const RawBlock& raw, EventMask raised) noexcept {
  if (!kRecalibrates) return;
  MonitorState& s = state_;
  constexpr EventMask kRefuting = bit(HealthEvent::alarm) | bit(HealthEvent::no_consistent_hypothesis) |
                                  bit(HealthEvent::norm_mismatch) | bit(HealthEvent::exclusion) |
                                  bit(HealthEvent::provisional_exclusion);
  const bool outside = s.machine.mode == Mode::suspect || s.machine.mode == Mode::failed;
  if (outside || (raised & kRefuting) != 0) {
    s.recalibration.drop_last();
    return;
  }
  if (report.kind == BlockKind::soft || !raw.complete().contains(s.in_service())) return;
  if (!(norm(report.used.x_mps2) > 0.0)) return;  // all read zero: no attitude
  s.recalibration.add_block(raw.mean(s.in_service(), report.used.x_mps2, s.last.evidence.samples),
                            s.diagnosis.station().blocks == 1);
}

/// Of a tool in slow motion: a vector and its bound. No sensor is suspected by it and none cleared, it is no station,
/// and nothing is learned from it; but that the sensors do not agree is an alarm whatever the tool does.
EventMask HealthMonitor::serve_slow_block(const Sample& sample, const BlockTests& tests,
                                          const BlockReport& report) noexcept {
  MonitorState& s = state_;
  s.last.calm = SensorSet{};
  s.diagnosis.leave_station();
  s.diagnosis.end_rest();
  s.diagnosis.end_turn();
  s.diagnosis.rescan(s.diagnosis_terms(), tests, s.turn_in_bound_rad(), s.studies.gravity.turn_rad());
  keep_vector(tests);
  // Of one row and the mean of the block: the noise of a row is that of the mean times the samples behind it.
  const double of_one_row = 1.0 + s.last.evidence.samples * s.last.noise_correlation;
  const Mat3& covariance = report.used.covariance;
  const double trace = of_one_row * (covariance[0] + covariance[4] + covariance[8]);
  s.freshness.anchor_moving(s.settings.config, sample.time_s, s.motion_in_bound_rad() * s.in_force.gravity.g_mps2,
                            trace);
  // A faulty sensor may hide part of the movement, from the block and from every row after it.
  const bool contradicted = s.diagnosis.episode().open || s.diagnosis.suspicion() == Cause::parity_in_motion;
  if (report.kind == BlockKind::alarm || contradicted) s.freshness.lapse();
  const bool alarm = report.kind == BlockKind::alarm && !s.diagnosis.expected(HealthEvent::alarm, s.machine);
  if (alarm) s.recalibration.drop_last();
  return alarm ? bit(HealthEvent::alarm) : EventMask{0};
}

/// Of a tool at rest within its temperatures: who is suspected and who is cleared by it, and what is learned.
/// `as_stated`: the noise of the sensors at rest.
EventMask HealthMonitor::serve_block_at_rest(const Sample& sample, const BlockTests& tests, const BlockReport& report,
                                             const RawBlock& raw, bool as_stated) noexcept {
  MonitorState& s = state_;
  Diagnosis& d = s.diagnosis;
  const Diagnosis::Terms terms = s.diagnosis_terms();
  if (d.follow_alarm(report, !s.in_force.owes_calibration())) s.requests.alarm_notice = report.cause;
  d.ask_about(terms, tests, report, s.requests.motion.served & s.machine.sensors.provisionally_excluded);
  d.follow_station(terms, tests, report, sample.station);
  if (d.episode().open && report.kind != BlockKind::reference) d.vote(terms, tests);
  d.count_doubt(terms, tests, report);
  const bool contradicted = check_calibration(report);
  d.count_clean(terms, tests, report, s.machine);
  d.follow_rest(terms, report);
  const double turn_rad = s.turn_in_bound_rad();
  d.rescan(terms, tests, turn_rad, s.studies.gravity.turn_rad());
  d.count_unbounded(terms, tests, report, turn_rad);
  d.examine_probation(terms, tests, report);
  study_gravity(report);
  if (report.kind == BlockKind::clean && !s.in_force.owes_calibration())
    s.studies.trend.add(s.in_force.array, s.last.evidence, s.in_service(), report.used.x_mps2, sample.time_s);
  if (s.studies.check.refused()) s.last.cause = Cause::calibration_contradicted;
  const Conclusion concluded = d.conclude(terms, report, {is_noise_known(s), as_stated});
  const EventMask raised = events_of(s, report, concluded);
  collect_station(report, raw, raised);
  keep_vector(tests);
  const double felt = least_share_felt(s.in_force.array, s.in_service() & s.last.evidence.usable);
  s.freshness.anchor(s.settings.config, sample.time_s, s.motion_in_bound_rad() * s.in_force.gravity.g_mps2 * felt);
  if (contradicted) s.freshness.lapse();
  return raised;
}

EventMask HealthMonitor::tick(const Sample& sample) noexcept {
  MonitorState& s = state_;
  SlowMotion& motion = s.studies.slow_motion;
  const bool turning = s.intake.rotation_locked;
  s.intake.rotation_locked = false;
  const RawBlock raw = s.window.raw;
  Block block = close_block(sample.time_s, turning);
  BlockEvidence& evidence = block.judged.evidence;
  const SlowMotion before = motion;
  if (!s.last.moving) {
    const double swing_mps2 = std::sqrt(evidence.spread_mps2_sq);
    motion.add_swing(block.slow, swing_mps2);
    evidence.motion_mps2 = motion.lately() ? swing_mps2 : 0.0;
  }
  const BlockTests tests(s.in_force.array, s.in_force.gravity, s.settings.limits, evidence);
  const BlockReport report = s.last.moving ? BlockReport{} : judge(tests, s.judge_terms());
  if (report.used.tested) follow_motion(tests, report);
  if (s.last.moving || !report.used.tested || (block.slow && !bears_motion(report))) {
    motion = before;  // what moves too much says nothing of what may be borne
    leave_to_motion(turning);
    return 0;
  }
  s.last.evidence = evidence;
  s.last.time_s = sample.time_s;
  s.last.known = true;
  s.last.cause = s.intake.temperature_out ? Cause::temperature : report.cause;
  keep_report(report);
  if (block.slow) return serve_slow_block(sample, tests, report);
  if (!s.intake.temperature_out) return serve_block_at_rest(sample, tests, report, raw, block.as_stated);
  // All sensors leave their model together: nothing is rejected and no sensor excluded.
  s.diagnosis.rescan(s.diagnosis_terms(), tests, s.turn_in_bound_rad(), s.studies.gravity.turn_rad());
  keep_vector(tests);
  s.freshness.anchor(s.settings.config, sample.time_s, 0.0);
  return 0;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
