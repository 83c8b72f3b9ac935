// The flow of one step of paper mode: admit, gate, keep, judge, decide, publish.
#include "plumb/paper/paper_monitor.hpp"

#include <cmath>
#include <type_traits>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

static_assert(std::is_trivially_copyable<PaperMonitor>::value, "a copy is an assignment");
static_assert(noexcept(std::declval<PaperMonitor&>().step(std::declval<const Sample&>())));

namespace {

/// As in HealthMonitor: output beyond the calibrated span by more than this is unconfirmed.
constexpr double kTemperatureMargin_degc = 5.0;
constexpr double kRestlessRate = 1e-6;

Expected<void> check_fits(const PaperSetup& setup) noexcept {
  const int n = setup.base.array.size();
  const PaperCalibration& fits = setup.paper;
  if (n > kPaperCapacity) return fail(Errc::too_many_sensors, -1, n, kPaperCapacity);
  if (setup.datasheet.size != n) return fail(Errc::not_calibrated, -1, setup.datasheet.size, n);
  if (fits.all.used != setup.base.array.all() || fits.triples != triple_count_of(n))
    return fail(Errc::not_calibrated, -1, fits.all.used.size(), n);
  for (int k = 0; k < fits.triples; ++k) {
    const SensorSet used = fits.triple[static_cast<size_t>(k)].used;
    if (used != setup.base.array.triple(k).set()) return fail(Errc::not_calibrated, -1, used.size(), 3);
  }
  if (!fits.all.sound()) return fail(Errc::not_calibrated, 0, fits.all.rank, kPaperRank);
  return {};
}

}  // namespace

Expected<void> PaperMonitor::configure(const PaperSetup& setup) noexcept {
  configured_ = false;
  verdict_ = Verdict{};
  const Expected<MonitorConfig> config = checked(setup.base.config);
  if (!config) return tl::unexpected<Error>(config.error());
  if (config->mode != MonitorMode::paper) return fail(Errc::wrong_mode, 0);
  const Expected<void> sound = checked(setup.base);
  if (!sound) return sound;
  const Expected<void> fitted = check_fits(setup);
  if (!fitted) return fitted;
  const Expected<SensorArray> nominal = setup.datasheet.array();
  if (!nominal) return tl::unexpected<Error>(nominal.error());

  config_ = setup.base.config;
  model_ = setup.base.model;
  array_ = setup.base.array;
  nominal_ = *nominal;
  datasheet_ = setup.datasheet;
  calibration_ = setup.paper;
  gravity_ = setup.base.gravity;
  frame_ = setup.base.output_frame;
  const int n = array_.size();
  limits_ = TestLimits::from_rates(n, config_.false_alarm_rate, config_.rejection_rate);
  restless_factor_ = scatter_factor(n, config_.window, kRestlessRate);
  delta_f_mps2_ = config_.delta_f_mps2 > 0.0 ? config_.delta_f_mps2 : kPaperDeltaF_mps2;
  gate_.configure(n, setup.base.full_scale_raw, config_.missing_confirm);
  power_on();
  return {};
}

void PaperMonitor::power_on() noexcept {
  mode_ = Mode::suspect;
  in_service_ = array_.all();
  excluded_ = absent_ = clipped_ = not_finite_ = accused_ = refused_ = reset_sensors_ = SensorSet{};
  not_yet_validated_ = true;
  timed_out_ = moving_ = temperature_out_ = have_evidence_ = reset_pending_ = false;
  evidence_time_s_ = 0.0;
  last_temperature_degc_ = 25.0;
  clock_.clear();
  silence_.clear();
  pending_ = 0;
  sequence_ = 0;
  empty_block();
  mean_ = Kept{};
  mean_samples_ = 0.0;
  vector_mps2_ = attitude_mps2_ = Vec3{};
  rest_ = candidate_ = PaperFit{};
  finding_ = PaperFinding{};
  clean_.clear();
  clean_run_ = 0;
  forget_episode();
  size_class_ = classify();
  configured_ = true;
  publish(Sample{}, false);  // a verdict asked for before the first sample already names the sensors
}

Expected<void> PaperMonitor::reset(std::uint64_t key, SensorSet sensors) noexcept {
  if (key != config_.reset_key) return fail(Errc::wrong_key);
  reset_pending_ = true;
  reset_sensors_ = sensors & array_.all();
  return {};
}

Expected<void> PaperMonitor::set_gravity(const GravityReference& gravity) noexcept {
  const Expected<void> sound = plausible(gravity);
  if (!sound) return sound;
  gravity_ = gravity;
  restart_pool();  // errors against two gravities do not add up; stations of a fit neither
  return {};
}

std::array<double, kCapacity> PaperMonitor::raw_of(const Kept& kept) const noexcept {
  std::array<double, kCapacity> raw{};
  for (size_t i = 0; i < kept.raw.size(); ++i) raw[i] = kept.raw[i];
  return raw;
}

void PaperMonitor::empty_block() noexcept {
  block_.clear();
  kept_count_ = 0;
}

/// The sample is refused and the windows stay as they are; what was valid is now only held.
void PaperMonitor::refuse_time(const Sample& sample) noexcept {
  verdict_.cause = Cause::time_fault;
  if (verdict_.validity != Validity::invalid) verdict_.validity = Validity::held;
  verdict_.alert = true;
  if (!reset_pending_) return;
  decide(bit(HealthEvent::reset), clock_.last_s());  // the host's key is served whatever the clock does
  publish(sample, false);
  verdict_.cause = Cause::time_fault;
}

void PaperMonitor::collect(const Sample& sample, GateResult& gate) noexcept {
  const Readings y = readings_of(model_, sample, last_temperature_degc_, gate);
  const bool first = block_.size() == 0;
  clipped_ = first ? gate.clipped : clipped_ | gate.clipped;
  not_finite_ = first ? gate.not_finite : not_finite_ | gate.not_finite;
  const double t = sample.temperature_degc;
  const bool outside = !(t >= config_.temperature_min_degc - kTemperatureMargin_degc &&
                         t <= config_.temperature_max_degc + kTemperatureMargin_degc);
  temperature_out_ = first ? outside : temperature_out_ || outside;  // one hot sample taints its block
  if (std::isfinite(t)) last_temperature_degc_ = t;
  block_.add(y, gate.usable, sample.count > 0 ? sample.count : 1);
  verdict_.accepted = true;
  if (!gate.usable.contains(in_service_)) return;
  Kept& kept = kept_[static_cast<size_t>(kept_count_++)];
  kept = Kept{};
  kept.temperature_degc = last_temperature_degc_;
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double reach = kReadingClamp_mps2 * std::fabs(model_.scale_at(i, last_temperature_degc_));
    kept.raw[a] = std::fmin(std::fmax(sample.raw[a], -reach), reach);
  }
  // Step 2, for this one sample.
  const Vec3 x = paper_vector_in_use(fits(), raw_of(kept), kept.temperature_degc, in_service_);
  if (std::isfinite(norm(x))) verdict_.latest_mps2 = times(frame_, x);
}

const Verdict& PaperMonitor::step(const Sample& sample) noexcept {
  verdict_.transition = TransitionRecord{};
  verdict_.tick = false;
  verdict_.accepted = false;
  if (!configured_) return verdict_;
  verdict_.time_s = sample.time_s;
  const Arrival arrival = clock_.admit(sample.time_s, config_.max_gap_s);
  if (arrival == Arrival::refused) {
    refuse_time(sample);
    return verdict_;
  }
  if (arrival == Arrival::new_time_base) have_evidence_ = false;  // its age is no longer known
  GateResult gate = gate_.gate(sample);
  if (arrival != Arrival::in_order || gate.gap) {
    verdict_.cause = Cause::gap;
    empty_block();
  }
  bool ticked = false;
  EventMask raised = reset_pending_ ? bit(HealthEvent::reset) : 0;
  if (!gate.gap) {
    collect(sample, gate);
    ticked = block_.size() >= config_.window;
    if (ticked) raised |= tick(sample);
    if (!((gate_.lost() & array_.all()) - absent_).empty()) raised |= bit(HealthEvent::channel_lost);
    if (!(gate_.back() & absent_).empty()) raised |= bit(HealthEvent::channel_back);
  }
  // What a block said is a level: a channel event that ranks before it must not make it unsaid.
  constexpr EventMask kKept = bit(HealthEvent::alarm) | bit(HealthEvent::no_consistent_hypothesis);
  raised |= pending_;
  const HealthEvent taken = decide(raised, sample.time_s);
  const bool channel = taken == HealthEvent::channel_lost || taken == HealthEvent::channel_back;
  pending_ = channel || taken == HealthEvent::reset ? raised & kKept : 0;
  publish(sample, ticked);
  return verdict_;
}

Validity PaperMonitor::validity() const noexcept {
  if (mode_ == Mode::failed || !have_evidence_) return Validity::invalid;
  constexpr double kMostAge_s = 60.0;  // the paper sets none
  const double most_s = config_.max_age_s > 0.0 ? config_.max_age_s : kMostAge_s;
  if (moving_ || clock_.last_s() - evidence_time_s_ > most_s) return Validity::held;
  if (mode_ == Mode::suspect || mode_ == Mode::recalibrating || temperature_out_) return Validity::unconfirmed;
  return mode_ == Mode::degraded ? Validity::degraded : Validity::valid;
}

void PaperMonitor::publish(const Sample& sample, bool ticked) noexcept {
  Verdict& v = verdict_;
  v.time_s = sample.time_s;
  v.tick = ticked && !moving_;
  v.block_fill = block_.size();
  v.state = state_of(mode_);
  // The paper's method takes the length for gravity's and the calibration for true whatever the host allows for.
  v.qualifiers = static_cast<std::uint16_t>(
      Qualifier::standstill_assumed | Qualifier::stability_unstated | Qualifier::uncertainty_unstated |
      Qualifier::alignment_unstated | (not_yet_validated_ ? Qualifier::not_yet_validated : 0) |
      (moving_ ? Qualifier::moving : 0) | (timed_out_ ? Qualifier::timed_out : 0) |
      (size_class_ == SizeClass::critical ? Qualifier::no_redundancy : 0));
  v.configured = array_.all();
  v.in_service = in_service_;
  v.excluded = excluded_;
  v.absent = absent_;
  v.clipped = clipped_;
  v.not_finite = not_finite_;
  v.suspects = episode_open_ ? in_service_ : SensorSet{};  // the gate suspects all alike
  v.minimum_faults.fill(kNoHypothesis);                    // the paper counts no faults
  v.stations_on_record = alarmed_.size();
  v.wants_rotation =
      mode_ == Mode::recalibrating || (mode_ == Mode::suspect && (not_yet_validated_ || pool_.samples() > 0));
  v.validity = validity();
  v.age_s = have_evidence_ ? clock_.last_s() - evidence_time_s_ : 0.0;
  v.alert = true;  // the paper bounds no error
}

}  // namespace PLUMB_ABI
}  // namespace plumb
