// One block of evidence: what it says, whom it accuses, which events it raises.
#include <cmath>

#include "plumb/detection/mae_test.hpp"
#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Unproven ends only when every sensor's prediction has moved by this part of gravity ...
constexpr double kProvingShare = 0.02;
/// ... and by this many standard deviations of its block mean.
constexpr double kProvingSigmas = 10.0;
/// Votes at one station are taken at 1, 2, 4, 8 and 16 blocks: refined, never repeated at will.
constexpr int kLastVoteBlock = 16;

}  // namespace

/// What a quiet block said about the sensors in service.
struct HealthMonitor::BlockView {
  enum class Kind : std::uint8_t { none, clean, soft, alarm, reference };
  SetTest used;
  Kind kind = Kind::none;
  Cause cause = Cause::none;
  Cause decided_by = Cause::none;
  double parity_ratio = 0.0, norm_ratio = 0.0, mae_ratio = 0.0;
  double mae_worst_mps2 = 0.0, mae_limit_mps2 = 0.0;
  bool mae_clean = true;  ///< all voting triples below clear_fraction of their noise limit, systematic part on top
  double statistic = 0.0, limit = 0.0;
};

void HealthMonitor::judge_mae(const BlockEvidence& evidence, BlockView& view) const noexcept {
  for (int k = 0; k < array_.triple_count(); ++k) {
    const Triple& triple = array_.triple(k);
    if (!triple.votes || !(in_service_ & evidence.usable).contains(triple.set()) ||
        mae_.triple_samples(k) != config_.window)
      continue;
    const SetTest t = test_set(array_, gravity_, limits_, evidence, triple.set());
    if (!t.tested) continue;
    const MaeLimit limit = config_.delta_f_mps2 > 0.0 ? given_mae_limit(config_.delta_f_mps2)
                                                      : computed_mae_limit(t, evidence, config_.window, mae_quantile_);
    const double mae = mae_.triple_mps2(k);
    if (mae > limit.clear_mps2(clear_fraction())) view.mae_clean = false;
    const double ratio = limit.ratio(mae);
    if (ratio > view.mae_ratio || view.mae_limit_mps2 == 0.0) {
      view.mae_ratio = ratio;
      view.mae_worst_mps2 = mae;
      view.mae_limit_mps2 = limit.limit_mps2();
    }
  }
}

double HealthMonitor::clear_fraction() const noexcept { return mode_ == Mode::suspect ? config_.clear_fraction : 1.0; }

HealthMonitor::BlockView HealthMonitor::judge(const BlockEvidence& evidence) const noexcept {
  using Kind = BlockView::Kind;
  BlockView view;
  view.used = test_set(array_, gravity_, limits_, evidence, in_service_ & evidence.usable);
  if (!view.used.tested) return view;
  if (config_.alarm_form == AlarmForm::average_tool)
    view.used = in_quadrature(array_, gravity_, evidence, in_service_ & evidence.usable, view.used);
  const SetTest& t = view.used;
  const bool has_parity = t.parity_rows > 0;
  if (has_parity) view.parity_ratio = t.parity / t.parity_alarm_limit(limits_);
  view.norm_ratio = std::fabs(t.norm) / t.norm_alarm_limit(limits_);
  judge_mae(evidence, view);

  const auto decided = [&view](Kind kind, Cause cause, Cause by, double statistic, double limit) {
    view.kind = kind;
    view.cause = cause;
    view.decided_by = by;
    view.statistic = statistic;
    view.limit = limit;
  };
  if (view.parity_ratio > 1.0) {
    decided(Kind::alarm, Cause::parity, Cause::parity, t.parity, t.parity_alarm_limit(limits_));
  } else if (view.norm_ratio > 1.0) {
    const SensorSet used = in_service_ & evidence.usable;
    const bool vouched = vouches_for_norm(array_, gravity_, limits_, evidence, used, t);
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

void HealthMonitor::follow_station(const Sample& sample, const Vec3& direction) noexcept {
  const bool turned = angle_between_rad(station_.direction, direction) > config_.station_angle_rad;
  if (!station_.open || sample.station != station_.tag || turned) {
    station_.clear();
    station_.open = true;
    station_.tag = sample.station;
    station_.direction = direction;
    station_.last = direction;
  }
  drift_rad_ = angle_between_rad(station_.last, direction);
  station_.last = direction;
  ++station_.blocks;
}

void HealthMonitor::vote(const BlockEvidence& evidence, const BlockView& view) noexcept {
  const int blocks = station_.blocks;
  // An answer that a silent channel leaves untestable neither confirms nor takes back the one before.
  const bool testable = evidence.usable.contains(isolation_.posed());
  const bool due = testable && blocks <= kLastVoteBlock && (blocks & (blocks - 1)) == 0;
  Vec3 direction = view.used.x_mps2;
  if (due) {
    answer_ = isolation_.vote(array_, gravity_, limits_, evidence);
    const SensorSet posed = isolation_.posed();
    const SetTest full = test_set(array_, gravity_, limits_, evidence, posed & evidence.usable);
    const bool visible = full.tested && !(full.alive(limits_) && full.parity_alive(limits_));
    if (answer_.strict != episode_.candidate) {
      episode_.candidate = answer_.strict;
      episode_.agreeing.clear();
    }
    if (!answer_.strict.empty()) {
      const SetTest survivors =
          test_set(array_, gravity_, limits_, evidence, (posed - answer_.strict) & evidence.usable);
      if (survivors.tested) direction = survivors.x_mps2;
      // A station at which the fault cannot be seen confirms nothing.
      if (visible) episode_.agreeing.add(direction, config_.excitation_angle_rad);
    }
  } else if (!episode_.candidate.empty()) {
    const SensorSet rest = (isolation_.posed() - episode_.candidate) & evidence.usable;
    const SetTest survivors = test_set(array_, gravity_, limits_, evidence, rest);
    if (survivors.tested) direction = survivors.x_mps2;
  }
  if (view.kind == BlockView::Kind::alarm) episode_.stations.add(direction, config_.excitation_angle_rad);
}

void HealthMonitor::count_clean(const BlockView& view) noexcept {
  using Kind = BlockView::Kind;
  if (view.kind != Kind::clean) {
    clean_run_ = 0;
    if (view.kind != Kind::soft) {
      episode_.clean.clear();
      have_predictions_ = false;
      probation_.clear();
      on_probation_ = SensorSet{};
    }
    return;
  }
  if (clean_run_ < config_.clean_blocks) ++clean_run_;
  if (unproven_) {
    bool moved = true;
    for (int i = 0; i < array_.size(); ++i) {
      if (!in_service_.has(i)) continue;
      const auto a = static_cast<size_t>(i);
      const double prediction = dot(array_.axis(i), view.used.x_mps2);
      if (!have_predictions_ || prediction < least_prediction_[a]) least_prediction_[a] = prediction;
      if (!have_predictions_ || prediction > most_prediction_[a]) most_prediction_[a] = prediction;
      const double needed = std::fmax(kProvingShare * gravity_.g_mps2,
                                      kProvingSigmas * array_.sigma_mps2(i) / std::sqrt(evidence_.samples));
      if (most_prediction_[a] - least_prediction_[a] < needed) moved = false;
    }
    have_predictions_ = true;
    if (moved && clean_run_ >= config_.clean_blocks) unproven_ = false;
  }
  // While a sensor is set aside the episode ends only when it, too, agrees again.
  const SensorSet posed = isolation_.posed() & evidence_.usable;
  const SetTest all = test_set(array_, gravity_, limits_, evidence_, posed);
  if (!(all.alive(limits_) && all.parity_alive(limits_))) return;
  episode_.clean.add(view.used.x_mps2, config_.excitation_angle_rad);
  if (episode_.open && episode_.clean.size() >= config_.forget_blocks) forget_episode();
}

SensorSet HealthMonitor::culprits() const noexcept {
  const SensorSet posed = isolation_.posed();
  if (asserted_left_ > 0 && episode_.open && !scan_.asserted.empty() && scan_.asserted.size() <= asserted_left_)
    return scan_.asserted;
  if (isolation_.strict_grade() < 1 || episode_.candidate.empty()) return {};
  const int survivors = (posed - episode_.candidate).size();
  int needed = config_.isolation_stations;
  if (survivors <= 3 && needed < 2) needed = 2;  // three survivors have no parity: one station may be a mirror
  return episode_.agreeing.size() >= needed ? episode_.candidate : SensorSet{};
}

void HealthMonitor::examine_probation(const BlockEvidence& evidence, const BlockView& view) noexcept {
  if (view.kind != BlockView::Kind::clean || episode_.open || unproven_ || mode_ == Mode::failed ||
      mode_ == Mode::suspect)
    return;
  const SensorSet asked = ((excluded_ | set_aside_) - (banned_ | absent_)) & evidence.usable;
  SensorSet fine;
  for (int i = 0; i < array_.size(); ++i) {
    if (!asked.has(i)) continue;
    const SetTest t = test_set(array_, gravity_, limits_, evidence, (in_service_ & evidence.usable).with(i));
    if (t.tested && t.alive(limits_) && t.parity <= config_.clear_fraction * t.parity_alarm_limit(limits_))
      fine = fine.with(i);
  }
  const SensorSet still = on_probation_ & fine;
  if (still.empty()) probation_.clear();
  on_probation_ = still.empty() ? fine : still;
  if (!on_probation_.empty()) probation_.add(view.used.x_mps2, config_.excitation_angle_rad);
}

void HealthMonitor::rescan() noexcept {
  live_ = isolation_.live();
  if (!have_evidence_) return;
  int depth = protection_faults_;
  if (asserted_left_ > depth) depth = asserted_left_;
  if (episode_.open && isolation_.strict_grade() > depth) depth = isolation_.strict_grade();
  scan_ = isolation_.scan(array_, gravity_, limits_, evidence_, in_service_, depth, asserted_left_, protection_faults_,
                          k_integrity_);
  // The vector is that of a block: what the tool turned since the one before, and inside it, comes on top.
  scan_.protection_rad += drift_rad_ + std::sqrt(3.0 * evidence_.spread_mps2_sq) / gravity_.g_mps2;
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
    const SensorSet aside = answer_.parity & in_service_;
    const bool enough = rank_of(array_, in_service_ - aside) == 3;
    if (view.kind == Kind::alarm && view.cause == Cause::parity && !aside.empty() && enough)
      raised |= bit(HealthEvent::set_aside);
  }
  if ((mode_ == Mode::suspect || mode_ == Mode::recalibrating) && episode_.open &&
      episode_.stations.size() >= config_.patience) {
    if (!exhausted_ || unbounded_run_ >= config_.clean_blocks) raised |= bit(HealthEvent::patience_over);
  }
  if (view.kind == Kind::alarm) {
    const bool refuted = asserted_left_ == 0;  // "no more faults", and here is one
    if (refuted) asserted_left_ = -1;
    const HealthEvent event = answer_.contradiction || refuted ? HealthEvent::contradiction : HealthEvent::alarm;
    if (!expected(event)) raised |= bit(event);
  }
  if (view.kind == Kind::reference && !expected(HealthEvent::reference)) raised |= bit(HealthEvent::reference);
  if (view.kind == Kind::clean) raised |= bit(HealthEvent::clean_block);
  if (!on_probation_.empty() && probation_.size() >= config_.probation_stations)
    raised |= bit(HealthEvent::probation_passed);
  return raised;
}

/// What the store of recalibration makes of a block. A block that speaks against the tool takes the last station back.
void HealthMonitor::collect(const BlockView& view, const RawBlock& raw, EventMask raised) noexcept {
  using Kind = BlockView::Kind;
  constexpr EventMask kRefuting = bit(HealthEvent::alarm) | bit(HealthEvent::contradiction) |
                                  bit(HealthEvent::reference) | bit(HealthEvent::culprit) | bit(HealthEvent::set_aside);
  const bool outside = mode_ == Mode::suspect || mode_ == Mode::failed || mode_ == Mode::initial;
  if (outside || (raised & kRefuting) != 0) {
    recalibration_.drop_last();
    return;
  }
  if (view.kind == Kind::none || view.kind == Kind::soft || !raw.complete().contains(in_service_)) return;
  recalibration_.add_block(raw.mean(in_service_, view.used.x_mps2, evidence_.samples), station_.blocks == 1);
}

EventMask HealthMonitor::tick(const Sample& sample) noexcept {
  using Kind = BlockView::Kind;
  const SensorSet posed = in_service_ | set_aside_;
  const BlockJudgement judged = judge_block(array_, block_, in_service_, restless_factor_, gravity_.g_mps2);
  block_usable_ = block_.usable();
  block_.clear();
  const RawBlock raw = raw_;
  raw_.clear();
  verdict_.restless = judged.restless;
  moving_ = !judged.quiet;
  partial_ = !block_usable_.contains(in_service_);
  const BlockView view = moving_ ? BlockView{} : judge(judged.evidence);
  if (moving_ || !view.used.tested) {  // a block that cannot be tested is no evidence, and its vector no news
    moving_ = true;
    verdict_.cause = Cause::moving;
    mae_.clear();
    station_.clear();
    return 0;
  }
  evidence_ = judged.evidence;
  evidence_time_s_ = sample.time_s;
  have_evidence_ = true;
  verdict_.cause = temperature_out_ ? Cause::temperature : view.cause;
  verdict_.decided_by = view.decided_by;
  verdict_.statistic = view.statistic;
  verdict_.limit = view.limit;
  verdict_.margin = view.limit > 0.0 ? 1.0 - view.statistic / view.limit : 0.0;
  verdict_.parity = view.used.parity;
  verdict_.parity_limit = view.used.parity_rows > 0 ? view.used.parity_alarm_limit(limits_) : 0.0;
  verdict_.mae_worst_mps2 = view.mae_worst_mps2;
  verdict_.mae_worst_limit_mps2 = view.mae_limit_mps2;
  if (temperature_out_) {  // all sensors leave their model together: nothing dies, nothing latches
    rescan();
    publish_vector();
    return 0;
  }
  if (view.kind == Kind::alarm && !episode_.open) {
    episode_.open = true;
    station_.clear();  // votes are counted from the alarm
  }
  const SensorSet voters = episode_.candidate.empty() ? in_service_ : posed - episode_.candidate;
  const SetTest pose = test_set(array_, gravity_, limits_, evidence_, voters & evidence_.usable);
  follow_station(sample, pose.tested ? pose.x_mps2 : view.used.x_mps2);
  if (episode_.open && view.kind != Kind::reference) vote(evidence_, view);
  count_clean(view);
  rescan();
  const bool bounded = scan_.protection_available && scan_.protection_rad <= config_.alert_limit_rad;
  unbounded_run_ = bounded ? 0 : unbounded_run_ + (unbounded_run_ < config_.clean_blocks ? 1 : 0);
  examine_probation(evidence_, view);
  const EventMask raised = raise_block_events(view);
  collect(view, raw, raised);
  publish_vector();
  return raised;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
