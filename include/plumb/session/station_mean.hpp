/// For logs with one row per station: what `plumb simulate` writes of the samples at one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "plumb/core/sample.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// The mean of the samples at rest.
class StationMean {
 public:
  explicit StationMean(int sensors) : sensors_(static_cast<std::size_t>(sensors)) {}

  void add(const Sample& sample, const scenario::Truth& truth) {
    sum_.time_s += sample.time_s;
    sum_.temperature_degc += sample.temperature_degc;
    for (std::size_t i = 0; i < sensors_; ++i) sum_.raw[i] += sample.raw[i];
    sum_.delivered = sample.delivered;
    sum_.station = sample.station;
    sum_.roll_group = sample.roll_group;
    truth_.faulty = truth_.faulty | truth.faulty;
    truth_.gravity_mps2 = truth.gravity_mps2;
    truth_.station = truth.station;
    ++count_;
  }
  bool empty() const noexcept { return count_ == 0; }
  const scenario::Truth& truth() const noexcept { return truth_; }
  Sample mean() const {
    const auto n = static_cast<double>(count_);
    Sample sample = sum_;
    sample.time_s /= n;
    sample.temperature_degc /= n;
    for (double& value : sample.raw) value /= n;
    sample.count = count_;
    return sample;
  }

 private:
  std::size_t sensors_;
  Sample sum_;
  scenario::Truth truth_;
  std::uint32_t count_ = 0;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
