#include "timeline.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "chips.hpp"
#include "limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

/// A source seen through windows of several blocks.
struct Watcher {
  std::map<std::int64_t, SourceBlock> windows;
  double still_mps2 = 0.0;             ///< scatter up to which it is at rest
  Axes mean_mps2 = logs::kAbsentAxes;  ///< of the stretch so far
  double weight = 0.0;
};

double scatter_of(const SourceBlock& block) noexcept {
  return std::max({block.deviation_mps2(0), block.deviation_mps2(1), block.deviation_mps2(2)});
}

bool tells(const SourceBlock& block) noexcept { return block.weight >= kWindowReadings / 2.0 && block.records >= 2; }

/// Blocks to a window, so that the fastest source has kWindowReadings in it; 0 without a source.
std::int64_t blocks_per_window(const LogDigest& digest) {
  double fastest_s = logs::kAbsent;
  for (const SourceDigest& source : digest.sources) fastest_s = std::fmin(fastest_s, source.intervals.usual_s());
  if (!std::isfinite(fastest_s)) return 0;
  return static_cast<std::int64_t>(std::clamp(std::ceil(kWindowReadings * fastest_s / digest.block_s), 1.0, 3600.0));
}

std::int64_t window_of(std::int64_t block, std::int64_t blocks) noexcept {
  return block >= 0 ? block / blocks : -((-block + blocks - 1) / blocks);
}

Watcher watcher_of(const SourceDigest& source, std::int64_t blocks) {
  Watcher out;
  for (const SourceBlock& block : source.blocks) out.windows[window_of(block.index, blocks)].add(block);
  std::vector<double> scatters;
  for (const auto& [index, block] : out.windows) {
    if (tells(block)) scatters.push_back(scatter_of(block));
  }
  if (scatters.empty()) return out;
  const auto least = scatters.begin() + static_cast<std::ptrdiff_t>(scatters.size() / 10);
  std::nth_element(scatters.begin(), least, scatters.end());
  out.still_mps2 = std::clamp(kStillRatio * *least, kStillAlways_mps2, kStillNever_mps2);
  return out;
}

struct Votes {
  int all = 0, still = 0, stayed = 0;
  bool turns = false;  ///< by any gyro
};

/// What the watchers say of a window.
Votes ask(const std::vector<Watcher>& watchers, std::int64_t window) {
  Votes out;
  for (const Watcher& watcher : watchers) {
    const auto found = watcher.windows.find(window);
    if (found == watcher.windows.end() || !tells(found->second)) continue;
    const SourceBlock& block = found->second;
    ++out.all;
    out.turns = out.turns || length_of(block.rate_radps) > kStillRate_radps;
    if (scatter_of(block) > watcher.still_mps2) continue;
    ++out.still;
    const double error_mps2 = 3.0 * scatter_of(block) / std::sqrt(static_cast<double>(block.records));
    const bool stayed = std::isnan(watcher.mean_mps2[0]) ||
                        length_of(difference(block.mean_mps2, watcher.mean_mps2)) < kStretchStep_mps2 + error_mps2;
    if (stayed) ++out.stayed;
  }
  return out;
}

void settle(std::vector<Watcher>& watchers, std::int64_t window, bool anew) {
  for (Watcher& watcher : watchers) {
    if (anew) {
      watcher.mean_mps2 = logs::kAbsentAxes;
      watcher.weight = 0.0;
    }
    const auto found = watcher.windows.find(window);
    if (found == watcher.windows.end() || found->second.records == 0) continue;
    const double weight = found->second.weight;
    watcher.weight += weight;
    for (std::size_t k = 0; k < 3; ++k) {
      double& mean = watcher.mean_mps2[k];
      const double now = found->second.mean_mps2[k];
      mean = std::isnan(mean) ? now : mean + (now - mean) * (weight / watcher.weight);
    }
  }
}

/// Of the slowest chip that has ten readings in a minute.
double slowest_interval(const LogDigest& digest, const std::vector<ChipSummary>& chips) {
  double out = 0.0;
  for (const ChipSummary& chip : chips) {
    const double interval_s = digest.sources[chip.judged].intervals.usual_s();
    if (interval_s * kWindowReadings <= kLongestCell_s) out = std::max(out, interval_s);
  }
  return out;
}

Cell cell_of(const LogDigest& digest, const std::vector<ChipSummary>& chips, const Span& span) {
  Cell out;
  out.span = span;
  out.readings.reserve(chips.size());
  for (const ChipSummary& chip : chips) out.readings.push_back(reading_of(digest, chip, span.from, span.to));
  for (const SourceDigest& source : digest.sources)
    out.rate_squares = std::max(out.rate_squares, block_of(source, span.from, span.to).rate_squares);
  return out;
}

}  // namespace

std::vector<Span> spans_at_rest(const LogDigest& digest) {
  const std::int64_t blocks = blocks_per_window(digest);
  if (blocks == 0) return {};
  std::vector<Watcher> watchers;
  std::set<std::int64_t> windows;  // all that any source has
  for (const SourceDigest& source : digest.sources) {
    watchers.push_back(watcher_of(source, blocks));
    for (const auto& [index, block] : watchers.back().windows) windows.insert(index);
  }
  std::vector<Span> out;
  Span open;
  const auto close = [&] {
    if (static_cast<double>(open.to - open.from) * digest.block_s >= kShortestStretch_s) out.push_back(open);
    open = Span{};
  };
  for (const std::int64_t window : windows) {
    const std::int64_t from = window * blocks;
    if (open.to != from) close();
    const Votes votes = ask(watchers, window);
    const bool still = votes.all > 0 && 2 * votes.still >= votes.all && !votes.turns;
    const bool goes_on = still && open.to == from && open.to > open.from && 2 * votes.stayed >= votes.still;
    if (!goes_on) close();
    if (!still) continue;
    settle(watchers, window, !goes_on);
    if (!goes_on) open.from = from;
    open.to = from + blocks;
  }
  close();
  return out;
}

std::vector<Cell> cells_in_motion(const LogDigest& digest, const std::vector<ChipSummary>& chips,
                                  const std::vector<Span>& rest) {
  std::vector<Cell> out;
  if (chips.empty()) return out;
  const double cell_s = kWindowReadings * slowest_interval(digest, chips);
  const auto blocks = static_cast<std::int64_t>(std::clamp(std::ceil(cell_s / digest.block_s), 1.0, 3600.0));
  std::set<std::int64_t> starts;
  for (const ChipSummary& chip : chips) {
    for (const SourceBlock& block : digest.sources[chip.judged].blocks) starts.insert(window_of(block.index, blocks));
  }
  std::size_t next = 0;
  for (const std::int64_t number : starts) {
    const Span span{number * blocks, (number + 1) * blocks};
    while (next < rest.size() && rest[next].to <= span.from) ++next;
    if (next < rest.size() && rest[next].from < span.to) continue;
    out.push_back(cell_of(digest, chips, span));
  }
  return out;
}

std::vector<Cell> cells_at_rest(const LogDigest& digest, const std::vector<ChipSummary>& chips,
                                const std::vector<Span>& rest) {
  std::vector<Cell> out;
  for (const Span& span : rest) {
    out.push_back(cell_of(digest, chips, span));
    out.back().at_rest = true;
  }
  return out;
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
