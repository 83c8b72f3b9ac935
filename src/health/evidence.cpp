// One block of evidence: what it says, whom it accuses, which events it raises.
#include <cmath>
#include <limits>

#include "block_view.hpp"
#include "plumb/detection/mae_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Blocks at rest that show the noise, before a sensor is set aside by parity alone.
constexpr double kBlocksOfNoise = 3.0;

}  // namespace

void HealthMonitor::judge_mae(const BlockTests& tests, BlockView& view) const noexcept {
  const BlockEvidence& evidence = tests.block();
  for (int k = 0; k < array_.triple_count(); ++k) {
    const Triple& triple = array_.triple(k);
    if (!triple.votes || !(in_service_ & evidence.usable).contains(triple.set()) ||
        mae_.triple_samples(k) != config_.window)
      continue;
    const double mae = mae_.triple_mps2(k);
    MaeLimit limit = given_mae_limit(config_.delta_f_mps2);
    if (!(config_.delta_f_mps2 > 0.0)) {
      const MaeLimit least = least_mae_limit(array_, triple, evidence, config_.window, mae_quantile_);
      const double ratio = std::fmax(least.ratio(mae), 0.0);
      if (view.mae_limit_mps2 != 0.0 && mae <= least.clear_mps2(clear_fraction()) && ratio <= 1.0 &&
          ratio <= view.mae_ratio) {
        // Clean, and not the worst: the systematic part would only take it farther from the limit.
        view.triples_tested.add(k);
        view.triples_passed.add(k);
        continue;
      }
      const SetTest& t = tests.of(triple.set());
      if (!t.tested) continue;
      limit = computed_mae_limit(t, evidence, config_.window, mae_quantile_);
    }
    // Comparisons are written so that what is not a number is beyond its limit.
    if (!(mae <= limit.clear_mps2(clear_fraction()))) view.mae_clean = false;
    const double told = limit.ratio(mae);
    const double ratio = std::isnan(told) ? std::numeric_limits<double>::infinity() : told;
    view.triples_tested.add(k);
    if (ratio <= 1.0) view.triples_passed.add(k);
    if (ratio > view.mae_ratio || view.mae_limit_mps2 == 0.0) {
      view.mae_ratio = ratio;
      view.mae_worst_mps2 = mae;
      view.mae_limit_mps2 = limit.limit_mps2();
    }
  }
}

double HealthMonitor::clear_fraction() const noexcept { return mode_ == Mode::suspect ? config_.clear_fraction : 1.0; }

HealthMonitor::BlockView HealthMonitor::judge(const BlockTests& tests) const noexcept {
  const BlockEvidence& evidence = tests.block();
  using Kind = BlockView::Kind;
  BlockView view;
  view.used = tests.of(in_service_ & evidence.usable);
  if (!view.used.tested) return view;
  if (config_.alarm_form == AlarmForm::average_tool && !owes_calibration())
    view.used =
        in_quadrature(array_, gravity_, evidence, in_service_ & evidence.usable, view.used, limits_.acceleration_mps2);
  const SetTest& t = view.used;
  const bool has_parity = t.parity_rows > 0;
  if (has_parity) view.parity_ratio = t.parity / t.parity_alarm_limit(limits_);
  view.norm_ratio = std::fabs(t.norm) / t.norm_alarm_limit(limits_);
  // By the datasheet alone a weak triple may be off by more than its limit, which is linear in what the datasheet
  // leaves open. Parity is linear indeed, and the norm of all is nearly so.
  if (!owes_calibration()) judge_mae(tests, view);

  const auto decided = [&view](Kind kind, Cause cause, Cause by, double statistic, double limit) {
    view.kind = kind;
    view.cause = cause;
    view.decided_by = by;
    view.statistic = statistic;
    view.limit = limit;
  };
  if (!(view.parity_ratio <= 1.0)) {
    decided(Kind::alarm, Cause::parity, Cause::parity, t.parity, t.parity_alarm_limit(limits_));
  } else if (!(view.norm_ratio <= 1.0)) {
    const SensorSet used = in_service_ & evidence.usable;
    const bool vouched = tests.vouches_for_norm(used, t);
    decided(vouched ? Kind::reference : Kind::alarm, vouched ? Cause::reference : Cause::norm, Cause::norm,
            std::fabs(t.norm), t.norm_alarm_limit(limits_));
  } else if (view.mae_ratio > 1.0) {
    decided(Kind::alarm, Cause::mae, Cause::mae, view.mae_worst_mps2, view.mae_limit_mps2);
  } else {
    const double worst = std::fmax(view.parity_ratio, std::fmax(view.norm_ratio, view.mae_ratio));
    // In suspect, clean means a part of the noise limit with the systematic bound on top: scaling that bound too would
    // lock out a healthy tool whose gravity is off by what its sigma allows.
    const double f = clear_fraction();
    const double parity_noise = has_parity ? t.parity_alarm_limit(limits_) - t.parity_systematic : 0.0;
    const double norm_noise = t.norm_alarm_limit(limits_) - t.norm_systematic;
    const bool parity_clean = t.parity <= f * parity_noise + t.parity_systematic;
    const bool norm_clean = std::fabs(t.norm) <= f * norm_noise + t.norm_systematic;
    const Kind kind = parity_clean && norm_clean && view.mae_clean && !partial_ ? Kind::clean : Kind::soft;
    if (worst == view.parity_ratio && has_parity) {
      decided(kind, Cause::clean, Cause::parity, t.parity, t.parity_alarm_limit(limits_));
    } else if (worst == view.mae_ratio) {
      decided(kind, Cause::clean, Cause::mae, view.mae_worst_mps2, view.mae_limit_mps2);
    } else {
      decided(kind, Cause::clean, Cause::norm, std::fabs(t.norm), t.norm_alarm_limit(limits_));
    }
  }
  return view;
}

EventMask HealthMonitor::raise_block_events(const BlockView& view) noexcept {
  using Kind = BlockView::Kind;
  EventMask raised = 0;
  const bool accuses =
      mode_ == Mode::nominal || mode_ == Mode::isolated || mode_ == Mode::suspect || mode_ == Mode::recalibrating;
  if (accuses && episode_.open) {
    const SensorSet latched = culprits();
    if (!latched.empty()) {
      raised |= bit(HealthEvent::culprit);
      last_grade_ = asserted_left_ > 0 && latched == scan_.asserted ? Grade::asserted : Grade::strict;
    }
  }
  if (accuses) {
    // What noise the sensors have is not known from fewer blocks; it may be all that is wrong.
    const bool noise_known = config_.window < NoiseStudy::kLeastWindow || noise_study_.blocks() >= kBlocksOfNoise;
    const bool by_parity = episode_.open && noise_known && view.kind == Kind::alarm && view.cause == Cause::parity;
    const SensorSet odd = by_parity && may_convict(answer_.parity) ? answer_.parity : SensorSet{};
    aside_ = (odd | noise_confirmed()) & in_service_;
    if (!aside_.empty() && rank_of(array_, in_service_ - aside_) == 3) raised |= bit(HealthEvent::set_aside);
  }
  if (view.kind != Kind::reference && patience_is_over()) raised |= bit(HealthEvent::patience_over);
  if (view.kind == Kind::alarm) {
    const bool refuted = asserted_left_ == 0 && !owes_calibration();  // "no more faults", and here is one
    if (refuted) asserted_left_ = -1;
    const HealthEvent event = answer_.contradiction || refuted ? HealthEvent::contradiction : HealthEvent::alarm;
    if (!expected(event)) raised |= bit(event);
  }
  if (check_.refused() && !expected(HealthEvent::contradiction)) raised |= bit(HealthEvent::contradiction);
  if (view.kind == Kind::reference && !expected(HealthEvent::reference)) raised |= bit(HealthEvent::reference);
  if (view.kind == Kind::clean && !check_.refused()) raised |= bit(HealthEvent::clean_block);
  if (!on_probation_.empty() && probation_.size() >= config_.probation_stations)
    raised |= bit(HealthEvent::probation_passed);
  return raised;
}

/// What the store of recalibration makes of a block. A block that speaks against the tool takes the last station back.
void HealthMonitor::collect(const BlockView& view, const RawBlock& raw, EventMask raised) noexcept {
  if (!kRecalibrates) return;
  using Kind = BlockView::Kind;
  constexpr EventMask kRefuting = bit(HealthEvent::alarm) | bit(HealthEvent::contradiction) |
                                  bit(HealthEvent::reference) | bit(HealthEvent::culprit) | bit(HealthEvent::set_aside);
  const bool outside = mode_ == Mode::suspect || mode_ == Mode::failed;
  if (outside || (raised & kRefuting) != 0) {
    recalibration_.drop_last();
    return;
  }
  if (view.kind == Kind::soft || !raw.complete().contains(in_service_)) return;
  if (!(norm(view.used.x_mps2) > 0.0)) return;  // all read zero: no attitude
  recalibration_.add_block(raw.mean(in_service_, view.used.x_mps2, evidence_.samples), station_.blocks == 1);
}

/// What the block says of the noise of all sensors, and what is expected of each of them with that.
BlockNoise HealthMonitor::learn_noise() noexcept {
  const BlockNoise stated = noise_of(array_, 1.0, resolution_mps2_);
  const bool whole = map_.valid && map_.used == in_service_ && block_.complete().contains(in_service_);
  // A sensor that scatters beside a tool that moves would pass for noise of all.
  const bool learns = whole && !slow_motion_.lately() && !episode_.open;
  if (learns && noise_study_.add(array_, block_, map_, stated)) noise_study_.add_smoothness(array_, mae_, in_service_);
  const double factor = noise_study_.factor();
  verdict_.noise_factor = factor;
  return factor > 1.0 ? noise_of(array_, factor, resolution_mps2_) : stated;
}

/// A block is made of rows in which the same sensors in service deliver: where one was silent the tool may have moved,
/// and means over other rows cannot be held against one another. A row that lacks a sensor is left out; one that brings
/// a sensor which the block lacks begins it anew.
bool HealthMonitor::joins_block(SensorSet usable) noexcept {
  const SensorSet now = usable & in_service_, before = block_.seen() & in_service_;
  if (block_.size() == 0 || now == before) return true;
  if (!now.contains(before)) return false;
  gate_.begin_block();
  block_.clear();
  raw_.clear();
  return true;
}

/// What is kept of the samples of a block: who delivered, who was calm.
void HealthMonitor::note_block(const BlockNoise& noise) noexcept {
  block_usable_ = block_.complete();
  calm_ = SensorSet{};
  for (int i = 0; i < array_.size(); ++i) {
    if (!block_usable_.has(i)) continue;  // silent when the tool moved, it is no witness that it rested
    if (block_.size() < 2 || block_.covariance(i, i) <= restless_factor_ * noise.of(i)) calm_ = calm_.with(i);
  }
}

/// How far each mean may be off for drift since the calibration, at the temperature of now.
void HealthMonitor::allow_for_drift(BlockEvidence& evidence) const noexcept {
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double away_degc = last_temperature_degc_ - model_.sensor[a].reference_degc;
    evidence.tolerance_mps2[a] = stability_[a].tolerance_mps2(away_degc, temperature_rate_.lag_degc_per_min());
    evidence.tolerance_mps2[a] = std::fmin(evidence.tolerance_mps2[a] + check_.tolerance_mps2(), kMostTolerance_mps2);
  }
}

/// What rounding to steps does to each mean. Where noise reaches from one step to the next it averages out and is noise
/// itself, a twelfth of the square of a step; where it does not, the mean may be off by half a step for as long as the
/// tool stays.
void HealthMonitor::allow_for_steps(BlockEvidence& evidence) const noexcept {
  double widest = 1.0;
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double step = static_cast<double>(resolution_mps2_[a]), sigma = array_.sigma_mps2(i);
    const double scatter = block_.size() > 1 ? block_.covariance(i, i) : sigma * sigma;
    if (!(2.0 * sigma >= step && 4.0 * scatter >= step * step)) {
      const double within = static_cast<double>(evidence.tolerance_mps2[a]) + 0.5 * step;
      evidence.tolerance_mps2[a] = static_cast<float>(std::fmin(within, static_cast<double>(kMostTolerance_mps2)));
    } else if (in_service_.has(i)) {
      widest = std::fmax(widest, 1.0 + step * step / (12.0 * sigma * sigma));
    }
  }
  evidence.samples /= widest;
}

/// Whether a block that is not quiet is one of a tool in slow motion.
bool HealthMonitor::moves_slowly(const BlockNoise& noise, bool turning, BlockJudgement& judged) const noexcept {
  const SensorSet used = in_service_ & block_usable_;
  if (judged.quiet || turning || !used.contains(in_service_) || temperature_out_ || owes_calibration()) return false;
  if (!(gate_.clipped_beyond(0.0) & used).empty()) return false;
  return moves_together(array_, block_, used, restless_factor_, gravity_.g_mps2, noise, judged);
}

/// Whether a block in slow motion still gives a vector: within the alert limit for what the tool moves by until the
/// next, and of gravity's length within what it scattered. Parity is no matter of motion.
bool HealthMonitor::bears_motion(const BlockView& view) const noexcept {
  using Kind = BlockView::Kind;
  const bool off = view.kind == Kind::reference || (view.kind == Kind::alarm && view.cause != Cause::parity);
  return !off && slow_motion_.bound_rad(gravity_.g_mps2) <= config_.alert_limit_rad;
}

/// Of a tool in slow motion: a vector and its bound. Nobody is accused by it and nobody cleared, it is no station, and
/// nothing is learned from it; but that the sensors do not agree is an alarm whatever the tool does.
EventMask HealthMonitor::serve_slow_block(const Sample& sample, const BlockTests& tests,
                                          const BlockView& view) noexcept {
  calm_ = SensorSet{};
  leave_station();
  rest_.clear();
  drift_rad_ = 0.0;
  rescan(tests);
  publish_vector(tests);
  // Of one row and the mean of the block: the noise of a row is that of the mean times the samples behind it.
  const double of_one_row = 1.0 + evidence_.samples * verdict_.noise_correlation;
  const double trace = of_one_row * (view.used.covariance[0] + view.used.covariance[4] + view.used.covariance[8]);
  freshness_.anchor_moving(config_, sample.time_s, motion_in_bound_rad() * gravity_.g_mps2, trace);
  // A liar may hide part of the movement, from the block and from every row after it.
  if (view.kind == BlockView::Kind::alarm || episode_.open) freshness_.lapse();
  const bool alarm = view.kind == BlockView::Kind::alarm && !expected(HealthEvent::alarm);
  if (alarm) recalibration_.drop_last();
  return alarm ? bit(HealthEvent::alarm) : EventMask{0};
}

/// The block that is complete, judged: what moved in it, and how far its means may be off. The next one begins.
BlockJudgement HealthMonitor::close_block(double time_s, bool turning, bool& slow) noexcept {
  const BlockNoise noise = learn_noise();
  note_block(noise);
  BlockJudgement judged = judge_block(array_, block_, in_service_ & block_usable_, restless_factor_, gravity_.g_mps2,
                                      noise, &scatter_, &map_);
  const double alike = noise_study_.correlation(block_.size());
  judged.evidence.samples /= verdict_.noise_factor * verdict_.noise_factor * alike;
  verdict_.noise_correlation = alike;
  judged.evidence.usable = judged.evidence.usable & block_usable_;
  temperature_rate_.add(time_s, last_temperature_degc_);
  allow_for_drift(judged.evidence);
  allow_for_steps(judged.evidence);
  slow = moves_slowly(noise, turning, judged);
  freshness_.measure(array_, block_, noise, block_.size() / alike, resolution_mps2_, slow);
  block_.clear();
  raw_.clear();
  verdict_.restless = judged.restless;
  moving_ = !note_facts(judged, !judged.quiet || turning) && !slow;
  partial_ = !block_usable_.contains(in_service_) || !doubted().empty();
  return judged;
}

/// A block that is no evidence, and whose vector is no news.
void HealthMonitor::leave_to_motion(bool turning) noexcept {
  moving_ = true;
  slow_motion_.lapse();
  verdict_.cause = turning ? Cause::rotating : Cause::moving;
  count_up(turning ? counters_.rotating_blocks : counters_.moving_blocks);
  mae_.clear();
  leave_station();
  rest_.clear();
}

/// Of a tool at rest within its temperatures: who is accused and who is cleared by it, and what is learned.
EventMask HealthMonitor::serve_block_at_rest(const Sample& sample, const BlockTests& tests, const BlockView& view,
                                             const RawBlock& raw) noexcept {
  using Kind = BlockView::Kind;
  const SensorSet posed = in_service_ | set_aside_;
  if (view.kind == Kind::alarm && !episode_.open && !owes_calibration()) {  // nobody is accused by a datasheet
    episode_.open = true;
    station_.clear();  // votes are counted from the alarm
  }
  const SensorSet voters = episode_.candidate.empty() ? in_service_ : posed - episode_.candidate;
  const SetTest& pose = tests.of(voters & evidence_.usable);
  follow_station(sample, pose.tested ? pose : view.used);
  if (episode_.open && view.kind != Kind::reference) vote(tests);
  count_doubt(view);
  const bool contradicted = check_calibration(view);
  count_clean(tests, view);
  rest_.follow(array_, evidence_);
  if (view.kind == Kind::clean && !episode_.open && !owes_calibration()) rest_.take(evidence_);
  rescan(tests);
  count_unbounded(tests, view);
  examine_probation(tests, view);
  study_reference(view);
  if (view.kind == Kind::clean && !owes_calibration())
    trend_.add(array_, evidence_, in_service_, view.used.x_mps2, sample.time_s);
  if (check_.refused()) verdict_.cause = Cause::calibration_contradicted;
  const EventMask raised = raise_block_events(view);
  collect(view, raw, raised);
  publish_vector(tests);
  freshness_.anchor(config_, sample.time_s,
                    motion_in_bound_rad() * gravity_.g_mps2 * least_share_felt(evidence_.usable));
  if (contradicted) freshness_.lapse();
  return raised;
}

EventMask HealthMonitor::tick(const Sample& sample) noexcept {
  const bool turning = rotation_locked_;
  rotation_locked_ = false;
  const RawBlock raw = raw_;
  bool slow = false;
  BlockJudgement judged = close_block(sample.time_s, turning, slow);
  const SlowMotion before = slow_motion_;
  if (!moving_) {
    const double swing_mps2 = std::sqrt(judged.evidence.spread_mps2_sq);
    slow_motion_.add_swing(slow, swing_mps2);
    judged.evidence.motion_mps2 = slow_motion_.lately() ? swing_mps2 : 0.0;
  }
  const BlockTests tests(array_, gravity_, limits_, judged.evidence);
  const BlockView view = moving_ ? BlockView{} : judge(tests);
  if (view.used.tested) {
    const double sigma_rad = tilt_sigma_rad(view.used.x_mps2, view.used.covariance);
    slow_motion_.add_turn(view.used.x_mps2, sigma_rad, config_.alert_limit_rad,
                          std::sqrt(judged.evidence.spread_mps2_sq) / gravity_.g_mps2,
                          sigma_rad * std::sqrt(view.used.samples),
                          slow_motion_.known() ? 0.0 : hidden_turn_rad(judged.evidence.usable));
  }
  if (moving_ || !view.used.tested || (slow && !bears_motion(view))) {
    slow_motion_ = before;  // what moves too much says nothing of what may be borne
    leave_to_motion(turning);
    return 0;
  }
  evidence_ = judged.evidence;
  evidence_time_s_ = sample.time_s;
  have_evidence_ = true;
  verdict_.cause = temperature_out_ ? Cause::temperature : view.cause;
  publish_decision(view);
  if (slow) return serve_slow_block(sample, tests, view);
  if (temperature_out_) {  // all sensors leave their model together: nothing dies, nothing latches
    rescan(tests);
    publish_vector(tests);
    freshness_.anchor(config_, sample.time_s, 0.0);
    return 0;
  }
  return serve_block_at_rest(sample, tests, view, raw);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
