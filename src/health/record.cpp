// What is kept on record from block to block: the station, the votes of an episode, patience, clean blocks, probation.
#include <cmath>

#include "block_view.hpp"

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

void HealthMonitor::follow_station(const Sample& sample, const Vec3& direction) noexcept {
  // A station of sensors that all read zero points nowhere: no angle to it would ever end it.
  const bool nowhere = !(norm(station_.direction) > 0.0);
  const bool turned = nowhere || angle_between_rad(station_.direction, direction) > config_.station_angle_rad;
  if (!station_.open || sample.station != station_.tag || turned) {
    station_.clear();
    station_.open = true;
    station_.tag = sample.station;
    station_.direction = direction;
    station_.last = direction;
  }
  drift_rad_ = angle_between_rad(station_.last, direction);
  station_.last = direction;
  if (station_.blocks < StationTrack::kMostBlocks) ++station_.blocks;
}

/// Where the tool points, by the sensors that the answer leaves.
Vec3 HealthMonitor::vote(const BlockTests& tests, const BlockView& view) noexcept {
  const BlockEvidence& evidence = tests.block();
  const int blocks = station_.blocks;
  // An answer that a silent channel leaves untestable neither confirms nor takes back the one before.
  const bool testable = evidence.usable.contains(isolation_.posed());
  const bool due = testable && blocks <= kLastVoteBlock && (blocks & (blocks - 1)) == 0;
  Vec3 direction = view.used.x_mps2;
  if (due) {
    // What scatters may be all that shows of a movement: the strict grade bears so many faulty ones that hang that the
    // calm healthy ones left lie in one plane, and across it the tool moves unfelt. So its average kills nothing.
    answer_ = isolation_.vote(tests, calm_);
    const SensorSet posed = isolation_.posed();
    if (answer_.strict.empty() && isolation_.strict_grade() > 0 && isolation_.parity_grade() < 1 &&
        noisy_.size() == 1) {
      // Nor can it be set aside where parity has no grade. It is the answer of this station by its scatter alone: one
      // station at which it is calm, or not the only one, takes the answer back.
      const SensorSet others = posed - noisy_;
      const SetTest& rest = tests.of(others & evidence.usable);
      if (calm_.contains(others) && rest.tested && rest.alive(limits_) && rest.parity_alive(limits_))
        answer_.strict = noisy_;
    }
    const SetTest& full = tests.of(posed & evidence.usable);
    const bool visible = !full.alive(limits_) || !full.parity_alive(limits_);
    if (answer_.strict != episode_.candidate) {
      episode_.candidate = answer_.strict;
      episode_.agreeing.clear();
    }
    if (!answer_.strict.empty()) {
      const SetTest& survivors = tests.of((posed - answer_.strict) & evidence.usable);
      if (survivors.tested) direction = survivors.x_mps2;
      // A station at which the fault cannot be seen confirms nothing.
      if (visible) episode_.agreeing.add(direction, config_.excitation_angle_rad);
    }
  } else if (!episode_.candidate.empty()) {
    const SensorSet rest = (isolation_.posed() - episode_.candidate) & evidence.usable;
    const SetTest& survivors = tests.of(rest);
    if (survivors.tested) direction = survivors.x_mps2;
  }
  return direction;
}

/// Patience counts doubt, not alarms alone: a block between the limit to leave suspect and the one to enter it would
/// else hold the monitor there for ever. It rests at a reference error, of which nobody in service is accused.
void HealthMonitor::count_doubt(const BlockView& view, const Vec3& direction) noexcept {
  // The contradiction for which the host had a fit made is no news, and the fit needs more stations than patience has.
  const bool known = answer_.contradiction && expected(HealthEvent::contradiction);
  if (!view.doubtful(mode_) || known || owes_calibration()) return;
  episode_.stations.add(direction, config_.excitation_angle_rad);
  if (episode_.doubtful_blocks < config_.patience_blocks) ++episode_.doubtful_blocks;
}

bool HealthMonitor::patience_is_over() const noexcept {
  if (mode_ != Mode::suspect && mode_ != Mode::recalibrating) return false;
  const bool over = episode_.stations.size() >= config_.patience ||
                    (config_.patience_blocks > 0 && episode_.doubtful_blocks >= config_.patience_blocks);
  return over && (!exhausted_ || unbounded_run_ >= config_.clean_blocks);
}

/// By how much the prediction of a sensor must have moved before it is proven.
double HealthMonitor::proving_change_mps2(int sensor) const noexcept {
  return std::fmax(kProvingShare * gravity_.g_mps2,
                   kProvingSigmas * array_.sigma_mps2(sensor) / std::sqrt(evidence_.samples));
}

void HealthMonitor::count_clean(const BlockTests& tests, const BlockView& view) noexcept {
  using Kind = BlockView::Kind;
  if (view.kind != Kind::clean) {
    clean_run_ = 0;
    if (view.kind != Kind::soft || view.doubtful(mode_)) episode_.clean.clear();
    if (view.kind != Kind::soft) {
      have_predictions_ = false;
      probation_.clear();
      on_probation_ = SensorSet{};
    }
    return;
  }
  if (clean_run_ < config_.clean_blocks) ++clean_run_;
  if (unproven_ && !owes_calibration()) {
    bool moved = true;
    for (int i = 0; i < array_.size(); ++i) {
      if (!in_service_.has(i)) continue;
      const auto a = static_cast<size_t>(i);
      const double prediction = dot(array_.axis(i), view.used.x_mps2);
      if (!have_predictions_ || prediction < least_prediction_[a]) least_prediction_[a] = prediction;
      if (!have_predictions_ || prediction > most_prediction_[a]) most_prediction_[a] = prediction;
      if (!(most_prediction_[a] - least_prediction_[a] >= proving_change_mps2(i))) moved = false;
    }
    have_predictions_ = true;
    if (moved && clean_run_ >= config_.clean_blocks) unproven_ = false;
  }
  // While a sensor is set aside the episode ends only when it, too, agrees again.
  const SensorSet posed = isolation_.posed() & evidence_.usable;
  const SetTest& all = tests.of(posed);
  if (!(all.alive(limits_) && all.parity_alive(limits_))) return;
  episode_.clean.add(view.used.x_mps2, config_.excitation_angle_rad);
  const bool on_record = episode_.open || episode_.stations.size() > 0;
  if (on_record && episode_.clean.size() >= config_.forget_blocks) forget_episode();
}

SensorSet HealthMonitor::culprits() const noexcept {
  const SensorSet posed = isolation_.posed();
  if (asserted_left_ > 0 && episode_.open && !scan_.asserted.empty() && scan_.asserted.size() <= asserted_left_)
    return scan_.asserted;
  if (isolation_.strict_grade() < 1 || episode_.candidate.empty()) return {};
  const int survivors = (posed - episode_.candidate).size();
  int needed = config_.isolation_stations;
  if (survivors <= 3 && needed < 2) needed = 2;  // three survivors have no parity: one station may be a mirror
  if (noisy_.contains(episode_.candidate) && needed < 2) needed = 2;  // at one station its scatter may be a push
  return episode_.agreeing.size() >= needed ? episode_.candidate : SensorSet{};
}

void HealthMonitor::examine_probation(const BlockTests& tests, const BlockView& view) noexcept {
  const BlockEvidence& evidence = tests.block();
  if (view.kind != BlockView::Kind::clean || episode_.open || unproven_ || mode_ == Mode::failed ||
      mode_ == Mode::suspect)
    return;
  const SensorSet asked = ((excluded_ | set_aside_) - (readmitted_ | absent_)) & evidence.usable & calm_ & calibrated_;
  SensorSet fine;
  for (int i = 0; i < array_.size(); ++i) {
    if (!asked.has(i)) continue;
    const SetTest& t = tests.of((in_service_ & evidence.usable).with(i));
    if (t.tested && t.alive(limits_) && t.parity <= config_.clear_fraction * t.parity_alarm_limit(limits_))
      fine = fine.with(i);
  }
  const SensorSet still = on_probation_ & fine;
  if (still.empty()) probation_.clear();
  on_probation_ = still.empty() ? fine : still;
  if (!on_probation_.empty()) probation_.add(view.used.x_mps2, config_.excitation_angle_rad);
}

/// Who may speak against a fault set of the asserted size: the calm, and those that scatter by themselves whichever so
/// many others hang.
SensorSet HealthMonitor::witnesses() const noexcept {
  SensorSet out = calm_;
  if (asserted_left_ > parity_grade(array_, in_service_ & block_usable_)) return out;
  for (int i = 0; i < array_.size(); ++i) {
    if (noisy_run_[static_cast<size_t>(i)] > 0) out = out.with(i);
  }
  return out;
}

/// The vector is that of a block: what the tool turned since the one before, and inside it, comes on top of its bound.
double HealthMonitor::motion_in_bound_rad() const noexcept {
  return drift_rad_ + std::sqrt(3.0 * evidence_.spread_mps2_sq) / gravity_.g_mps2;
}

void HealthMonitor::rescan(const BlockTests& tests) noexcept {
  live_ = isolation_.live();
  if (!have_evidence_) return;
  int depth = protection_faults_;
  if (asserted_left_ > depth) depth = asserted_left_;
  if (episode_.open && isolation_.strict_grade() > depth) depth = isolation_.strict_grade();
  scan_ = isolation_.scan(tests, in_service_, depth, asserted_left_,
                          {protection_faults_, k_integrity_, config_.common_drift_mps2}, witnesses());
  // What the sensors feel is g + a: every explanation bounds its direction, and no reading tells the rest.
  scan_.protection_rad += motion_in_bound_rad() + acceleration_turn_rad(gravity_, limits_.acceleration_mps2);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
