/// A flight for the target: array, bounds and samples of a monitor of motion, as 64-bit words.
#pragma once

#include "plumb/motion/motion_monitor.hpp"
#include "recording.hpp"

namespace metal {
inline namespace PLUMB_ABI {

inline constexpr std::uint64_t kMotionMagic = 0x31305f6e6f69746fULL;  // "otion_01"

/// What is configured, in one order for both directions; `sensors` of them are used.
template <class Words, class Setup>
void transfer_motion_setup(Words& words, Setup& setup, std::size_t sensors) noexcept {
  words.number(setup.sample_period_s);
  words.number(setup.rate_bound_radps);
  for (std::size_t i = 0; i < sensors; ++i) {
    for (auto& part : setup.lever_arm_m[i]) words.number(part);
    auto& e = setup.errors[i];
    for (auto* bound : {&e.lever_m, &e.lag_s, &e.rectification, &e.scale, &e.axis_rad, &e.bias_mps2})
      words.number(*bound);
  }
  auto& g = setup.gyro;
  for (auto* bound : {&g.scale, &g.axis_rad, &g.bias_radps, &g.noise_radps, &g.lag_s}) words.number(*bound);
}

/// Of a row: two gyros, and every sensor delivers.
template <class Words, class Sample>
void transfer_motion_row(Words& words, Sample& sample, std::size_t sensors) noexcept {
  words.number(sample.time_s);
  for (std::size_t i = 0; i < sensors; ++i) words.number(sample.reading_mps2[i]);
  for (auto& rate : sample.rate_radps) {
    for (auto& part : rate) words.number(part);
  }
}

}  // namespace PLUMB_ABI
}  // namespace metal
