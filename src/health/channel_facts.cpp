#include "plumb/health/detail/channel_facts.hpp"

#include <algorithm>
#include <cmath>

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

/// What the others in service predict that this one reads; NaN where they do not determine it.
double predicted(const ChannelFacts::Terms& terms, int sensor, const BlockEvidence& evidence) noexcept {
  const LeastSquares others = least_squares(terms.array, (terms.in_service & evidence.usable).without(sensor));
  return others.valid ? dot(terms.array.axis(sensor), others.estimate(evidence.mean_mps2)) : std::nan("");
}

}  // namespace

SensorSet ChannelFacts::noisy_for(int blocks) const noexcept {
  SensorSet out;
  for (int i = 0; i < kCapacity; ++i) {
    if (noisy_run_[static_cast<size_t>(i)] >= blocks) out = out.with(i);
  }
  return out;
}

void ChannelFacts::note_stuck(const Terms& terms, const BlockEvidence& evidence, SensorSet repeating) noexcept {
  const SensorSet asked = repeating & terms.in_service & evidence.usable;
  for (int i = 0; i < terms.array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    if (!asked.has(i)) continue;
    const double now = predicted(terms, i, evidence);
    if (!std::isfinite(now)) continue;  // the others do not determine it in this block
    if (!stuck_watch_.has(i)) {
      stuck_since_[a] = now;
      stuck_watch_ = stuck_watch_.with(i);
    } else if (std::fabs(now - stuck_since_[a]) >
               std::fmax(kStuckShare * terms.gravity.g_mps2,
                         kStuckCodes * static_cast<double>(terms.resolution_mps2[a]))) {
      stuck_ = stuck_.with(i);
    }
  }
}

bool ChannelFacts::note(const Terms& terms, const BlockJudgement& judged, ChannelMonitor& gate, bool moving) noexcept {
  stuck_watch_ = stuck_watch_ & gate.unchanged();
  stuck_ = stuck_ & stuck_watch_;
  const SensorSet at_full_scale = gate.clipped_beyond(0.0) & terms.in_service & judged.evidence.usable;
  gate.begin_block();
  if (moving) return false;
  noisy_ = judged.noisy;
  full_scale_ = SensorSet{};
  for (int i = 0; i < terms.array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    noisy_run_[a] = judged.noisy_for_certain.has(i) ? static_cast<std::uint8_t>(std::min(noisy_run_[a] + 1, 255)) : 0;
    if (!at_full_scale.has(i)) continue;
    const double reading = std::fabs(judged.evidence.mean_mps2[a]);
    const double expected = std::fabs(predicted(terms, i, judged.evidence));
    if (expected < kInsideShare * reading) {
      full_scale_ = full_scale_.with(i);
    } else if (expected >= kInsideShare * reading && !noisy_.has(i)) {
      return false;
    }
  }
  note_stuck(terms, judged.evidence, gate.repeating(std::max(terms.window, kRepeats)));
  gate.count_facts(noisy_, stuck_, full_scale_);
  return true;
}

void ChannelFacts::name_causes(SensorSet named, Cause cause, SensorSet in_service) noexcept {
  for (int i = 0; i < kCapacity; ++i) {
    const auto a = static_cast<size_t>(i);
    if (named.has(i)) {
      // The fact says more than "a fault was isolated".
      cause_[a] = stuck_.has(i)                                     ? Cause::stuck
                  : full_scale_.has(i)                              ? Cause::clipped
                  : cause == Cause::isolated_fault && noisy_.has(i) ? Cause::noisy
                                                                    : cause;
    }
    if (in_service.has(i)) {
      cause_[a] = noisy_.has(i)        ? Cause::noisy
                  : stuck_.has(i)      ? Cause::stuck
                  : full_scale_.has(i) ? Cause::clipped
                                       : Cause::none;
    }
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
