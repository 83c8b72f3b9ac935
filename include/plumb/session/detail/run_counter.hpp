/// Counts over a run what its verdicts do not hold (private to this module).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "plumb/health/health_monitor.hpp"
#include "plumb/session/stepper.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace stepping_detail {

/// The block at hand, row by row; what it amounts to goes into `RunCounts` where it ends.
class RunCounter {
 public:
  /// Counts go on from those of the monitor, which may have a roll test behind it.
  void begin(const HealthMonitor& monitor, int sensors, stepping::RunCounts& counts) {
    counts = stepping::RunCounts{};
    counts.known = true;
    counts.sensor.resize(static_cast<std::size_t>(sensors));
    block_.assign(static_cast<std::size_t>(sensors), {});
    moving_ = moving_of(monitor);
    for (std::size_t i = 0; i < block_.size(); ++i) block_[i].full_scale = full_scale_of(monitor, i);
    rows_ = 0;
  }

  /// After `step`; `raw` is the row that it was given.
  void add(const HealthMonitor& monitor, const Verdict& verdict, const double* raw, stepping::RunCounts& counts) {
    const std::uint32_t moving = moving_of(monitor);
    const bool moved = moving != moving_, ended = moved || verdict.tick;
    if (!ended && verdict.block_fill <= 1) rows_ = 0;
    if (verdict.accepted) add_row(raw);
    if (verdict.transition.cause == Cause::noisy && verdict.transition.sequence != 0) {
      for (std::size_t i = 0; i < block_.size(); ++i)
        counts.sensor[i].named_noisy |= verdict.transition.sensors.has(static_cast<int>(i));
    }
    if (!ended) return;
    counts.blocks_in_motion += moving - moving_;
    moving_ = moving;
    if (verdict.tick) note_exclusions(verdict, counts);
    const bool at_rest = verdict.tick && (verdict.usable & Usable::stationary) != 0;
    for (std::size_t i = 0; i < block_.size(); ++i)
      end_block(monitor, verdict, i, moved, at_rest && rows_ > 1, counts.sensor[i]);
    rows_ = 0;
  }

 private:
  struct Column {
    double origin = 0.0, sum = 0.0, square = 0.0;  ///< of the readings of the block less the first
    std::uint32_t full_scale = 0;                  ///< the monitor's count where the block began
  };

  static std::uint32_t moving_of(const HealthMonitor& monitor) noexcept {
    return monitor.counters().moving_blocks + monitor.counters().rotating_blocks;
  }
  static std::uint32_t full_scale_of(const HealthMonitor& monitor, std::size_t i) noexcept {
    return monitor.channels().counters(static_cast<int>(i)).clipped;
  }

  void add_row(const double* raw) {
    for (std::size_t i = 0; i < block_.size(); ++i) {
      Column& c = block_[i];
      if (rows_ == 0) c.origin = raw[i], c.sum = c.square = 0.0;
      const double off = raw[i] - c.origin;
      c.sum += off;
      c.square += off * off;
    }
    ++rows_;
  }

  static void note_exclusions(const Verdict& verdict, stepping::RunCounts& counts) {
    const SensorSet out = verdict.provisionally_excluded | verdict.excluded;
    bool any = false;
    for (std::size_t i = 0; i < counts.sensor.size(); ++i) {
      if (!out.has(static_cast<int>(i)) || verdict.sensor_cause[i] != Cause::isolated_fault) continue;
      counts.sensor[i].excluded_by_reading = any = true;
    }
    counts.length_off_after_exclusion |= any && verdict.norm_mismatch.kind != NormMismatchKind::none;
  }

  void end_block(const HealthMonitor& monitor, const Verdict& verdict, std::size_t i, bool moved, bool measured,
                 stepping::SensorCounts& out) {
    Column& c = block_[i];
    const std::uint32_t now = full_scale_of(monitor, i);
    (moved ? out.full_scale_in_motion : out.full_scale_at_rest) += now - c.full_scale;
    c.full_scale = now;
    const SensorSet own = verdict.noisy | verdict.scattering;
    if (!measured || !own.has(static_cast<int>(i))) return;
    const double variance = (c.square - c.sum * c.sum / rows_) / (rows_ - 1);
    if (!std::isfinite(variance)) return;  // a cell without a number
    ++out.scattering_blocks;
    out.scatter_raw_sq += std::fmax(variance, 0.0);
  }

  std::vector<Column> block_;
  int rows_ = 0;
  std::uint32_t moving_ = 0;
};

}  // namespace stepping_detail
}  // namespace PLUMB_ABI
}  // namespace plumb
