#include "plumb/detection/channel_monitor.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

constexpr double kClipFraction = 0.995;

}  // namespace

void ChannelMonitor::configure(int n, const std::array<double, kCapacity>& full_scale_raw, int confirm) noexcept {
  *this = ChannelMonitor{};
  size_ = n;
  full_scale_raw_ = full_scale_raw;
  confirm_ = confirm;
}

GateResult ChannelMonitor::gate(const Sample& sample) noexcept {
  GateResult out;
  for (int i = 0; i < size_; ++i) {
    const auto a = static_cast<std::size_t>(i);
    if (!sample.delivered.has(i)) {
      out.missing = out.missing.with(i);
    } else if (!std::isfinite(sample.raw[a])) {
      out.not_finite = out.not_finite.with(i);
    } else {
      out.usable = out.usable.with(i);
      if (full_scale_raw_[a] > 0.0 && std::fabs(sample.raw[a]) >= kClipFraction * full_scale_raw_[a]) {
        out.clipped = out.clipped.with(i);
      }
    }
  }
  out.gap = out.usable.empty();
  if (out.gap) return out;  // a silent or babbling bus says nothing about any one channel
  if (block_samples_ < kMostBlockSamples) ++block_samples_;
  for (int i = 0; i < size_; ++i) {
    const auto a = static_cast<std::size_t>(i);
    if (out.clipped.has(i)) count_up(clipped_in_block_[a]);
    if (out.usable.has(i)) {
      if (sample.raw[a] == last_raw_[a]) {
        count_up(repeats_[a]);
      } else {
        repeats_[a] = 0;
        changed_ = changed_.with(i);
      }
      last_raw_[a] = sample.raw[a];
    }
    if (out.missing.has(i)) count_up(counters_[a].missing);
    if (out.not_finite.has(i)) count_up(counters_[a].not_finite);
    if (out.clipped.has(i)) count_up(counters_[a].clipped);
    if (out.usable.has(i)) {
      bad_run_[a] = 0;
      count_up(good_run_[a]);
    } else {
      good_run_[a] = 0;
      count_up(bad_run_[a]);
    }
    if (bad_run_[a] >= confirm_) {
      lost_ = lost_.with(i);
      back_ = back_.without(i);
    }
    if (lost_.has(i) && good_run_[a] >= confirm_) back_ = back_.with(i);
  }
  return out;
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

void ChannelMonitor::condemn(SensorSet channels) noexcept { lost_ = lost_ | (channels & SensorSet::first(size_)); }

void ChannelMonitor::welcome(SensorSet channels) noexcept {
  lost_ = lost_ - channels;
  back_ = back_ - channels;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
