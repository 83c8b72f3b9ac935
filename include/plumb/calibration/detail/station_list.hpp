/// The stations of a fit: as the host keeps them, or made one by one from the means that a monitor remembers, so that
/// none needs storage for all of them.
#pragma once

#include <cstdint>

#include "plumb/core/detail/station_mean.hpp"
#include "plumb/core/sample.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class StationList {
 public:
  StationList(const Station* stations, int count) noexcept
      : plain_(stations), count_(stations == nullptr ? 0 : count) {}
  /// Of `count` means over a whole array the readings of `sensors`, in their order; every `held_out`-th mean is left
  /// out. Each station weighs as one sample.
  StationList(const StationMean* means, int count, SensorSet sensors, int held_out) noexcept
      : mean_(means), sensors_(sensors), stride_(held_out), count_(count - count / held_out) {}

  int size() const noexcept { return count_; }
  /// Null where the stations are made one by one.
  const Station* plain() const noexcept { return plain_; }

  /// Of stations that are made one by one: this one counts no sample from now on. Of the first 32 only.
  void leave_out(int k) noexcept {
    if (k < kMarked) left_out_ |= std::uint32_t{1} << static_cast<unsigned>(k);
  }
  static constexpr int kMarked = 32;

  Station operator[](int k) const noexcept { return plain_ != nullptr ? plain_[k] : made(k); }

 private:
  Station made(int k) const noexcept {
    const StationMean& mean = mean_[k + k / (stride_ - 1)];
    Station station;
    station.delivered = SensorSet::first(sensors_.size());
    station.temperature_degc = mean.temperature_degc;
    const bool out = k < kMarked && (left_out_ >> static_cast<unsigned>(k) & 1U) != 0;
    station.count = out ? 0 : 1;
    std::size_t row = 0;
    for (int i = 0; i < kCapacity; ++i) {
      if (sensors_.has(i)) station.mean[row++] = mean.raw[static_cast<std::size_t>(i)];
    }
    return station;
  }

  const Station* plain_ = nullptr;
  const StationMean* mean_ = nullptr;
  SensorSet sensors_;
  int stride_ = 0;
  int count_ = 0;
  std::uint32_t left_out_ = 0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
