#include "player.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace plumb_replay {
inline namespace PLUMB_ABI {

using namespace plumb;

namespace {

/// Blocks from snapshot to snapshot.
constexpr std::uint64_t kSnapshotEvery = 8;

Error error_of(const Expected<void>& answer) { return answer ? Error{} : answer.error(); }

}  // namespace

void perturb(Sample& sample) {
  for (int i = 0; i < kCapacity; ++i) {
    double& raw = sample.raw[static_cast<std::size_t>(i)];
    if (!sample.delivered.has(i) || !std::isfinite(raw)) continue;
    raw = std::nextafter(raw, std::numeric_limits<double>::infinity());
  }
}

void Meeting::note(Coverage& coverage, const Verdict& v) {
  if (first_ || v.state != last_.state) coverage.met("state", to_string(v.state));
  if (first_ || v.validity != last_.validity) coverage.met("validity", to_string(v.validity));
  if (first_ || v.cause != last_.cause) coverage.met("cause", to_string(v.cause));
  if (first_ || v.norm_mismatch.kind != last_.norm_mismatch.kind)
    coverage.met("reference", to_string(v.norm_mismatch.kind));
  if (first_ || v.recalibration.phase != last_.recalibration.phase) {
    coverage.met("recalibration", to_string(v.recalibration.phase));
  }
  for (int i = 0; i < kCapacity; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (first_ || v.sensor_cause[k] != last_.sensor_cause[k]) coverage.met("cause", to_string(v.sensor_cause[k]));
  }
  const TransitionRecord& record = v.transition;
  if (record.sequence != 0) {
    const std::string event = to_string(record.event);
    coverage.met("event", event);
    coverage.met("cause", to_string(record.cause));
    coverage.met("cell", std::string(to_string(record.from)) + "/" + event + "/" + to_string(record.to));
  }
  first_ = false;
  last_ = v;
}

Player::Player(const Stage& stage, const MonitorSetup& setup)
    : stage_(stage), setup_(std::make_unique<MonitorSetup>(setup)), bytes_(HealthMonitor::snapshot_size_max()) {
  stage_.trace.in(Part::inputs);
  tell_setup(stage_.trace, *setup_);
}

bool Player::configure() { return configure(*setup_); }

bool Player::configure(const MonitorSetup& setup) {
  const Expected<void> done = monitor_->configure(setup);
  answer("configure", done);
  tell_now();
  return done.has_value();
}

void Player::tell_now() {
  stage_.trace.in(Part::verdicts);
  tell_verdict(stage_.trace, monitor_->verdict(), setup_->array.size());
  meeting_.note(stage_.coverage, monitor_->verdict());
}

void Player::step(const Sample& sample) {
  Trace& trace = stage_.trace;
  const int n = setup_->array.size();
  trace.at(row_, sample.time_s);
  trace.in(Part::inputs);
  tell_sample(trace, sample, n);
  Sample given = sample;
  if (row_ == stage_.perturbed_row) perturb(given);
  const Verdict& v = monitor_->step(given);
  trace.in(Part::verdicts);
  tell_verdict(trace, v, n);
  if (v.transition.sequence != 0) {
    trace.in(Part::events);
    tell_record(trace, v.transition);
    tell_model(trace, monitor_->model(), monitor_->array());
  }
  meeting_.note(stage_.coverage, v);
  if (v.tick) ++ticks_;
  if (v.transition.sequence != 0 || (v.tick && ticks_ % kSnapshotEvery == 0)) tell_snapshot();
  ++row_;
}

void Player::answer(const char* request, const Expected<void>& answer) {
  stage_.trace.in(Part::answers);
  stage_.trace.word("request", request);
  stage_.trace.integer("row", row_);
  tell_error(stage_.trace, error_of(answer));
  const std::string said = answer ? "ok" : "error " + std::to_string(static_cast<int>(answer.error().code));
  stage_.coverage.met("answer", std::string(request) + " " + said);
}

void Player::reset(std::uint64_t key, SensorSet sensors) { answer("reset", monitor_->reset(key, sensors)); }
void Player::recalibrate() { answer("recalibrate", monitor_->request_recalibration()); }
void Player::offer(const SensorModel& model, const SensorArray& array) {
  answer("offer", monitor_->offer_calibration(model, array));
}
void Player::set_gravity(const GravityReference& gravity) { answer("gravity", monitor_->set_gravity(gravity)); }
void Player::set_rotation(const Rotation& rotation) { answer("rotation", monitor_->set_rotation(rotation)); }
void Player::inhibit(bool frozen) {
  monitor_->inhibit(frozen);
  answer(frozen ? "inhibit" : "release", {});
}

void Player::snapshot() {
  const Expected<std::size_t> written = monitor_->snapshot(bytes_.data(), bytes_.size());
  size_ = written ? *written : 0;
  if (!written) answer("snapshot", tl::unexpected<Error>(written.error()));
}

void Player::tell_snapshot() {
  snapshot();
  if (size_ < kSnapshotFrameSize) return;
  stage_.trace.in(Part::snapshots);
  if (stage_.tells_memory) tell_memory(stage_.trace, *monitor_);
  stage_.trace.bytes("snapshot", bytes_.data() + kSnapshotHeaderSize, size_ - kSnapshotFrameSize);
}

void Player::power_cycle() {
  snapshot();
  monitor_ = std::make_unique<HealthMonitor>();
  answer("restore", monitor_->restore(*setup_, bytes_.data(), size_));
  tell_now();
}

void Player::power_cycle(Damage damage) {
  snapshot();
  const auto setup = std::make_unique<MonitorSetup>(*setup_);
  std::vector<std::uint8_t> bytes(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
  const std::size_t middle = bytes.size() / 2;
  switch (damage) {
    case Damage::truncated: bytes.resize(middle); break;
    case Damage::flipped:
      if (!bytes.empty()) bytes[middle] ^= 0x10U;
      break;
    case Damage::foreign: setup->config.isolation_timeout += setup->config.isolation_timeout < 24 ? 1 : -1; break;
    case Damage::empty: bytes.clear(); break;
  }
  monitor_ = std::make_unique<HealthMonitor>();
  answer("restore", monitor_->restore(*setup, bytes.data(), bytes.size()));
  tell_now();
}

void Player::overwrite(unsigned char byte) {
  static_assert(std::is_trivially_copyable_v<HealthMonitor>);
  std::memset(static_cast<void*>(monitor_.get()), byte, sizeof(HealthMonitor));
  answer("overwrite", {});
}

void Player::finish() {
  tell_snapshot();
  stage_.trace.in(Part::verdicts);
  tell_counters(stage_.trace, monitor_->counters());
  tell_model(stage_.trace, monitor_->model(), monitor_->array());
}

}  // namespace PLUMB_ABI
}  // namespace plumb_replay
