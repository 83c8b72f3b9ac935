// What single channels did in a block, as far as the others insist on it: noisy, stuck, at full scale.
#include <algorithm>
#include <cmath>

#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// A reading that repeats so often is worth a question to the others.
constexpr int kRepeats = 64;
/// The others must have predicted a change by this part of gravity while the reading stood still. A sensor whose
/// resolution is coarser than its noise repeats at rest, and over one code where that is known to be coarser still.
constexpr double kStuckShare = 0.02;
constexpr double kStuckCodes = 2.0;
/// A prediction below this part of the reading is inside the range by a margin: gravity alone reaches 1 / 1.05 of it.
constexpr double kInsideShare = 0.96;
/// A noisy channel is set aside after so many quiet blocks in a row, or after so many stations at each of which it
/// alone scattered in one block at least.
constexpr int kNoiseConfirm = 3;

}  // namespace

/// What the others in service predict that this one reads; NaN where they do not determine it.
double HealthMonitor::predicted(int sensor, const BlockEvidence& evidence) const noexcept {
  const LeastSquares others = least_squares(array_, (in_service_ & evidence.usable).without(sensor));
  return others.valid ? dot(array_.axis(sensor), others.estimate(evidence.mean_mps2)) : std::nan("");
}

SensorSet HealthMonitor::noise_confirmed() const noexcept {
  SensorSet out;
  for (int i = 0; i < array_.size(); ++i) {
    if (noisy_run_[static_cast<size_t>(i)] >= kNoiseConfirm) out = out.with(i);
  }
  const bool at_stations = episode_.by_scatter && episode_.agreeing.size() >= kNoiseConfirm;
  return at_stations && isolation_.parity_grade() >= 1 ? out | episode_.candidate : out;
}

void HealthMonitor::note_stuck(const BlockEvidence& evidence) noexcept {
  const int samples = config_.window > kRepeats ? config_.window : kRepeats;
  const SensorSet repeating = gate_.repeating(samples) & in_service_ & evidence.usable;
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    if (!repeating.has(i)) continue;
    const double now = predicted(i, evidence);
    if (!stuck_watch_.has(i)) {
      stuck_since_[a] = now;
      stuck_watch_ = stuck_watch_.with(i);
    } else if (std::fabs(now - stuck_since_[a]) >
               std::fmax(kStuckShare * gravity_.g_mps2, kStuckCodes * static_cast<double>(resolution_mps2_[a]))) {
      stuck_ = stuck_.with(i);
    }
  }
}

/// False where the block is no evidence: a channel was at full scale and the others do not deny it.
bool HealthMonitor::note_facts(const BlockJudgement& judged, bool moving) noexcept {
  stuck_watch_ = stuck_watch_ & gate_.unchanged();
  stuck_ = stuck_ & stuck_watch_;
  const SensorSet at_full_scale = gate_.clipped_beyond(0.0) & in_service_ & judged.evidence.usable;
  gate_.begin_block();
  if (moving) return false;
  noisy_ = judged.noisy;
  full_scale_ = SensorSet{};
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    noisy_run_[a] = judged.noisy_for_certain.has(i) ? static_cast<std::uint8_t>(std::min(noisy_run_[a] + 1, 255)) : 0;
    if (!at_full_scale.has(i)) continue;
    const double reading = std::fabs(judged.evidence.mean_mps2[a]);
    const double expected = std::fabs(predicted(i, judged.evidence));
    if (expected < kInsideShare * reading) {
      full_scale_ = full_scale_.with(i);
    } else if (expected >= kInsideShare * reading && !noisy_.has(i)) {
      return false;
    }
  }
  note_stuck(judged.evidence);
  gate_.count_facts(noisy_, stuck_, full_scale_);
  return true;
}

void HealthMonitor::name_causes(SensorSet named, Cause cause) noexcept {
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    if (named.has(i)) {
      // The fact says more than "a fault was isolated".
      sensor_cause_[a] = stuck_.has(i)                                     ? Cause::stuck
                         : full_scale_.has(i)                              ? Cause::clipped
                         : cause == Cause::isolated_fault && noisy_.has(i) ? Cause::noisy
                                                                           : cause;
    }
    if (in_service_.has(i)) {
      sensor_cause_[a] = noisy_.has(i)        ? Cause::noisy
                         : stuck_.has(i)      ? Cause::stuck
                         : full_scale_.has(i) ? Cause::clipped
                                              : Cause::none;
    }
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
