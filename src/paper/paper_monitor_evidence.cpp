// One block of paper mode: the gate, the pool, the triples, the check of those that remain, and the stations of
// step 10.
#include <cmath>

#include "plumb/paper/paper_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Step 10 is tried at each of these numbers of attitudes; the last one is the last try.
constexpr int kFirstTry = 12;
constexpr int kTryEvery = 6;
static_assert((PaperMonitor::kMaxStations - kFirstTry) % kTryEvery == 0, "the last try is made with a full store");
static_assert(kFirstTry >= kPaperRank);

/// Passed blocks must come from so many attitudes before a suspicion without an alarm ends.
constexpr int kProvingAttitudes = 2;

}  // namespace

/// False where too few samples were complete, or no finite vector came of them: no evidence.
bool PaperMonitor::read_block(const BlockJudgement& judged) noexcept {
  if (2 * kept_count_ < config_.window) return false;
  mean_ = Kept{};
  for (int k = 0; k < kept_count_; ++k) {
    const Kept& kept = kept_[static_cast<size_t>(k)];
    for (size_t i = 0; i < kept.raw.size(); ++i) mean_.raw[i] += kept.raw[i] / kept_count_;
    mean_.temperature_degc += kept.temperature_degc / kept_count_;
  }
  mean_samples_ = judged.evidence.samples;
  const Vec3 x = paper_vector_in_use(fits(), raw_of(mean_), mean_.temperature_degc, in_service_);
  if (!std::isfinite(norm(x))) return false;
  vector_mps2_ = x;
  const SensorSet calm = in_service_ - judged.noisy;
  attitude_mps2_ =
      rank_of(nominal_, calm) == 3 ? paper_vector_in_use(fits(), raw_of(mean_), mean_.temperature_degc, calm) : x;
  return true;
}

bool PaperMonitor::add_to(AttitudeRecord& record) const noexcept {
  return record.add(attitude_mps2_, config_.distinct_attitude_angle_rad * gravity_.g_mps2);
}

PaperMae PaperMonitor::mae_of_block() const noexcept {
  PaperMae mae;
  for (int k = 0; k < kept_count_; ++k) {
    const Kept& kept = kept_[static_cast<size_t>(k)];
    mae.add(norm(paper_vector_in_use(fits(), raw_of(kept), kept.temperature_degc, in_service_)) - gravity_.g_mps2);
  }
  return mae;
}

void PaperMonitor::show_parity(const BlockEvidence& evidence) noexcept {
  const SetTest test = test_set(array_, gravity_, limits_, evidence, in_service_ & evidence.usable);
  const bool has_parity = test.parity_rows > 0;
  verdict_.parity = has_parity ? test.parity : 0.0;
  verdict_.parity_limit = has_parity ? test.parity_alarm_limit(limits_) : 0.0;
}

void PaperMonitor::show_vector() noexcept {
  verdict_.gravity_mps2 = times(frame_, vector_mps2_);
  verdict_.norm_error_mps2 = norm(vector_mps2_) - gravity_.g_mps2;
  Mat3 noise = least_squares(nominal_, in_service_).covariance;
  for (double& entry : noise) entry /= std::fmax(mean_samples_, 1.0);
  verdict_.covariance = turned_covariance(frame_, noise);
}

bool PaperMonitor::add_station() noexcept {
  if (!add_to(attitudes_)) return false;
  Station& station = stations_[static_cast<size_t>(attitudes_.size() - 1)];
  station = Station{};
  station.mean = raw_of(mean_);
  station.delivered = in_service_;
  station.temperature_degc = mean_.temperature_degc;
  station.count = static_cast<std::uint32_t>(std::fmax(mean_samples_, 1.0));
  station.begin_s = station.end_s = evidence_time_s_;
  return true;
}

void PaperMonitor::restart_pool() noexcept {
  pool_.clear();
  attitudes_.clear();
}

/// Step 3: the samples of the block join the pool.
void PaperMonitor::pool_block() noexcept {
  if (pool_.samples() == 0) attitudes_.clear();  // the store may hold the stations of an interrupted fit
  for (int k = 0; k < kept_count_; ++k) {
    const Kept& kept = kept_[static_cast<size_t>(k)];
    pool_.add(fits(), gravity_.g_mps2, raw_of(kept), kept.temperature_degc, in_service_);
  }
  add_station();
}

double PaperMonitor::mae_over_stations(SensorSet of) const noexcept {
  PaperMae mae;
  for (int k = 0; k < attitudes_.size(); ++k) {
    const Station& s = stations_[static_cast<size_t>(k)];
    mae.add(norm(paper_vector_in_use(fits(), s.mean, s.temperature_degc, of)) - gravity_.g_mps2);
  }
  return mae.mps2();
}

/// Steps 4 to 7 and 9, once the pool holds enough attitudes.
EventMask PaperMonitor::decide_triples() noexcept {
  // Without redundancy the table cannot isolate a sensor: the alarm leads to suspect first.
  if (attitudes_.size() < config_.isolation_stations || mode_ == Mode::degraded) return 0;
  finding_ = pool_.finding(fits(), delta_f_mps2_, in_service_);
  EventMask raised = 0;
  if (finding_.detected) {
    verdict_.statistic = finding_.mae_all_mps2;
    verdict_.margin = 1.0 - verdict_.statistic / delta_f_mps2_;
    const SensorSet remaining = in_service_ - finding_.isolated;
    if (finding_.passing == 0) {
      raised = bit(HealthEvent::no_consistent_hypothesis);
    } else if (!finding_.isolated.empty()) {
      const bool holds = mae_over_stations(remaining) < delta_f_mps2_;
      accused_ = holds ? finding_.isolated : SensorSet{};
      raised = bit(holds ? HealthEvent::exclusion : HealthEvent::no_consistent_hypothesis);
    }
  }
  verdict_.mae_all_mps2 = finding_.mae_all_mps2;
  verdict_.mae_worst_mps2 = finding_.worst_mps2;
  verdict_.mae_worst_limit_mps2 = delta_f_mps2_;
  restart_pool();
  return raised;
}

void PaperMonitor::count_clean(bool clean, bool over) noexcept {
  if (over) clean_.clear();
  if (!clean) {
    clean_run_ = 0;
    return;
  }
  if (clean_run_ < config_.passed_blocks) ++clean_run_;
  add_to(clean_);
  if (clean_run_ >= config_.passed_blocks && clean_.size() >= kProvingAttitudes) not_yet_validated_ = false;
  if (episode_open_ && clean_.size() >= config_.forget_blocks) forget_episode();
}

bool PaperMonitor::fit_rest() noexcept {
  return paper_calibrate(datasheet_, gravity_, stations_.data(), attitudes_.size(), in_service_, PaperOptions{},
                         candidate_) &&
         may_replace(candidate_, datasheet_, gravity_.g_mps2, delta_f_mps2_);
}

/// Step 10: whether it is due, and its stations.
EventMask PaperMonitor::recalibrate(bool clean) noexcept {
  if (!clean) return 0;
  if (mode_ == Mode::recalibrating) {
    if (!add_station()) return 0;
    const int past = attitudes_.size() - kFirstTry;
    if (past < 0 || past % kTryEvery != 0) return 0;
    if (fit_rest()) return bit(HealthEvent::fit_accepted);
    return attitudes_.size() == kMaxStations ? bit(HealthEvent::fit_rejected) : 0;
  }
  const bool in_state = mode_ == Mode::nominal || mode_ == Mode::isolated || mode_ == Mode::degraded;
  const bool due = in_service_.size() > 3 && fits().own(in_service_) == nullptr && in_service_ != refused_;
  return in_state && due ? bit(HealthEvent::recalibrate) : 0;
}

/// Steps 3 to 10 on a block at rest; the events that it raises.
EventMask PaperMonitor::judge(double mae_mps2) noexcept {
  const bool over = !(mae_mps2 < delta_f_mps2_);  // eq (15)
  EventMask raised = over ? bit(HealthEvent::alarm) : 0;
  if (over) {
    episode_open_ = true;
    add_to(alarmed_);
  }
  if (episode_open_ && (over || mode_ == Mode::suspect) && in_service_.size() > 3) {
    pool_block();
    raised |= decide_triples();
  }
  const double clear = (mode_ == Mode::suspect ? config_.clear_fraction : 1.0) * delta_f_mps2_;
  const bool pool_over = pool_.samples() > 0 && !(pool_.mae_all_mps2() < delta_f_mps2_);
  const bool clean = !over && mae_mps2 <= clear && !pool_over;
  if (clean) raised |= bit(HealthEvent::passed_block);
  count_clean(clean, over);
  const bool patient = !episode_open_ || alarmed_.size() < config_.isolation_timeout;
  if (mode_ == Mode::suspect && !patient) raised |= bit(HealthEvent::isolation_timeout);
  return raised | recalibrate(clean);
}

EventMask PaperMonitor::tick(const Sample& sample) noexcept {
  const BlockJudgement judged = judge_block(array_, block_, in_service_, restless_factor_, gravity_.g_mps2);
  const SensorSet silent = silence_.note(block_.usable(), array_.size(), config_.missing_confirm);
  if (!silent.empty()) gate_.mark_lost(silent - absent_);
  verdict_.scattering = judged.scattering;
  moving_ = !judged.quiet || !read_block(judged);
  if (moving_) {
    verdict_.cause = Cause::moving;
    empty_block();
    return 0;
  }
  evidence_time_s_ = sample.time_s;
  have_evidence_ = true;
  const double mae_mps2 = mae_of_block().mps2();
  verdict_.cause = temperature_out_ ? Cause::temperature : mae_mps2 < delta_f_mps2_ ? Cause::passed_block : Cause::mae;
  verdict_.decided_by = Cause::mae;
  verdict_.mae_all_mps2 = verdict_.statistic = mae_mps2;
  verdict_.limit = delta_f_mps2_;
  verdict_.margin = 1.0 - mae_mps2 / delta_f_mps2_;
  verdict_.mae_worst_mps2 = verdict_.mae_worst_limit_mps2 = 0.0;  // the triples have not been asked
  show_parity(judged.evidence);
  show_vector();
  const EventMask raised = temperature_out_ || mode_ == Mode::failed ? 0 : judge(mae_mps2);
  empty_block();
  return raised;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
