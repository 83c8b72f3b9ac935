// The flow of one step: admit, gate, convert, collect, decide, publish.
#include "plumb/health/health_monitor.hpp"

#include <cmath>
#include <type_traits>

#include "plumb/detection/mae_test.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

static_assert(std::is_trivially_copyable<HealthMonitor>::value, "a copy is an assignment");
static_assert(noexcept(std::declval<HealthMonitor&>().step(std::declval<const Sample&>())));

namespace {

/// Output beyond the calibrated span by more than this is unconfirmed (docs/theory.md, section 9.7).
constexpr double kTemperatureMargin_degc = 5.0;
constexpr double kRestlessRate = 1e-6;
/// Least k for which more than k faults among n are rarer than `risk`, each sensor faulty with `prior`.
int faults_to_cover(int n, double prior, double risk) noexcept {
  double term = 1.0;
  for (int i = 0; i < n; ++i) term *= 1.0 - prior;
  double cumulative = term;
  for (int k = 0; k < n; ++k) {
    if (1.0 - cumulative <= risk) return k < 1 ? 1 : k;
    term *= prior / (1.0 - prior) * (n - k) / (k + 1);
    cumulative += term;
  }
  return n;
}

}  // namespace

Expected<void> HealthMonitor::configure(const MonitorSetup& setup) noexcept {
  configured_ = false;
  core_sum_ = kNeverConfigured;
  verdict_ = Verdict{};
  const Expected<MonitorConfig> config = checked(setup.config);
  if (!config) return tl::unexpected<Error>(config.error());
  if (setup.config.mode != MonitorMode::plumb) return fail(Errc::wrong_mode, 0);
  const Expected<void> sound = checked(setup);
  if (!sound) return sound;

  config_ = setup.config;
  model_ = setup.model;
  coefficients_.forget();
  forget_near();
  array_ = setup.array;
  gravity_ = setup.gravity;
  frame_ = setup.output_frame;
  stability_stated_ = true;
  for (int i = 0; i < array_.size(); ++i) {
    const double scale = model_.scale_at(i, model_.sensor[static_cast<size_t>(i)].reference_degc);
    const double step_mps2 = std::fabs(setup.resolution_raw[static_cast<size_t>(i)] / scale);
    resolution_mps2_[static_cast<size_t>(i)] = static_cast<float>(step_mps2);
    stability_[static_cast<size_t>(i)] =
        StabilityNow::of(setup.stability[static_cast<size_t>(i)], setup.days_since_calibration);
    stability_stated_ = stability_stated_ && setup.stability[static_cast<size_t>(i)].stated();
  }
  lever_arm_m_ = setup.lever_arm_m;
  lever_arms_known_ = setup.lever_arms_known;
  const int n = array_.size();
  limits_ =
      TestLimits::from_rates(n, config_.false_alarm_rate, config_.rejection_rate, config_.acceleration_bound_mps2);
  restless_factor_ = restless_factor(n, config_.window, kRestlessRate);
  derive_limits();
  k_integrity_ = normal_tail_quantile(config_.integrity_risk / 2.0);
  protection_faults_ = faults_to_cover(n, config_.fault_prior, config_.integrity_risk);
  asserted_left_ = config_.asserted_faults;

  identity_ = identity(setup);
  power_on(setup);
  configured_ = true;
  publish(Sample{}, false);  // a verdict asked for before the first sample already names the sensors
  seal();
  return {};
}

/// Which triples vote depends on the axes, and so do their shares of the rate.
void HealthMonitor::derive_limits() noexcept {
  const double triple_rate = config_.triple_false_alarm_rate > 0.0 ? config_.triple_false_alarm_rate
                                                                   : triple_share(array_, config_.false_alarm_rate);
  mae_quantile_ = half_normal_mean_quantile(config_.window, triple_rate);
}

namespace {

/// A sensor that moved may have changed by its bias alone, or by its scale alone.
std::array<DriftSigmas, kCapacity> drift_sigmas(const MonitorSetup& setup) noexcept {
  std::array<DriftSigmas, kCapacity> out{};
  for (size_t a = 0; a < out.size(); ++a) {
    const Stability& s = setup.stability[a];
    const double sigma_mps2 = s.mps2 + setup.days_since_calibration * s.per_day_mps2;
    if (sigma_mps2 > 0.0) out[a] = {sigma_mps2, sigma_mps2 / setup.gravity.g_mps2};
  }
  return out;
}

}  // namespace

/// What many blocks together have shown.
void HealthMonitor::forget_studies() noexcept {
  scatter_.clear();
  noise_study_.clear();
  slow_motion_.clear();
  reference_study_.clear();
  check_.clear();
  calibration_notice_ = false;
  trend_.clear();
  temperature_rate_.clear();
}

/// Everything that is remembered, as it stands before the first sample.
void HealthMonitor::power_on(const MonitorSetup& setup) noexcept {
  mode_ = setup.calibrated ? Mode::suspect : Mode::initial;
  in_service_ = array_.all();
  calibrated_ = setup.calibrated ? array_.all() : SensorSet{};
  temperature_min_degc_ = config_.temperature_min_degc;
  temperature_max_degc_ = config_.temperature_max_degc;
  set_aside_ = excluded_ = absent_ = readmitted_ = SensorSet{};
  unproven_ = true;
  partial_ = false;
  silence_.clear();
  freshness_ = Freshness{};
  clock_.clear();
  block_usable_ = SensorSet{};
  pending_ = 0;
  unbounded_run_ = 0;
  drift_rad_ = 0.0;
  temperature_out_ = false;
  exhausted_ = moving_ = have_evidence_ = have_predictions_ = reset_pending_ = false;
  evidence_time_s_ = 0.0;
  last_temperature_degc_ = 25.0;
  least_prediction_.fill(0.0F);
  most_prediction_.fill(0.0F);
  sequence_ = 0;
  clean_run_ = 0;
  probation_.clear();
  on_probation_ = reset_sensors_ = clipped_ = not_finite_ = SensorSet{};
  last_grade_ = Grade::none;
  sensor_cause_.fill(Cause::none);
  noisy_run_.fill(0);
  stuck_since_.fill(0.0);
  noisy_ = stuck_ = full_scale_ = calm_ = stuck_watch_ = aside_ = SensorSet{};
  counters_ = MonitorCounters{};
  rotation_ = Rotation{};
  rotation_locked_ = inhibited_ = inhibit_notice_ = false;
  told_reference_ = reference_notice_ = ReferenceKind::none;
  gravity_widened_mps2_ = 0.0;
  forget_studies();
  gate_.configure(array_.size(), setup.full_scale_raw, config_.missing_confirm);
  block_.clear();
  raw_.clear();
  recalibration_.configure(model_, drift_sigmas(setup), config_.station_angle_rad, !setup.calibrated);
  if (mode_ == Mode::initial) recalibration_.start(in_service_);
  base_ = Mode::suspect;
  suspicion_ = Cause::none;
  recalibration_asked_ = recalibration_due_ = three_sensor_fit_ = false;
  store_g_mps2_ = gravity_.g_mps2;
  mae_.configure(array_.triple_count(), config_.window);
  isolation_ = Isolation{};
  isolation_.pose(array_, in_service_);
  episode_.clear();
  station_.clear();
  rest_.clear();
  map_ = least_squares(array_, in_service_);
  evidence_ = BlockEvidence{};
  answer_ = IsolationAnswer{};
  scan_ = FaultSetScan{};
  size_class_ = classify(in_service_);
  live_ = isolation_.live();
}

Expected<void> HealthMonitor::reset(std::uint64_t key, SensorSet sensors) noexcept {
  if (!whole()) return fail(Errc::not_calibrated);
  if (key != config_.reset_key) return fail(Errc::wrong_key);
  reset_pending_ = true;
  reset_sensors_ = sensors & array_.all();
  seal();
  return {};
}

Expected<void> HealthMonitor::set_gravity(const GravityReference& gravity) noexcept {
  const Expected<void> sound = plausible(gravity);
  if (!sound) return sound;
  if (!whole()) return fail(Errc::not_calibrated);
  gravity_ = gravity;
  if (gravity_widened_mps2_ > 0.0) {  // the finding was about the other one
    gravity_widened_mps2_ = 0.0;
    told_reference_ = ReferenceKind::none;
    verdict_.reference = ReferenceFinding{};
  }
  forget_near();
  // Stations under one gravity and stations under another do not make one fit.
  if (!(std::fabs(gravity.g_mps2 - store_g_mps2_) <= gravity.sigma_mps2)) {
    recalibration_.forget();
    store_g_mps2_ = gravity.g_mps2;
  }
  // What died under the other gravity may have died of it.
  isolation_.clear();
  answer_ = IsolationAnswer{};
  reference_study_.clear();
  check_.forget_readings();
  episode_.take_back();
  seal();
  return {};
}

Expected<void> HealthMonitor::set_rotation(const Rotation& rotation) noexcept {
  if (!std::isfinite(norm(rotation.rate_radps))) return fail(Errc::not_finite, 0, norm(rotation.rate_radps));
  if (!whole()) return fail(Errc::not_calibrated);
  rotation_ = rotation;
  seal();
  return {};
}

void HealthMonitor::inhibit(bool frozen) noexcept {
  if (!whole()) return;  // the next block says so
  inhibit_notice_ = inhibit_notice_ != (frozen != inhibited_);
  inhibited_ = frozen;
  seal();
}

/// What the host's freeze leaves of the events: it holds back what moves sensors on evidence and what replaces the
/// calibration. Both are levels or come again with the next block.
/// Patience that ends recalibration leads back to where that began, but not past what speaks against the tool at the
/// same time (S17; the model in model/ found it).
EventMask HealthMonitor::allowed(EventMask raised) const noexcept {
  if (mode_ == Mode::recalibrating && (raised & kKeptEvents) != 0) raised &= ~bit(HealthEvent::patience_over);
  constexpr EventMask kFrozen = bit(HealthEvent::culprit) | bit(HealthEvent::set_aside) |
                                bit(HealthEvent::probation_passed) | bit(HealthEvent::recalibrate) |
                                bit(HealthEvent::fit_accepted);
  return inhibited_ ? raised & ~kFrozen : raised;
}

/// y = h.g is what the sensors feel of gravity; turning adds -h.(w x (w x r)). A rate or an arm that the host got wrong
/// may make of a reading what is no reading.
void HealthMonitor::take_rotation_off(Readings& y, GateResult& gate) const noexcept {
  const Vec3& w = rotation_.rate_radps;
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    if (gate.usable.has(i)) keep_reading(i, y[a] + dot(array_.axis(i), cross(w, cross(w, lever_arm_m_[a]))), y, gate);
  }
}

void HealthMonitor::empty_windows() noexcept {
  gate_.begin_block();
  block_.clear();
  raw_.clear();
  mae_.clear();
  leave_station();
  rest_.clear();
  slow_motion_.lapse();
}

/// The sample is refused and the windows stay as they are; what was valid is now only held.
void HealthMonitor::refuse(const Sample& sample) noexcept {
  count_up(counters_.time_refused);
  verdict_.sample = counters_.samples;
  verdict_.cause = Cause::time_fault;
  publish_claims(verdict_.validity == Validity::invalid ? Validity::invalid : Validity::held);
  if (reset_pending_) {  // the host's key is served whatever the clock does
    decide(bit(HealthEvent::reset), clock_.last_s());
    publish(sample, false);
    verdict_.cause = Cause::time_fault;
  }
}

/// Readings of one sample into the block and the window.
#if PLUMB_SINGLE
void HealthMonitor::add_readings(const Readings& y, SensorSet usable, double count) noexcept {
  Differences d;
  block_.add(y, usable, count, d);
  if (block_.size() == 1 || !near_.is_of(block_)) near_.take(array_, map_, frame_, block_, gravity_.g_mps2);
  NearLengths::Estimate latest;
  if (map_.valid && usable.contains(in_service_)) {
    if (NearLengths::near(d, usable).contains(in_service_)) latest = near_.estimate(d, in_service_);
    if (latest.units < 0) {
      const Vec3 x = map_.estimate(y);
      latest = {times(frame_, x), to_mae_units(norm(x) - gravity_.g_mps2)};
    }
    verdict_.latest_mps2 = latest.framed_mps2;
  }
  mae_.add(array_, y, usable, near_, d, latest.units, gravity_.g_mps2);
}
#else
void HealthMonitor::add_readings(const Readings& y, SensorSet usable, double count) noexcept {
  const bool map_usable = map_.valid && usable.contains(in_service_);
  const Vec3 latest = map_usable ? map_.estimate(y) : Vec3{};
  mae_.add(array_, y, usable, map_usable ? &latest : nullptr, gravity_.g_mps2);
  if (map_usable) verdict_.latest_mps2 = times(frame_, latest);
  block_.add(y, usable, count);
}
#endif

Readings HealthMonitor::readings_now(const Sample& sample, GateResult& gate) noexcept {
  Readings y = readings_of(model_, coefficients_, sample, last_temperature_degc_, gate);
  if (rotation_.turning && is_rotation_modelled()) take_rotation_off(y, gate);
  return y;
}

/// One sample into the block and the windows.
void HealthMonitor::collect_sample(const Sample& sample, GateResult& gate) noexcept {
  const Readings y = readings_now(sample, gate);
  if (rotation_.turning && !is_rotation_modelled()) {
    const bool still = rotation_.rate_known && norm(rotation_.rate_radps) <= kStillRate_radps;
    rotation_locked_ = rotation_locked_ || !still;
  }
  clipped_ = block_.size() == 0 ? gate.clipped : clipped_ | gate.clipped;
  not_finite_ = block_.size() == 0 ? gate.not_finite : not_finite_ | gate.not_finite;
  const double t = sample.temperature_degc;
  const bool outside =
      !(t >= temperature_min_degc_ - kTemperatureMargin_degc && t <= temperature_max_degc_ + kTemperatureMargin_degc);
  if (outside) count_up(counters_.temperature_out);
  temperature_out_ = block_.size() == 0 ? outside : temperature_out_ || outside;  // one hot sample taints its block
  if (std::isfinite(t)) last_temperature_degc_ = t;
  if (block_.size() == 0) freshness_.begin_block(sample.time_s);
  freshness_.note(array_, in_service_, gate.usable, y, evidence_);
  silence_.add(gate.usable, array_.size());
  verdict_.accepted = true;
  if (!joins_block(gate.usable)) return;
  add_readings(y, gate.usable, sample.count > 0 ? sample.count : 1);
  compare_in_motion(y, gate.usable);
  raw_.add(sample.raw, gate.usable, last_temperature_degc_);
}

const Verdict& HealthMonitor::step(const Sample& sample) noexcept {
  verdict_.transition = TransitionRecord{};
  verdict_.tick = false;
  verdict_.accepted = false;
  if (!configured_ && core_sum_ == kNeverConfigured) return verdict_;
  if (!core_holds()) return lose_memory(sample);
  verdict_.time_s = sample.time_s;
  count_up(counters_.samples);
  const Arrival arrival = clock_.admit(sample.time_s, config_.max_gap_s);
  GateResult gate;
  const SensorSet lost = gate_.lost(), back = gate_.back();
  if (arrival != Arrival::refused) gate = gate_.gate(sample);
  if (arrival == Arrival::refused) {
    freshness_.note_nothing();
  } else if (gate.gap) {
    freshness_.note_gap();
  } else if (arrival == Arrival::in_order) {
    collect_sample(sample, gate);
  }
  // Nothing is decided, and nothing written to that the sum is over, before that has been found as it was left.
  if (lost == gate_.lost() && back == gate_.back() && !is_eventful(arrival, gate)) {
    publish_sample(sample);
    return verdict_;
  }
  if (!steady_holds()) return lose_memory(sample);
  if (arrival == Arrival::refused) {
    refuse(sample);
  } else {
    serve(sample, arrival, gate);
  }
  seal();
  return verdict_;
}

/// Whether a step does more than collect its sample.
bool HealthMonitor::is_eventful(Arrival arrival, const GateResult& gate) const noexcept {
  const bool fits =
      mode_ == Mode::recalibrating || mode_ == Mode::initial || recalibration_asked_ || recalibration_due_;
  return arrival != Arrival::in_order || gate.gap || block_.size() >= config_.window ||
         silence_.is_due(config_.window) || fits || reset_pending_ || pending_ != 0 ||
         !((gate_.lost() & array_.all()) - absent_).empty() || !(gate_.back() & absent_).empty() || inhibit_notice_ ||
         reference_notice_ != ReferenceKind::none || calibration_notice_ || news();
}

/// The row that ends a block may be the first of another attitude: the block's vector is held against it, too. Apart
/// from `serve`, beneath which the stack is deepest.
[[gnu::noinline]] void HealthMonitor::compare_with_block(const Sample& sample, GateResult& gate) noexcept {
  const Readings y = readings_now(sample, gate);
  freshness_.compare(array_, in_service_, gate.usable, y, evidence_);
  compare_in_motion(y, gate.usable);
}

/// In slow motion one sensor may feel the whole of what the bound holds: the vector tells how much it is.
/// A liar can pull that vector back. So what the sensors depart by since the block has to be one movement, too: beyond
/// that no reading departs by more than its noise.
void HealthMonitor::compare_in_motion(const Readings& y, SensorSet usable) noexcept {
  if (!slow_motion_.slow() || !usable.contains(in_service_) || !map_.valid) return;
  freshness_.compare_vectors(verdict_.latest_mps2, verdict_.gravity_mps2);
  Readings away{};
  for (size_t a = 0; a < away.size(); ++a) away[a] = y[a] - evidence_.mean_mps2[a];
  const Vec3 moved = map_.estimate(away);
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    if (in_service_.has(i)) freshness_.compare_residual(i, away[a] - dot(array_.axis(i), moved));
  }
}

/// What a sample leads to that is not merely collected.
void HealthMonitor::serve(const Sample& sample, Arrival arrival, GateResult& gate) noexcept {
  if (arrival == Arrival::new_time_base) {
    have_evidence_ = false;  // its age cannot be told any more
    trend_.clear();
    temperature_rate_.clear();
  }
  if (arrival != Arrival::in_order || gate.gap) {
    count_up(counters_.gaps);
    verdict_.cause = Cause::gap;
    empty_windows();
    if (arrival != Arrival::in_order) freshness_.lapse();
    if (!gate.gap) collect_sample(sample, gate);
  }
  bool ticked = false;
  EventMask raised = reset_pending_ ? bit(HealthEvent::reset) : 0;
  if (!gate.gap) {
    ticked = block_.size() >= config_.window;
    if (ticked) {
      raised |= tick(sample);
      compare_with_block(sample, gate);
    }
    if (silence_.is_due(config_.window)) {
      const SensorSet silent = silence_.close(array_.size(), config_.missing_confirm);
      if (!silent.empty()) gate_.condemn(silent - absent_);
    }
    if (!((gate_.lost() & array_.all()) - absent_).empty()) raised |= bit(HealthEvent::channel_lost);
    if (!(gate_.back() & absent_).empty()) raised |= bit(HealthEvent::channel_back);
  }
  raised |= advance_recalibration(sample.time_s);
  raised = allowed(raised | pending_);
  const HealthEvent taken = raised != 0 ? decide(raised, sample.time_s) : HealthEvent::none;
  if (verdict_.transition.sequence == 0) give_notice(sample.time_s);
  const bool channel = taken == HealthEvent::channel_lost || taken == HealthEvent::channel_back;
  pending_ = channel || taken == HealthEvent::reset ? raised & kKeptEvents : 0;
  if (ticked || raised != 0 || arrival != Arrival::in_order || news()) {
    publish(sample, ticked);
  } else {
    publish_sample(sample);
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
