#include "plumb/motion/motion_monitor.hpp"

#include <cmath>
#include <new>

#include "plumb/motion/motion_quantile.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

constexpr int kBlockScale = 2;  // that of MotionVerdict::block

}  // namespace

const char* to_string(MotionCause cause) noexcept {
  switch (cause) {
    case MotionCause::none: return "none";
    case MotionCause::parity: return "parity";
    case MotionCause::gyro_inconsistent: return "gyro_inconsistent";
    case MotionCause::too_many_faults: return "too_many_faults";
    case MotionCause::rotation_unknown: return "rotation_unknown";
    case MotionCause::no_redundancy: return "no_redundancy";
    case MotionCause::irregular_time: return "irregular_time";
  }
  return "?";
}

Expected<void> MotionMonitor::configure(const SensorArray& array, const MotionSetup& setup) noexcept {
  if (const Expected<void> sound = check(array, setup); !sound) return sound;
  new (this) MotionMonitor();  // in place, as all that is large: not on the stack
  array_ = array;
  setup_ = setup;
  new (&sets_) MotionSets(array);
  new (&window_) MotionWindow(array.size(), setup.gyros, setup.sample_period_s, setup.block_samples);
  noise_quantile_ = motion_noise_quantile(setup, sets_.size());
  in_service_ = array.all();
  configured_ = true;
  refit();
  return {};
}

void MotionMonitor::set_in_service(SensorSet sensors) noexcept {
  if (!configured_ || (sensors & array_.all()) == in_service_) return;
  in_service_ = sensors & array_.all();
  refit();
}

void MotionMonitor::forget() noexcept {
  with_gyro_.clear();
  without_gyro_.clear();
  verdict_.excluded = SensorSet{};
  refit();
}

int MotionMonitor::most_faults() const noexcept {
  const int left = setup_.max_faults - array_.units().count(verdict_.excluded);
  const int most = grade_ < left ? grade_ : left;
  return most < 0 ? 0 : most;
}

/// After the sensors that are monitored have changed.
void MotionMonitor::refit() noexcept {
  const SensorSet sensors = monitored();
  with_gyro_.keep_within(sensors);
  without_gyro_.keep_within(sensors);
  grade_ = motion_grade(array_, sensors);
  redundant_ = sets_.any_within(sensors);
  trust();
  news_ = true;
}

bool MotionMonitor::check_each_other(SensorSet sensors) const noexcept {
  return sensors == monitored() ? redundant_ : sets_.any_within(sensors);
}

/// After the sensors that are monitored or isolated have changed.
void MotionMonitor::trust() noexcept {
  const SensorSet rest = monitored() - verdict_.isolated;
  trusted_ = spans_space(array_, rest) ? rest : monitored();
  new (&force_) ForceEstimator(array_, trusted_);
}

bool MotionMonitor::reject(const MotionReadings& readings, RejectedSets* record) noexcept {
  const SensorSet sensors = monitored();
  MotionReadings asked = readings;
  asked.usable = readings.usable & sensors;
  asked.at_least = readings.at_least & sensors;
  asked.at_most = readings.at_most & sensors;
  const SensorSet speaking = asked.usable | asked.at_least | asked.at_most;
  if (speaking.size() < 2 || !may_reject(array_, sets_, asked, force_.all())) return false;
  bool any = false;
  for (int k = 0; k < sets_.size(); ++k) {
    if (!rejects(array_, setup_, sets_[k], asked)) continue;
    const SensorSet set = sets_[k].all;
    news_ = record->add(set) || news_;
    verdict_.rejected = verdict_.rejected | set;
    any = true;
  }
  return any;
}

void MotionMonitor::judge(int scale, int lowest) noexcept {
  const MotionMeans means = window_.means(scale);
  const RotationTerm gyro = rotation_term(setup_, means, RotationSource::gyro, noise_quantile_);
  const MotionReadings readings = corrected(array_, setup_, means, gyro, noise_quantile_);
  MotionReadings without_gyro;
  bool any = reject(readings, &with_gyro_);
  if (doubts_gyro()) {
    const RotationTerm bound = rotation_term(setup_, means, RotationSource::bound, noise_quantile_);
    without_gyro = corrected(array_, setup_, means, bound, noise_quantile_);
    any = reject(without_gyro, &without_gyro_) || any;
  }
  if (any) last_rejection_s_ = means.time_s + means.span_s;
  if (gyro.gyros_disagree) {
    last_disagreement_s_ = means.time_s + means.span_s;
    verdict_.gyros_disagree = true;
  }
  if (!gyro.known) {
    unjudged_ = MotionCause::rotation_unknown;
  } else if (scale == lowest && !check_each_other(readings.usable & monitored())) {
    unjudged_ = MotionCause::no_redundancy;
  }
  if (scale == 0) verdict_.sample = force_of(means, readings, without_gyro);
  if (scale != kBlockScale) return;
  verdict_.block = force_of(means, readings, without_gyro);
  verdict_.block_ended = true;
}

/// What explains the sets on record; a single gyro is one more unit that may have failed, on top of one unit less.
void MotionMonitor::answer(double time_s) noexcept {
  const SensorSet before = verdict_.isolated;
  const int most = most_faults();
  const MotionAnswer found = with_gyro_.answer(array_.units(), monitored(), most);
  verdict_.suspects = found.suspects;
  verdict_.isolated = found.isolated;
  verdict_.least_faults = found.least;
  gyro_explains_ = false;
  if (doubts_gyro() && !with_gyro_.empty()) {
    const MotionAnswer beside = without_gyro_.answer(array_.units(), monitored(), most > 0 ? most - 1 : 0);
    gyro_explains_ = most == 0 || beside.least <= most - 1;
    if (gyro_explains_) verdict_.isolated = found.isolated & beside.isolated;
  }
  open_ = MotionCause::none;
  if (most > 0 && found.least > most) {
    open_ = gyro_explains_ ? MotionCause::gyro_inconsistent : MotionCause::too_many_faults;
  } else if (verdict_.isolated.empty()) {
    open_ = found.isolated.empty() ? MotionCause::parity : MotionCause::gyro_inconsistent;
  }
  if (verdict_.isolated == before) return;
  isolated_since_s_ = time_s;
  trust();
}

void MotionMonitor::decide(double time_s) noexcept {
  // The host's clock began anew: what is on record is as old as this sample.
  if (time_s < last_rejection_s_) last_rejection_s_ = time_s;
  if (time_s < isolated_since_s_) isolated_since_s_ = time_s;
  if (time_s < last_disagreement_s_) last_disagreement_s_ = time_s;
  if (time_s - last_disagreement_s_ > setup_.quiet_s) verdict_.gyros_disagree = false;
  const bool on_record = !with_gyro_.empty() || !without_gyro_.empty();
  if (on_record && time_s - last_rejection_s_ > setup_.quiet_s) {
    with_gyro_.clear();
    without_gyro_.clear();
    news_ = true;
  }
  if (news_) answer(time_s);
  news_ = false;
  verdict_.alarm = !with_gyro_.empty() || !without_gyro_.empty();
  if (verdict_.cause != MotionCause::none || !verdict_.alarm) return;
  verdict_.cause = open_;
  exclude(time_s);
}

/// After the dwell, and on a set rejected within it: not on memory alone.
void MotionMonitor::exclude(double time_s) noexcept {
  const bool due = time_s - isolated_since_s_ >= setup_.dwell_s && last_rejection_s_ > isolated_since_s_;
  if (verdict_.isolated.empty() || !due) return;
  verdict_.excluded = verdict_.excluded | verdict_.isolated;
  verdict_.isolated = SensorSet{};
  refit();
}

const MotionVerdict& MotionMonitor::step(const MotionSample& sample) noexcept {
  verdict_.rejected = SensorSet{};
  verdict_.block_ended = false;
  verdict_.cause = MotionCause::none;
  if (!configured_) return verdict_;
  window_.add(sample);
  const unsigned ended = window_.ended();
  if (ended == 0) {
    verdict_.sample = SpecificForce{};
    verdict_.block = SpecificForce{};
    unjudged_ = MotionCause::irregular_time;
  }
  const unsigned judged = ended & judged_scales();
  if (judged != 0) unjudged_ = MotionCause::none;
  for (int scale = 0, lowest = -1; scale < kMotionScales; ++scale) {
    if ((judged >> static_cast<unsigned>(scale) & 1U) == 0) continue;
    if (lowest < 0) lowest = scale;
    judge(scale, lowest);
  }
  verdict_.cause = unjudged_;
  if (ended != 0) decide(sample.time_s);
  return verdict_;
}

unsigned MotionMonitor::judged_scales() const noexcept {
  unsigned out = 0;
  for (std::size_t s = 0; s < setup_.block_samples.size(); ++s)
    out |= setup_.block_samples[s] >= setup_.shortest_block ? 1U << s : 0U;
  return out;
}

SpecificForce MotionMonitor::force_of(const MotionMeans& means, const MotionReadings& readings,
                                      const MotionReadings& without_gyro) const noexcept {
  ForceEvidence evidence;
  evidence.rejected = &with_gyro_;
  evidence.isolated = monitored() - trusted_;
  evidence.gyro_assumed = doubts_gyro() && !gyro_explains_;
  evidence.without_gyro = gyro_explains_ ? &without_gyro : nullptr;
  const SensorSet used = readings.usable & trusted_;
  if (used == force_.all().used) return force_.estimate(setup_, array_.units(), means, readings, evidence);
  return ForceEstimator(array_, used).estimate(setup_, array_.units(), means, readings, evidence);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
