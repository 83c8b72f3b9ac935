// Storage that changed though no code wrote to it: a flipped bit, a stray write. The state, the masks and what a host
// steers by are compared in every step; calibration, configuration and memory before anything is decided from them or
// written to them, and so at every block; what every sample changes is held by sums of its own.
#include "plumb/core/detail/storage_map.hpp"
#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

bool HealthMonitor::core_holds() const noexcept {
  // No index may lead out of the object before the sum over all of it has been compared. The number of sensors stands
  // in three places; one write over all of them may leave them equal and beyond every index, so their range counts too.
  const MonitorState& s = state_;
  const int n = s.intake.gate.size(), window = s.settings.config.window;
  const bool fits = n >= 3 && n <= kCapacity && s.in_force.array.size() == n && s.in_force.model.size == n &&
                    s.window.mae.fits(triple_count_of(n), window) && s.window.block.size() >= 0 &&
                    s.window.block.size() < window;
  return fits && folded(storage_sum<StoragePart::core>(*this)) == core_sum_;
}

[[gnu::noinline]] std::uint64_t HealthMonitor::steady_now() const noexcept {
  return storage_sum<StoragePart::steady>(*this);
}

/// Everything else, but for clocks, counters and what single channels did in the last samples: a flip in those costs a
/// block, or the sensor whose record it is.
bool HealthMonitor::steady_holds() const noexcept {
  return steady_now() == steady_sum_ && state_.window.holds() && state_.intake.coefficients.hold(state_.in_force.model);
}

/// A monitor that was never configured has a mark in place of the sum. Without that, one flipped bit would pass for it,
/// and what was published last would stand for ever; and the mark is not zero, as cleared storage would be.
bool HealthMonitor::whole() const noexcept {
  return (!configured_ && core_sum_ == kNeverConfigured) || (core_holds() && steady_holds());
}

void HealthMonitor::seal() noexcept {
  if (!configured_) return;
  core_sum_ = folded(storage_sum<StoragePart::core>(*this));
  steady_sum_ = steady_now();
}

/// Nothing of it can be believed any more, what it was configured with included: from here on it answers as a monitor
/// that was never configured, in `failed`, until it is configured or restored.
const Verdict& HealthMonitor::lose_memory(const Sample& sample) noexcept {
  TransitionRecord record;
  record.sequence = state_.requests.sequence + 1;
  record.time_s = sample.time_s;
  record.from = state_of(state_.machine.mode);
  record.to = HealthState::failed;
  record.cause = Cause::memory;
  configured_ = false;
  core_sum_ = kNeverConfigured;
  verdict_ = Verdict{};
  verdict_.time_s = sample.time_s;
  verdict_.sample = state_.counters.samples;
  verdict_.state = HealthState::failed;
  verdict_.qualifiers = Qualifier::not_yet_validated;
  verdict_.cause = Cause::memory;
  verdict_.transition = record;
  return verdict_;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
