#include "lies_episode.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

namespace {

constexpr int kNobody = kAttackLies - 1;
constexpr double kGravitySigmas = 3.0 + 1e-6;

Lie lie_of(int lie) { return lie == kNobody ? Lie::constant : kEveryLie[slot(lie)]; }

/// Liars of a tool within the confirmed grade that the monitor claims for it.
SensorSet draw_liars(const LawTool& tool, int lie, TrialNoise& noise) {
  if (lie == kNobody) return {};
  return LawCase::some(tool.n(), 1 + noise.below(confirmed_grade(tool.tool.array, tool.tool.array.all())), noise);
}

double draw_gravity(TrialNoise& noise) { return noise.below(3) == 0 ? 3.0 * noise.sign() : noise.between(-3.0, 3.0); }

std::string decimal(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

}  // namespace

LiesEpisode::LiesEpisode(const AttackTool& tool, Situation situation, int lie, std::uint64_t seed, std::uint64_t number,
                         bool tell)
    : tool_(tool),
      situation_(situation),
      lie_(lie),
      number_(number),
      tell_(tell),
      noise_(stream_of(static_cast<int>(1000 + seed % 1000000), number)),
      gravity_sigmas_(draw_gravity(noise_)),
      case_(tool.law.tool, draw_liars(tool.law, lie, noise_), lie_of(lie), gravity_sigmas_),
      attitudes_(noise_) {
  liars_ = case_.faulty();
  const SensorArray& array = tool.law.tool.array;
  strict_ = confirmed_grade(array, array.all());
  parity_ = provisional_grade(array, array.all());
  case_.draw(noise_);
  plan();
  configure();
}

void LiesEpisode::plan() {
  stations_ = 16 + noise_.below(14);
  onset_ = noise_.below(4) == 0 ? 0 : 4 + noise_.below(8);
  if (situation_ == Situation::reinstate) {
    stations_ += 20;
    pause_ = onset_ + 5 + noise_.below(8);
    resume_ = pause_ + 7 + noise_.below(14);
  }
  mid_block_ = noise_.below(3) == 0;
  follows_motion_ = noise_.below(2) == 0;
}

void LiesEpisode::configure() {
  const TrialTool& tool = tool_.law.tool;
  setup_.array = tool.array;
  setup_.model.size = tool_.law.n();
  setup_.gravity = tool.gravity;
  MonitorConfig& config = setup_.config;
  const int kWindows[] = {4, 8, 8, 16};
  config.window = kWindows[noise_.below(4)];
  config.isolation_stations = noise_.below(2) == 0 ? 4 : 1 + noise_.below(3);
  if (liars_.size() <= 1 && noise_.below(4) == 0) config.assumed_faults = 1;
  config.recalibrate_after_exclusion = situation_ == Situation::recalibrate && noise_.below(2) == 0;
  if (noise_.below(4) == 0) setup_.stability.fill({0.1 * kMilligee_mps2, 0.0, 0.0, 0.0});
  if (noise_.below(4) == 0) config.isolation_timeout_blocks = 6 + noise_.below(30);
  if (noise_.below(4) == 0) config.probation_stations = 1 + noise_.below(3);
  if (!monitor_->configure(setup_).has_value()) ++count_.broken;
}

bool LiesEpisode::lies_at(int station, bool second_half) const {
  const int begins = mid_block_ && !second_half ? onset_ + 1 : onset_;
  if (station < begins) return false;
  return pause_ == 0 || station < pause_ || station >= resume_;
}

void LiesEpisode::offer() {
  SensorModel model = monitor_->model();
  SensorArray array = setup_.array;
  RowUncertainty claimed;
  const double sure_mps2 = noise_.log_between(1e-5, 3e-3), sure_rad = noise_.log_between(1e-6, 3e-4);
  for (int a = 0; a < 4 * array.size(); ++a) {
    const double sigma = a % 4 == 3 ? sure_mps2 : sure_rad;
    claimed.covariance[slot(a * (a + 1) / 2 + a)] = sigma * sigma;
  }
  const int way = noise_.below(4);
  const Vec3 shared = scaled(noise_.direction(), noise_.log_between(1e-5, 1e-2) * kG0_mps2);
  const int one = noise_.below(array.size());
  const double common = noise_.sign() * noise_.log_between(1e-5, 1e-2);
  for (int i = 0; i < array.size(); ++i) {
    SensorCoefficients& c = model.sensor[slot(i)];
    if (way == 0) c.bias[0] += dot(array.axis(i), shared);  // one vector too many
    if (way == 1 && i == one) c.bias[0] += noise_.sign() * noise_.log_between(1e-5, 1e-2) * kG0_mps2;
    if (way == 2) c.scale[0] *= 1.0 + common;                      // all too long
    if (way == 3) c.bias[0] += noise_.normal() * 1e-4 * kG0_mps2;  // a bad laboratory
  }
  array.set_uncertainty(claimed);
  static_cast<void>(monitor_->offer_calibration(model, array));
}

void LiesEpisode::power_cycle() {
  std::vector<std::uint8_t> bytes(HealthMonitor::snapshot_size_max());
  const Expected<std::size_t> size = monitor_->snapshot(bytes.data(), bytes.size());
  if (!size) return find(count_.broken, "no snapshot");
  auto other = std::make_unique<HealthMonitor>();
  if (!other->restore(setup_, bytes.data(), *size).has_value()) return find(count_.broken, "the snapshot is refused");
  monitor_ = std::move(other);
}

void LiesEpisode::reset_if_failed() {
  if (monitor_->verdict().state != HealthState::failed || noise_.below(2) == 0) return;
  const SensorSet all = monitor_->array().all();
  SensorSet back = all;
  if (noise_.below(2) == 0) back = all - LawCase::some(all.size(), 1, noise_);
  static_cast<void>(monitor_->reset(setup_.config.reset_key, back));
}

void LiesEpisode::host_before(int station) {
  switch (situation_) {
    case Situation::plain:
    case Situation::motion:
    case Situation::reinstate:
    case Situation::timing: break;
    case Situation::recalibrate:
      if (noise_.below(4) == 0) static_cast<void>(monitor_->request_recalibration());
      break;
    case Situation::offer:
      if (noise_.below(4) == 0) offer();
      break;
    case Situation::reset: reset_if_failed(); break;
    case Situation::host:
      if (noise_.below(6) == 0) monitor_->inhibit(noise_.below(3) == 0);
      if (noise_.below(8) == 0) {
        // The same error, told again: what the reference may be off by is one figure of the place.
        GravityReference told = setup_.gravity;
        told.sigma_mps2 *= noise_.between(1.0, 2.0);
        static_cast<void>(monitor_->set_gravity(told));
      }
      if (noise_.below(6) == 0) power_cycle();
      reset_if_failed();
      break;
  }
  if (tell_) std::printf("station %d\n", station);
}

void LiesEpisode::shake(Readings& y, const Vec3& along, double rms_mps2) {
  pushed_mps2_ = plus(pushed_mps2_, scaled(along, rms_mps2));
  for (int i = 0; i < tool_.law.n(); ++i) {
    if (liars_.has(i) && !follows_motion_) continue;
    y[slot(i)] += rms_mps2 * dot(tool_.law.tool.row[slot(i)], along);
  }
}

void LiesEpisode::visit(int station) {
  direction_ = attitudes_.next(noise_);
  const Readings still = case_.healthy_readings(direction_);
  const Readings lied = case_.readings(direction_, noise_);
  steady_rows_ = 0;
  pushed_mps2_ = {};
  time_s_ += noise_.below(20) == 0 ? 10.0 : 1.0;
  const int window = setup_.config.window;
  const int rows = (1 + noise_.below(3)) * window;
  const int lurch = situation_ == Situation::motion ? noise_.below(4) : 0;
  const double rms = noise_.log_between(1e-4, 1.0) * kG0_mps2;
  const Vec3 line = noise_.direction();
  const int jolt = noise_.below(rows);
  if (tell_ && lurch > 0) {
    constexpr const char* kWays[] = {"", "vibration", "sway", "jolt"};
    std::printf("  %s of %.3g sigma, window %d, liars %s\n", kWays[lurch], rms / kTrialSigma_mps2, window,
                follows_motion_ ? "follow it" : "do not follow it");
  }
  for (int k = 0; k < rows; ++k) {
    Sample sample;
    sample.time_s = time_s_ += 0.01;
    sample.temperature_degc = 25.0;
    sample.delivered = setup_.array.all();
    Readings y = lies_at(station, k >= rows / 2) ? lied : still;
    if (lurch == 1) shake(y, noise_.direction(), rms * noise_.normal());
    if (lurch == 2) shake(y, line, rms * std::sin(0.7 * k));
    if (lurch == 3 && k == jolt) shake(y, line, rms);
    for (int i = 0; i < tool_.law.n(); ++i) {
      sample.raw[slot(i)] = y[slot(i)] + setup_.array.sigma_mps2(i) * noise_.normal();
    }
    disturb_and_send(sample);
    if ((k + 1) % window == 0) {
      pushed_mps2_ = {};  // a block that passed for motion is none the less over
      note_availability();
    }
  }
}

void LiesEpisode::note_availability() {
  const Verdict& v = monitor_->verdict();
  ++count_.blocks;
  if (v.validity == Validity::valid) ++count_.valid_blocks;
  if (v.state == HealthState::nominal && count_.blocks_to_nominal == kNeverNominal) {
    count_.blocks_to_nominal = count_.blocks;
  }
}

void LiesEpisode::disturb_and_send(Sample& sample) {
  if (situation_ != Situation::timing) return send(sample);
  const int trouble = noise_.below(60);
  const int n = tool_.law.n();
  if (trouble == 0) return;        // lost
  if (trouble == 1) send(sample);  // twice
  if (trouble == 2) sample.time_s -= noise_.log_between(0.005, 100.0);
  if (trouble == 3) time_s_ += noise_.log_between(0.01, 30.0);
  if (trouble == 4) sample.temperature_degc = std::numeric_limits<double>::quiet_NaN();
  if (trouble == 5 && silent_rows_ == 0) {
    // One channel of the tool at a time, and always the same one, so that what is left can still check itself.
    if (silent_ < 0) silent_ = noise_.below(n);
    silent_rows_ = 1 + noise_.below(4);
  }
  if (silent_rows_ > 0) {
    --silent_rows_;
    constexpr double kNone[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(), 1e300};
    const int none = noise_.below(5);
    if (none < 4) sample.raw[slot(silent_)] = kNone[none];
    if (none == 4) sample.delivered = sample.delivered.without(silent_);
  }
  send(sample);
}

void LiesEpisode::send(Sample& sample) {
  monitor_->step(sample);
  judge();
}

void LiesEpisode::find(std::uint64_t& counter, const std::string& what) {
  if (!within_bounds_ && &counter != &count_.broken) {
    ++count_.beyond_bounds;
    return;
  }
  if (++counter > 1) return;
  const bool promised = &counter != &count_.crowd_beyond_level && &counter != &count_.crowd_beyond_alert;
  if (!promised && !tell_) return;
  const LawTool& law = tool_.law;
  std::string text = "episode " + std::to_string(number_) + ", n = " + std::to_string(law.n()) +
                     ", c = " + std::to_string(law.plane) + ", " + name(situation_) + ", " + name_of_lie(lie_) +
                     ", liars";
  for (int i = 0; i < law.n(); ++i) text += liars_.has(i) ? " a" + std::to_string(i + 1) : "";
  text += ", hidden " + decimal(hidden_sigmas_) + ", gravity " + decimal(gravity_sigmas_) + " sigma, geometry " +
          std::to_string(static_cast<int>(law.geometry)) + ", calibration " +
          std::to_string(static_cast<int>(law.knowledge)) + ", t = " + decimal(monitor_->verdict().time_s) + ": " +
          what;
  finds_->push_back(text);
  if (tell_) std::printf("FOUND %s\n", text.c_str());
}

void LiesEpisode::judge() {
  const Verdict& v = monitor_->verdict();
  if (v.accepted) ++steady_rows_;
  if (v.tick) note_bounds();  // before anything is held against the block
  if (tell_ && v.transition.sequence != 0) {
    std::printf("  t %.2f %s -> %s, event %s, cause %s, excluded %x, provisionally excluded %x, absent %x\n", v.time_s,
                to_string(v.transition.from), to_string(v.transition.to), to_string(v.transition.event),
                to_string(v.transition.cause), v.excluded.bits, v.provisionally_excluded.bits, v.absent.bits);
  }
  const TransitionRecord& t = v.transition;
  const bool doubts = t.sequence != 0 && t.from == HealthState::nominal && t.to == HealthState::suspect;
  if (doubts && liars_.empty()) count_.false_doubts = 1;
  // A silenced channel is broken as far as anybody can tell.
  const SensorSet broken = silent_ >= 0 ? liars_.with(silent_) : liars_;
  if (broken.size() <= strict_ && !broken.contains(v.excluded))
    find(count_.excluded_healthy, "a healthy sensor is out");
  if (broken.size() <= parity_ && !broken.contains(v.provisionally_excluded)) {
    find(count_.set_aside_healthy, "a healthy sensor is provisionally excluded");
  }
  if (v.state == HealthState::failed) {
    if (count_.failed == 0) ++count_.failed;
    if (liars_.empty()) find(count_.failed_healthy, std::string("failed by ") + to_string(v.cause));
  }
  const SensorSet all = v.in_service | v.provisionally_excluded | v.excluded | v.absent;
  const int sum = v.in_service.size() + v.provisionally_excluded.size() + v.excluded.size() + v.absent.size();
  if (all != v.configured || sum != v.configured.size()) find(count_.broken, "the sets do not form a partition");
  if (v.tick) judge_vector();
}

void LiesEpisode::note_bounds() {
  const Verdict& v = monitor_->verdict();
  // What the block's mean was pushed by makes gravity look longer, as far as anybody at rest can tell.
  const Vec3 push = scaled(pushed_mps2_, 1.0 / setup_.config.window);
  const double length = norm(plus(scaled(direction_, kG0_mps2), push)) - kG0_mps2;
  const double sigmas = gravity_sigmas_ + length / tool_.law.tool.gravity.sigma_mps2;
  if (std::fabs(sigmas) > std::fabs(hidden_sigmas_)) hidden_sigmas_ = sigmas;
  // Motion below the noise of every healthy channel is an error of gravity that nobody can see, and beyond the bound on
  // it: what one liar's channel shows alone may be its own noise.
  const bool seen = !(v.scattering - liars_).empty();
  within_bounds_ = within_bounds_ && (seen || std::fabs(sigmas) <= kGravitySigmas);
  if (tell_ && length != 0.0) {
    std::printf("    quiet block, gravity as if %.3g sigma off, scattering %x\n", sigmas, v.scattering.bits);
  }
}

void LiesEpisode::judge_vector() {
  const Verdict& v = monitor_->verdict();
  if (!std::isfinite(v.protection_level_calibrated_axes_rad) || !std::isfinite(norm(v.gravity_mps2))) {
    return find(count_.broken, "a figure is not finite");
  }
  const bool usable = v.validity == Validity::valid || v.validity == Validity::degraded;
  if (!usable) return;
  if (v.validity != Validity::valid || steady_rows_ < setup_.config.window) return;
  const double error_rad = angle_between_rad(v.gravity_mps2, tool_.seen(direction_));
  const bool crowd = (v.in_service & liars_).size() > 1;
  const std::string said = "error " + decimal(error_rad) + " rad, level " +
                           decimal(v.protection_level_calibrated_axes_rad) + (v.alert ? ", alert" : "") +
                           ", in service " + std::to_string(v.in_service.size());
  if (v.protection_available && error_rad > v.protection_level_calibrated_axes_rad) {
    find(crowd ? count_.crowd_beyond_level : count_.beyond_level, said);
  }
  if (!v.alert && error_rad > setup_.config.alert_limit_rad) {
    find(crowd ? count_.crowd_beyond_alert : count_.beyond_alert, said);
  }
}

LiesCount LiesEpisode::play(std::vector<std::string>& finds) {
  finds_ = &finds;
  for (int station = 0; station < stations_; ++station) {
    host_before(station);
    visit(station);
  }
  // Each of these happened in this episode or did not.
  for (std::uint64_t* c : {&count_.excluded_healthy, &count_.set_aside_healthy, &count_.beyond_level,
                           &count_.beyond_alert, &count_.failed_healthy, &count_.broken, &count_.crowd_beyond_level,
                           &count_.crowd_beyond_alert, &count_.beyond_bounds}) {
    if (*c > 1) *c = 1;
  }
  count_.liars = liars_.empty() ? 0 : 1;
  count_.all_out = !liars_.empty() && (monitor_->verdict().in_service & liars_).empty() ? 1 : 0;
  return count_;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
