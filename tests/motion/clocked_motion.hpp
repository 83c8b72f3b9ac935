/// Chips that sample by clocks of their own, off from what is stated of them by no more than the bounds.
#pragma once

#include <array>
#include <cmath>
#include <functional>

#include "motion/rigid_motion.hpp"
#include "plumb/motion/motion_clocks.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

/// A tool that does not turn, and chips without errors.
inline plumb::MotionSetup still_setup() {
  plumb::MotionSetup out;
  out.rate_bound_radps = 1e-9;
  return out;
}

/// Four sensors on a clock that agrees with the common one.
inline plumb::ClockSetup one_clock() {
  plumb::ClockSetup out;
  out.clocks = 1;
  out.clock[0].sensors = plumb::SensorSet::first(4);
  out.clock[0].valid_s = 1000.0;
  return out;
}

/// `setup` with clocks for n sensors in turn, each of another rate and offset; the gyros are on the first ones.
inline plumb::ClockSetup clocks_of(int n, int clocks, const plumb::MotionSetup& setup, Noise& noise) {
  constexpr std::array<double, 5> kPeriods{0.5, 0.8, 1.0, 1.003, 1.25};
  plumb::ClockSetup out;
  out.clocks = clocks;
  out.wait_s = 10.0 * setup.sample_period_s;
  for (int c = 0; c < clocks; ++c) {
    plumb::MotionClock& one = out.clock[static_cast<std::size_t>(c)];
    for (int i = c; i < n; i += clocks) one.sensors = one.sensors.with(i);
    for (int g = 0; g < setup.gyros; ++g) one.gyro[static_cast<std::size_t>(g)] = c == g % clocks;
    one.sample_period_s = setup.sample_period_s * kPeriods[static_cast<std::size_t>(noise.uniform() * 5.0)];
    one.offset_s = 20.0 * noise.uniform() - 10.0;
    one.rate = 2e-4 * noise.uniform() - 1e-4;
    one.since_s = one.offset_s;
    one.valid_s = 60.0;
    one.offset_bound_s = 20e-6;
    one.rate_bound = 5e-7;
  }
  return out;
}

class ChipClocks {
 public:
  using Read = std::function<plumb::MotionSample(int clock, double time_s)>;
  using Seen = std::function<void(int clock, const plumb::MotionSample&)>;

  /// Errors of the clocks anywhere within `share` of their bounds, or at its vertices; steps off by up to `jitter`.
  ChipClocks(const plumb::ClockSetup& stated, Noise& noise, bool vertices, double share = 1.0, double jitter = 0.0)
      : stated_(stated), noise_(&noise), jitter_(jitter) {
    const auto draw = [&](double bound) {
      const double u = 2.0 * noise.uniform() - 1.0;
      return share * (vertices ? std::copysign(bound, u) : bound * u);
    };
    for (int c = 0; c < stated.clocks; ++c) {
      const plumb::MotionClock& one = stated.clock[static_cast<std::size_t>(c)];
      Chip& chip = chip_[static_cast<std::size_t>(c)];
      chip.offset_s = one.offset_s + draw(one.offset_bound_s);
      chip.rate = one.rate + draw(one.rate_bound);
      chip.time_s = -0.05 + one.sample_period_s * noise.uniform();
      chip.late_s = 3e-3 * noise.uniform();
    }
  }
  /// Makes one clock be off by so much more than stated.
  void put_off(int clock, double by_s) { chip_[static_cast<std::size_t>(clock)].offset_s += by_s; }

  /// What all chips have sampled and delivered until then.
  void deliver(double until_s, plumb::MotionClocks& to, const Read& read, const Seen& seen = {}) {
    for (int c = 0; c < stated_.clocks; ++c) {
      const plumb::MotionClock& one = stated_.clock[static_cast<std::size_t>(c)];
      Chip& chip = chip_[static_cast<std::size_t>(c)];
      while (chip.time_s + chip.late_s <= until_s) {
        plumb::MotionSample s = read(c, chip.time_s);
        s.time_s = (chip.time_s + chip.offset_s - chip.rate * one.since_s) / (1.0 - chip.rate);
        last = to.push(c, s);
        if (seen) seen(c, s);
        chip.time_s += one.sample_period_s * (1.0 + jitter_ * (2.0 * noise_->uniform() - 1.0));
      }
    }
  }
  plumb::ClockPush last = plumb::ClockPush::not_configured;

 private:
  struct Chip {
    double offset_s = 0.0, rate = 0.0, time_s = 0.0, late_s = 0.0;
  };
  plumb::ClockSetup stated_;
  Noise* noise_;
  double jitter_;
  std::array<Chip, static_cast<std::size_t>(plumb::kMotionClocks)> chip_{};
};

}  // namespace PLUMB_ABI
}  // namespace plumb_test
