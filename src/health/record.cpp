// What is kept on record from block to block: the station, the votes of an episode, patience, clean blocks, probation.
#include <algorithm>
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
/// A direction may stand on record where half of the angle that tells attitudes apart is so many times its own standard
/// deviation.
constexpr double kDirectionSigmas = 3.0;
/// Votes at one station are taken at 1, 2, 4, 8 and 16 blocks: refined, never repeated at will.
constexpr int kLastVoteBlock = 16;

}  // namespace

/// The direction of a tested set, zero where noise leaves it too open to tell one attitude from another.
Vec3 HealthMonitor::known_direction(const SetTest& test) const noexcept {
  const double sigma_rad = tilt_sigma_rad(test.x_mps2, test.covariance);
  return kDirectionSigmas * sigma_rad <= 0.5 * config_.excitation_angle_rad ? test.x_mps2 : Vec3{};
}

/// Whether enough sensors to determine a vector read what they read when the station began. Then the tool has not
/// turned, whatever the others make of the direction: a liar that steps is no new attitude.
bool HealthMonitor::is_still_there() const noexcept {
  const auto samples = static_cast<double>(station_.samples);
  const SensorSet same = reads_the_same(array_, evidence_, station_.reading_mps2, samples);
  return rank_of(array_, same & station_.delivered) == 3;
}

/// A station at which the question was asked, and no block gave the candidate for an answer, takes it back.
void HealthMonitor::leave_station() noexcept {
  if (station_.asked && !station_.answered) episode_.take_back();
  station_.clear();
}

void HealthMonitor::follow_station(const Sample& sample, const SetTest& pose) noexcept {
  const Vec3& direction = pose.x_mps2;
  // A station of sensors that all read zero points nowhere: no angle to it would ever end it.
  const bool nowhere = !(norm(station_.direction) > 0.0);
  const bool turned = nowhere || angle_between_rad(station_.direction, direction) > config_.station_angle_rad;
  if (!station_.open || sample.station != station_.tag || (turned && !is_still_there())) {
    leave_station();
    station_.open = true;
    station_.tag = sample.station;
    station_.direction = known_direction(pose);
    station_.last = direction;
    station_.samples = static_cast<float>(evidence_.samples);
    station_.delivered = evidence_.usable;
    for (size_t a = 0; a < kCapacity; ++a) station_.reading_mps2[a] = static_cast<float>(evidence_.mean_mps2[a]);
  }
  drift_rad_ = angle_between_rad(station_.last, direction);
  station_.last = direction;
  if (station_.blocks < StationTrack::kMostBlocks) ++station_.blocks;
}

/// What scatters may be all that shows of a movement: the strict grade bears so many faulty ones that hang that the
/// calm healthy ones left lie in one plane, and across it the tool moves unfelt. So its average kills nothing. But a
/// sensor that alone scatters, whichever others are doubted, while these agree, is the answer of this station by that.
bool HealthMonitor::answers_by_scatter(const BlockTests& tests) const noexcept {
  if (noisy_.size() != 1 || isolation_.strict_grade() < 1) return false;
  const bool checked = isolation_.parity_grade() >= 1;
  if (checked && noisy_run_[static_cast<size_t>(noisy_.lowest())] == 0) return false;
  const SensorSet others = isolation_.posed() - noisy_;
  const SetTest& rest = tests.of(others & tests.block().usable);
  return calm_.contains(others) && rest.tested && rest.alive(limits_) && rest.parity_alive(limits_);
}

/// Asks who is at fault, and keeps the answer.
void HealthMonitor::vote(const BlockTests& tests) noexcept {
  const BlockEvidence& evidence = tests.block();
  const int blocks = station_.blocks;
  // An answer that a silent channel leaves untestable neither confirms nor takes back the one before.
  const bool testable = evidence.usable.contains(isolation_.posed());
  const bool due = testable && blocks <= kLastVoteBlock && (blocks & (blocks - 1)) == 0;
  if (!due) return;
  answer_ = isolation_.vote(tests, calm_);
  station_.asked = true;
  const SensorSet posed = isolation_.posed();
  const bool by_scatter = answer_.strict.empty() && answers_by_scatter(tests);
  if (by_scatter) answer_.strict = noisy_;
  const SetTest& full = tests.of(posed & evidence.usable);
  const bool visible = !full.alive(limits_) || !full.parity_alive(limits_);
  // A fault may come and go within a station: a block without it neither confirms nor takes back.
  if (answer_.strict.empty() && !visible) return;
  if (answer_.strict != episode_.candidate) {
    episode_.take_back();
    episode_.candidate = answer_.strict;
    episode_.by_scatter = by_scatter;
  }
  station_.answered = !answer_.strict.empty();
  // A station at which the fault cannot be seen confirms nothing.
  if (answer_.strict.empty() || !visible) return;
  episode_.by_scatter = episode_.by_scatter && by_scatter;
  const SetTest& survivors = tests.of((posed - answer_.strict) & evidence.usable);
  if (survivors.tested) episode_.agreeing.add(known_direction(survivors), config_.excitation_angle_rad);
}

/// Patience counts doubt, not alarms alone: a block between the limit to leave suspect and the one to enter it would
/// else hold the monitor there for ever. It rests at a reference error, of which nobody in service is accused.
void HealthMonitor::count_doubt(const BlockView& view) noexcept {
  // The contradiction for which the host had a fit made is no news, and the fit needs more stations than patience has.
  const bool known = answer_.contradiction && expected(HealthEvent::contradiction);
  episode_.note_suspected((episode_.candidate | set_aside_).size());
  if (!view.doubtful(mode_) || known || owes_calibration()) return;
  episode_.stations.add(station_.direction, config_.excitation_angle_rad);
  if (episode_.doubtful_blocks < config_.patience_blocks) ++episode_.doubtful_blocks;
}

/// Of attitudes in doubt, which do not count while those to come may speak against the calibration; of blocks in doubt
/// where they are counted.
bool HealthMonitor::is_out_of_stations() const noexcept {
  const bool gathers = check_.gathers() && isolation_.strict_grade() >= 1;
  return !gathers && episode_.stations.size() >= config_.patience;
}
bool HealthMonitor::is_out_of_blocks() const noexcept {
  return config_.patience_blocks > 0 && episode_.doubtful_blocks >= config_.patience_blocks;
}

bool HealthMonitor::patience_is_over() const noexcept {
  if (mode_ != Mode::suspect && mode_ != Mode::recalibrating) return false;
  if (check_.refused()) return false;  // nobody is accused of it
  return (is_out_of_stations() || is_out_of_blocks()) && (!exhausted_ || unbounded_run_ >= config_.clean_blocks);
}

/// Whether the block is explained by no more faults than the grade bears, with enough sensors left to check one
/// another. Another attitude may then single that explanation out; and where none does, because two of them are images
/// of each other, no attitude speaks against the tool.
bool HealthMonitor::is_isolable() const noexcept {
  const int grade = std::max(isolation_.strict_grade(), isolation_.parity_grade());
  return scan_.least <= grade && (isolation_.posed() & evidence_.usable).size() - scan_.least >= 4;
}

/// Blocks in a row in which the doubt had neither a bound nor a way out. A bound: of the estimate, or of that of the
/// sensors which nobody suspects: a liar takes the estimate as far as it likes once it is known, and has so many
/// stations to go before it is excluded. A way out: `is_isolable`, which ends with the blocks where these are counted.
void HealthMonitor::count_unbounded(const BlockTests& tests, const BlockView& view) noexcept {
  bool bounded = scan_.protection_available && scan_.protection_rad <= config_.alert_limit_rad;
  if (!bounded && mode_ == Mode::suspect && (is_out_of_stations() || is_out_of_blocks())) {
    const double turn_rad = motion_in_bound_rad() + acceleration_turn_rad(gravity_, limits_.acceleration_mps2);
    const ProtectionTerms terms{protection_faults_, k_integrity_};
    bounded = (!is_out_of_blocks() && is_isolable()) ||
              isolation_.bounded_without(tests, in_service_, scan_, terms, config_.alert_limit_rad - turn_rad);
  }
  if (bounded) {
    unbounded_run_ = 0;
  } else if (view.kind != BlockView::Kind::reference && unbounded_run_ < config_.clean_blocks) {
    ++unbounded_run_;
  }
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
      const auto prediction = static_cast<float>(dot(array_.axis(i), view.used.x_mps2));
      if (!have_predictions_ || prediction < least_prediction_[a]) least_prediction_[a] = prediction;
      if (!have_predictions_ || prediction > most_prediction_[a]) most_prediction_[a] = prediction;
      if (!(static_cast<double>(most_prediction_[a] - least_prediction_[a]) >= proving_change_mps2(i))) moved = false;
    }
    have_predictions_ = true;
    const bool believed = isolation_.strict_grade() < 1 || check_.believed();
    if (moved && believed && clean_run_ >= config_.clean_blocks) unproven_ = false;
  }
  // While a sensor is set aside the episode ends only when it, too, agrees again.
  const SensorSet posed = isolation_.posed() & evidence_.usable;
  const SetTest& all = tests.of(posed);
  if (!(all.alive(limits_) && all.parity_alive(limits_))) return;
  episode_.clean.add(known_direction(view.used), config_.excitation_angle_rad);
  const bool on_record = episode_.open || episode_.stations.size() > 0;
  if (on_record && episode_.clean.size() >= config_.forget_blocks) forget_episode();
}

SensorSet HealthMonitor::culprits() const noexcept {
  const SensorSet posed = isolation_.posed();
  if (asserted_left_ > 0 && episode_.open && !scan_.asserted.empty() && scan_.asserted.size() <= asserted_left_ &&
      may_convict(scan_.asserted))
    return scan_.asserted;
  if (isolation_.strict_grade() < 1 || episode_.candidate.empty()) return {};
  const int survivors = (posed - episode_.candidate).size();
  int needed = config_.isolation_stations;
  if (survivors <= 3 && needed < 2) needed = 2;  // three survivors have no parity: one station may be a mirror
  if (episode_.by_scatter && isolation_.parity_grade() >= 1) return {};  // provisionally, and by `noise_confirmed`
  if (episode_.by_scatter && needed < 2) needed = 2;                     // at one station its scatter may be a push
  const bool agreed = episode_.agreeing.size() >= needed && may_convict(episode_.candidate);
  return agreed ? episode_.candidate : SensorSet{};
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
  if (!on_probation_.empty()) probation_.add(known_direction(view.used), config_.excitation_angle_rad);
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
  const double now_rad =
      std::fmax(drift_rad_, slow_motion_.now_rad()) + std::sqrt(3.0 * evidence_.spread_mps2_sq) / gravity_.g_mps2;
  return std::fmax(now_rad, slow_motion_.bound_rad(gravity_.g_mps2));
}

/// Of a change of the specific force, in whatever direction, some sensor in service feels this share at least: the
/// greatest of n squares is no less than their mean, and their sum no less than the least eigenvalue of sum h h'. That
/// is the determinant over the product of the other two, which is no more than the square of their mean; each round
/// takes the eigenvalue found so far from the trace, and so stays below it.
double HealthMonitor::least_share_felt(SensorSet usable) const noexcept {
  const SensorSet used = in_service_ & usable;
  Mat3 m{};
  for (int i = 0; i < array_.size(); ++i) {
    if (!used.has(i)) continue;
    const Vec3& h = array_.axis(i);
    for (size_t k = 0; k < 9; ++k) m[k] += h[k / 3] * h[k % 3];
  }
  const double determinant = dot({m[0], m[1], m[2]}, cross({m[3], m[4], m[5]}, {m[6], m[7], m[8]}));
  if (!(determinant > 0.0)) return 0.0;
  double least = 0.0;
  for (int round = 0; round < 4; ++round) {
    const double mean = 0.5 * (m[0] + m[4] + m[8] - least);
    least = determinant / (mean * mean);
  }
  return std::sqrt(least / used.size());
}

/// The most by which a tool turns in a block whose channels all pass for quiet: a steady turn by t scatters a channel
/// that feels all of it by t g / sqrt(12), and what noise may reach hides that.
double HealthMonitor::hidden_turn_rad(SensorSet usable) const noexcept {
  const double share = least_share_felt(usable);
  if (!(share > 0.0) || !(restless_factor_ > 1.0)) return 0.0;  // a row that is a station has no scatter
  double most_mps2 = 0.0;
  for (int i = 0; i < array_.size(); ++i) {
    if (in_service_.has(i)) most_mps2 = std::fmax(most_mps2, array_.sigma_mps2(i) * verdict_.noise_factor);
  }
  return std::sqrt(12.0 * (restless_factor_ - 1.0)) * most_mps2 / (share * gravity_.g_mps2);
}

void HealthMonitor::rescan(const BlockTests& tests) noexcept {
  live_ = isolation_.live();
  if (!have_evidence_) return;
  int depth = protection_faults_;
  if (asserted_left_ > depth) depth = asserted_left_;
  if (episode_.open && isolation_.strict_grade() > depth) depth = isolation_.strict_grade();
  scan_ = isolation_.scan(
      tests, in_service_, depth, asserted_left_,
      {protection_faults_, k_integrity_, (set_aside_ & evidence_.usable).size(), episode_.open, unproven_},
      witnesses());
  // What the sensors feel is g + a: every explanation bounds its direction, and no reading tells the rest.
  scan_.protection_rad += motion_in_bound_rad() + acceleration_turn_rad(gravity_, limits_.acceleration_mps2);
  // Widened, the norm does not see what may have turned the direction beside the offset.
  if (gravity_widened_mps2_ > 0.0) scan_.protection_rad += verdict_.reference.turn_rad;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
