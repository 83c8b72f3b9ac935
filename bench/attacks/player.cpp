#include "player.hpp"

#include <cmath>
#include <cstdio>

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

namespace {

constexpr int kMostSettlingBlocks = 60;
/// A row of every sensor less than so many sigmas from the block does not show that the tool has turned (REQ-128).
constexpr double kUnseenSigmas = 13.0;
/// Without a complete row for so long nothing speaks of now, unless two blocks take longer.
constexpr double kMostSilence_s = 1.0;
constexpr std::uint16_t kClaims = Usable::vector | Usable::inclination | Usable::toolface | Usable::stationary;

bool says_usable(const Verdict& v) { return v.validity == Validity::valid || v.validity == Validity::degraded; }

std::string decimal(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

std::string names(SensorSet set) {
  std::string out;
  for (int i = 0; i < kCapacity; ++i) out += set.has(i) ? " a" + std::to_string(i + 1) : "";
  return out.empty() ? " nobody" : out;
}

}  // namespace

Player::Player(const AttackTool& tool, const MonitorConfig& config, std::uint64_t stream, bool tell,
               double resolution_mps2)
    : noise(stream), tool_(tool), tell_(tell) {
  setup_.array = tool.array();
  setup_.model.size = tool.n();
  setup_.gravity = tool.law.tool.gravity;
  setup_.config = config;
  for (int i = 0; i < tool.n(); ++i) setup_.resolution_raw[slot(i)] = resolution_mps2;
  step_mps2 = resolution_mps2;
  strict_ = std::max(0, tool.law.strict());
  parity_ = std::max(0, tool.law.parity());
  if (!monitor_->configure(setup_).has_value()) find(Count::broken, true, "the setup is refused");
}

void Player::state_stability(const Stability& stability) {
  setup_.stability.fill(stability);
  if (!monitor_->configure(setup_).has_value()) find(Count::broken, true, "the stability is refused");
}

Sample Player::next() {
  Sample out;
  out.time_s = time_s += period_s;
  out.temperature_degc = temperature_degc;
  out.delivered = setup_.array.all();
  const Vec3 felt = plus(scaled(direction, g_mps2), push_mps2);
  const double fresh = std::sqrt(1.0 - correlation * correlation);
  for (int i = 0; i < n(); ++i) {
    const double truth = dot(tool_.law.tool.row[slot(i)], felt) + tool_.law.tool.offset_mps2[slot(i)];
    double y = truth + shift_mps2[slot(i)];
    if (lie && faulty.has(i)) y = lie(i, y);
    slow_[slot(i)] = correlation * slow_[slot(i)] + fresh * noise.normal();
    y += noise_factor * setup_.array.sigma_mps2(i) * slow_[slot(i)];
    out.raw[slot(i)] = step_mps2 > 0.0 ? step_mps2 * std::nearbyint(y / step_mps2) : y;
  }
  return out;
}

const Verdict& Player::offer(const Sample& sample) {
  note_motion();
  monitor_->step(sample);
  note_data(sample);
  judge();
  if (++offered_ % static_cast<std::uint64_t>(window()) == 0) note_block();
  return verdict();
}

void Player::rest(int samples) {
  for (int k = 0; k < samples; ++k) offer(next());
}

void Player::turn_to(const Vec3& to, double rate_radps) {
  const Vec3 from = direction;
  const double angle = angle_between_rad(from, to);
  const int steps = static_cast<int>(std::ceil(angle / (rate_radps * period_s)));
  for (int k = 1; k < steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    const Vec3 between = plus(scaled(from, 1.0 - share), scaled(to, share));
    const double length = norm(between);
    if (length > 1e-3) direction = scaled(between, 1.0 / length);
    offer(next());
  }
  direction = to;
}

void Player::settle() {
  for (int k = 0; k < kMostSettlingBlocks && verdict().state != HealthState::nominal; ++k) {
    direction = noise.direction();
    block();
  }
}

void Player::power_cycle() {
  std::vector<std::uint8_t> bytes(HealthMonitor::snapshot_size_max());
  const Expected<std::size_t> size = monitor_->snapshot(bytes.data(), bytes.size());
  if (!size) return find(Count::broken, true, "no snapshot");
  auto other = std::make_unique<HealthMonitor>();
  if (!other->restore(setup_, bytes.data(), *size).has_value()) {
    return find(Count::broken, true, "its own snapshot is refused");
  }
  monitor_ = std::move(other);
}

void Player::note_motion() {
  still_ = direction == last_direction_ ? still_ + 1 : 1;
  last_direction_ = direction;
}

void Player::note_data(const Sample& sample) {
  const Verdict& v = verdict();
  refused_ = !(sample.time_s > last_time_s_);
  behind_gap_ = behind_gap_ || (last_time_s_ > -1e9 && sample.time_s - last_time_s_ > setup_.config.max_gap_s);
  bool full = v.accepted && !refused_ && sample.delivered.contains(v.in_service);
  for (int i = 0; i < n(); ++i) full = full && (!v.in_service.has(i) || std::isfinite(sample.raw[slot(i)]));
  if (!refused_) last_time_s_ = sample.time_s;
  dry_ = full ? 0 : dry_ + 1;
  if (full) last_full_s_ = sample.time_s;
  since_tick_ = v.tick ? 0 : since_tick_ + 1;
  if (v.tick) behind_gap_ = false;
}

void Player::note_block() {
  const Verdict& v = verdict();
  if (v.state == HealthState::nominal && nominal_after_ == 0) {
    nominal_after_ = offered_ / static_cast<std::uint64_t>(window());
  }
  if (!counting_) return;
  ++tally_[Count::blocks];
  if (v.validity == Validity::valid) ++tally_[Count::valid_blocks];
}

void Player::tell_change() const {
  const Verdict& v = verdict();
  if (!tell_ || v.transition.sequence == 0) return;
  std::printf("  t %.2f %s -> %s, event %s, cause %s, in service%s, excluded%s, provisionally excluded%s, absent%s\n",
              v.time_s, to_string(v.transition.from), to_string(v.transition.to), to_string(v.transition.event),
              to_string(v.transition.cause), names(v.in_service).c_str(), names(v.excluded).c_str(),
              names(v.provisionally_excluded).c_str(), names(v.absent).c_str());
}

void Player::find(Count what, bool promised, const std::string& how) {
  promised = promised || count_all;
  std::uint64_t& counted = tally_[promised ? what : Count::unpromised];
  if (counted != 0) return;
  counted = 1;
  if (!promised && !tell_) return;
  const std::string text = std::string(to_string(what)) + ", n = " + std::to_string(n()) + ", faulty" + names(faulty) +
                           ", t = " + decimal(time_s) + ": " + how;
  if (tell_) std::printf("  %s %s\n", promised ? "FOUND" : "not promised:", text.c_str());
  if (promised) findings_.push_back(text);
}

void Player::judge() {
  tell_change();
  judge_sensors();
  judge_claims();
  if (says_usable(verdict())) judge_vector();
}

void Player::judge_sensors() {
  const Verdict& v = verdict();
  if (!faulty.contains(v.excluded)) {
    find(Count::wrong_exclusion, faulty.size() <= strict_, "excluded" + names(v.excluded - faulty));
  }
  if (!faulty.contains(v.provisionally_excluded)) {
    find(Count::wrong_aside, faulty.size() <= parity_,
         "provisionally excluded" + names(v.provisionally_excluded - faulty));
  }
  if (v.state == HealthState::failed) {
    tally_[Count::failed] = 1;
    if (faulty.empty()) find(Count::failed_healthy, true, std::string("failed by ") + to_string(v.cause));
  }
  const TransitionRecord& t = v.transition;
  const bool doubts = t.sequence != 0 && t.from == HealthState::nominal && t.to == HealthState::suspect;
  if (doubts && faulty.empty()) tally_[Count::false_doubt] = 1;
  const SensorSet all = v.in_service | v.provisionally_excluded | v.excluded | v.absent;
  const int sum = v.in_service.size() + v.provisionally_excluded.size() + v.excluded.size() + v.absent.size();
  if (all != v.configured || sum != v.configured.size()) find(Count::broken, true, "the sets do not form a partition");
  if (!std::isfinite(v.protection_level_calibrated_axes_rad) || !std::isfinite(norm(v.gravity_mps2))) {
    find(Count::broken, true, "a figure is not finite");
  }
}

/// Without data nothing is claimed.
void Player::judge_claims() {
  const Verdict& v = verdict();
  const bool claims = says_usable(v) || (v.usable & kClaims) != 0 || !v.alert;
  if (!claims) return;
  const double silence_s = last_time_s_ - last_full_s_;
  const bool silent = dry_ >= static_cast<std::uint64_t>(setup_.config.missing_confirm) ||
                      (silence_s > kMostSilence_s && silence_s > 2.0 * window() * period_s);
  if (silent) find(Count::stale, true, "usable or no alert, and " + std::to_string(dry_) + " rows without data");
  if (refused_) find(Count::stale, true, "usable or no alert at a sample that was refused");
  if (behind_gap_) find(Count::stale, true, "usable or no alert behind a gap");
}

void Player::judge_vector() {
  const Verdict& v = verdict();
  const double error_rad = angle_between_rad(v.gravity_mps2, tool_.seen(direction));
  // At rest since before the block began, or in a motion that goes on, the bound alone; else what one row does not show
  // comes on top.
  const bool at_rest = steady_motion || still_ >= since_tick_ + static_cast<std::uint64_t>(window());
  const double sigma_mps2 = std::fmax(noise_factor, 1.0) * setup_.array.sigma_mps2(0) + step_mps2;
  const double unseen_rad = at_rest ? 0.0 : kUnseenSigmas * sigma_mps2 / kG0_mps2 * std::sqrt(n() / 3.0);
  const bool crowd = (v.in_service & faulty).size() > 1;
  const bool beyond_level = v.protection_available && error_rad > v.protection_level_calibrated_axes_rad + unseen_rad;
  const bool hazardous = !v.alert && error_rad > setup_.config.alert_limit_rad + unseen_rad;
  if (!beyond_level && !hazardous) return;
  const std::string said = "error " + decimal(deg_from_rad(error_rad)) + " deg, level " +
                           decimal(deg_from_rad(v.protection_level_calibrated_axes_rad)) + " deg" +
                           (v.alert ? ", alert" : "") + ", in service" + names(v.in_service);
  if (!at_rest) return find(Count::stale, !crowd, said);
  if (beyond_level) find(Count::beyond_level, !crowd, said);
  if (hazardous) find(Count::hazardous, !crowd, said);
}

Tally Player::finish() {
  Tally out = tally_;
  out[Count::episodes] = 1;
  out[Count::faulty] = faulty.empty() ? 0 : 1;
  out[Count::all_out] = !faulty.empty() && (verdict().in_service & faulty).empty() ? 1 : 0;
  const std::size_t last = kNominalBins - 1;
  const std::size_t bin =
      nominal_after_ == 0 || nominal_after_ > last ? last : static_cast<std::size_t>(nominal_after_);
  ++out.to_nominal[bin];
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
