#include "plumb/detection/channel_monitor.hpp"

#include <cmath>
#include <limits>

#include "plumb/core/detail/archive.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

constexpr double kClipFraction = 0.995;

/// Comparisons of numbers that are not negative, of which the first may be NaN and is then taken for large. Without
/// registers for doubles they are asked of the bits, in a tenth of the instructions.
inline bool is_finite(double size) noexcept {
  if constexpr (kSingle) return archive_detail::bits_of(size) < 0x7FF0'0000'0000'0000U;
  return size <= std::numeric_limits<double>::max();  // a NaN is not
}
inline bool reaches(double size, double limit) noexcept {
  if constexpr (kSingle) return archive_detail::bits_of(size) >= archive_detail::bits_of(limit);
  return size >= limit;
}
/// Of numbers that are finite.
inline bool same(double a, double b) noexcept {
  if constexpr (kSingle) {
    const std::uint64_t u = archive_detail::bits_of(a), v = archive_detail::bits_of(b);
    return u == v || ((u | v) << 1U) == 0;  // 0 and -0 are the same number
  }
  return a == b;
}

}  // namespace

void ChannelMonitor::configure(int n, const std::array<double, kCapacity>& full_scale_raw, int confirm) noexcept {
  *this = ChannelMonitor{};
  size_ = n;
  for (std::size_t a = 0; a < full_scale_raw.size(); ++a) {
    const bool known = full_scale_raw[a] > 0.0;
    clip_raw_[a] = known ? kClipFraction * full_scale_raw[a] : std::numeric_limits<double>::infinity();
  }
  confirm_ = confirm;
}

GateResult ChannelMonitor::gate(const Sample& sample) noexcept {
  // Sorted by masks: the channels of a sample without trouble cost two comparisons each.
  std::uint32_t finite = 0, beyond = 0, bit = 1;
  for (std::size_t a = 0; a < static_cast<std::size_t>(size_); ++a, bit <<= 1U) {
    const double size = std::fabs(sample.raw[a]);
    if (is_finite(size)) finite |= bit;
    if (reaches(size, clip_raw_[a])) beyond |= bit;
  }
  const SensorSet all = SensorSet::first(size_);
  GateResult out;
  out.missing = all - sample.delivered;
  out.not_finite = (all & sample.delivered) - SensorSet(finite);
  out.usable = sample.delivered & SensorSet(finite);
  out.clipped = out.usable & SensorSet(beyond);
  out.gap = out.usable.empty();
  if (out.gap) return out;  // a silent or babbling bus says nothing about any one channel
  if (block_samples_ < kMostBlockSamples) ++block_samples_;
  std::uint32_t changed = 0;
  bit = 1;
  for (std::size_t a = 0; a < static_cast<std::size_t>(size_); ++a, bit <<= 1U) {
    if ((out.usable.bits & bit) == 0) continue;
    if (same(sample.raw[a], last_raw_[a])) {
      count_up(repeats_[a]);
    } else {
      repeats_[a] = 0;
      changed |= bit;
    }
    last_raw_[a] = sample.raw[a];
    bad_run_[a] = 0;
    count_up(good_run_[a]);
  }
  changed_ = changed_ | SensorSet(changed);
  if (out.usable != all || !(out.clipped | lost_).empty()) note_trouble(out);
  return out;
}

/// What only some samples have: channels that were clipped, that gave nothing to use, that are lost or come back.
void ChannelMonitor::note_trouble(const GateResult& sample) noexcept {
  for (int i = 0; i < size_; ++i) {
    const auto a = static_cast<std::size_t>(i);
    if (sample.clipped.has(i)) {
      count_up(clipped_in_block_[a]);
      count_up(counters_[a].clipped);
    }
    if (sample.missing.has(i)) count_up(counters_[a].missing);
    if (sample.not_finite.has(i)) count_up(counters_[a].not_finite);
    if (!sample.usable.has(i)) {
      good_run_[a] = 0;
      count_up(bad_run_[a]);
    }
    if (bad_run_[a] >= confirm_) {
      lost_ = lost_.with(i);
      back_ = back_.without(i);
    }
    if (lost_.has(i) && good_run_[a] >= confirm_) back_ = back_.with(i);
  }
}

void ChannelMonitor::begin_block() noexcept {
  clipped_in_block_.fill(0);
  changed_ = SensorSet{};
  block_samples_ = 0;
}

SensorSet ChannelMonitor::clipped_beyond(double share) const noexcept {
  SensorSet out;
  for (int i = 0; i < size_; ++i) {
    if (clipped_in_block_[static_cast<std::size_t>(i)] > share * block_samples_) out = out.with(i);
  }
  return out;
}

SensorSet ChannelMonitor::repeating(int samples) const noexcept {
  SensorSet out;
  for (int i = 0; i < size_; ++i) {
    if (repeats_[static_cast<std::size_t>(i)] + 1 >= samples) out = out.with(i);
  }
  return out;
}

void ChannelMonitor::count_facts(SensorSet noisy, SensorSet stuck, SensorSet clipped) noexcept {
  for (int i = 0; i < size_; ++i) {
    Counters& c = counters_[static_cast<std::size_t>(i)];
    if (noisy.has(i)) count_up(c.noisy_blocks);
    if (stuck.has(i)) count_up(c.stuck_blocks);
    if (clipped.has(i)) count_up(c.clipped_blocks);
  }
}

void ChannelMonitor::mark_lost(SensorSet channels) noexcept { lost_ = lost_ | (channels & SensorSet::first(size_)); }

void ChannelMonitor::reinstate(SensorSet channels) noexcept {
  lost_ = lost_ - channels;
  back_ = back_ - channels;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
