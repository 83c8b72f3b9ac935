// Storage that changed though nobody wrote to it: a flipped bit, a stray write. The state, the masks and what a host
// steers by are compared in every step; calibration, configuration and memory before anything is decided from them or
// written to them, and so at every block; what every sample changes is held by sums of its own.
#include "plumb/core/storage_map.hpp"
#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

bool HealthMonitor::core_holds() const noexcept {
  // No index may lead out of the object before the sum over all of it has been compared. The number of sensors stands
  // in three places; one write over all of them may leave them equal and beyond every index, so their range counts too.
  const int n = gate_.size();
  const bool fits = n >= 3 && n <= kCapacity && array_.size() == n && model_.size == n &&
                    mae_.fits(triple_count_of(n), config_.window) && block_.size() >= 0 &&
                    block_.size() < config_.window;
  return fits && folded(storage_sum<StoragePart::core>(*this)) == core_sum_;
}

[[gnu::noinline]] std::uint64_t HealthMonitor::steady_now() const noexcept {
  return storage_sum<StoragePart::steady>(*this);
}

/// Everything else, but for clocks, counters and what single channels did in the last samples: a flip in those costs a
/// block, or the sensor whose record it is.
bool HealthMonitor::steady_holds() const noexcept {
  return steady_now() == steady_sum_ && block_.holds() && raw_.holds() && mae_.holds() && near_holds() &&
         coefficients_.hold(model_);
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
  record.sequence = sequence_ + 1;
  record.time_s = sample.time_s;
  record.from = state_of(mode_);
  record.to = HealthState::failed;
  record.cause = Cause::memory;
  configured_ = false;
  core_sum_ = kNeverConfigured;
  verdict_ = Verdict{};
  verdict_.time_s = sample.time_s;
  verdict_.sample = counters_.samples;
  verdict_.state = HealthState::failed;
  verdict_.qualifiers = Qualifier::unproven;
  verdict_.cause = Cause::memory;
  verdict_.transition = record;
  return verdict_;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
