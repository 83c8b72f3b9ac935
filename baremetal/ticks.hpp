/// A million samples of a tool with four sensors, a thousand a second, and what a monitor must have said of them:
/// played by a timer interrupt on the target, by a loop on the host.
#pragma once

#include <cstdint>

#include "plumb/health/health_monitor.hpp"

namespace metal {

inline constexpr int kTicks = 1000000;
inline constexpr double kTick_s = 1e-3;

/// A new attitude every 4 s. From 100 to 300 s the second channel is dead, from 400 to 600 s the third is off by
/// 0.5 m/s^2, from 700 to 710 s the first delivers nothing.
class TickedTool {
 public:
  bool make() noexcept;  ///< array, setup, attitudes; false: refused
  const plumb::MonitorSetup& setup() const noexcept { return setup_; }
  void sample(int tick, plumb::Sample& out) noexcept;

 private:
  static constexpr int kStands = 64, kTicksOfAStand = 4000;
  plumb::MonitorSetup setup_;
  double raw_[kStands][4] = {};
  std::uint32_t random_ = 1;
};

/// What must be so after that sample; 0, or the number of what is not.
int wrong_after(int tick, const plumb::Verdict& verdict) noexcept;

}  // namespace metal
