// The same navigator three times beside a motion monitor: on the force that the monitor publishes, on the plain average
// of all chips, and on the true force and rate. How far the first two are from the third is the error of the sensors.
#pragma once

#include <limits>

#include "drone.hpp"
#include "strapdown.hpp"

class Navigators {
 public:
  /// One sample, the verdict about it, and what was really the case.
  void step(const plumb::MotionSample& sample, const plumb::MotionVerdict& v, const plumb::scenario::FlightSample& is) {
    rate_.add(sample.time_s, plumb::scaled(plumb::plus(sample.rate_radps[0], sample.rate_radps[1]), 0.5));
    average_.add(sample.time_s, average_of(sample));
    true_rate_.add(sample.time_s, is.true_rate_radps);
    true_force_.add(sample.time_s, is.specific_force_mps2);
    if (v.sample.span_s == 0.0) return;  // two samples and one more make a force: not at the start, nor after a gap
    if (v.sample.validity != plumb::ForceValidity::none) force_mps2_ = v.sample.force_mps2;  // else the last one
    const double at_s = v.sample.time_s;
    age_s_ = sample.time_s - at_s;
    with_.step(rate_.at(at_s), force_mps2_, kPeriod_s);
    without_.step(rate_.at(at_s), average_.at(at_s), kPeriod_s);
    truth_.step(true_rate_.at(at_s), true_force_.at(at_s), kPeriod_s);
    if (v.block.span_s > 0.0 && v.block.time_s != block_time_s_) add_bound(v.block);
  }

  double with_mps() const { return (with_.velocity_mps() - truth_.velocity_mps()).norm(); }
  double without_mps() const { return (without_.velocity_mps() - truth_.velocity_mps()).norm(); }
  /// The bounds of the blocks, added up: what the error of the force may have made of the velocity.
  double allowed_mps() const { return allowed_mps_; }
  double force_age_s() const { return age_s_; }

 private:
  static plumb::Vec3 average_of(const plumb::MotionSample& sample) {  // parallel chips, whose arms add up to zero
    plumb::Vec3 sum{};
    for (std::size_t i = 0; i < kSensors; ++i) sum[i % 3] += sample.reading_mps2[i] / kChips;
    return sum;
  }

  void add_bound(const plumb::SpecificForce& block) {
    const bool bounded = block.validity == plumb::ForceValidity::bounded;
    allowed_mps_ += block.span_s * (bounded ? block.bound_mps2 : std::numeric_limits<double>::infinity());
    block_time_s_ = block.time_s;
  }

  Strapdown with_, without_, truth_;
  Recent rate_, average_, true_rate_, true_force_;
  plumb::Vec3 force_mps2_{};
  double allowed_mps_ = 0.0, block_time_s_ = 0.0, age_s_ = 0.0;
};
