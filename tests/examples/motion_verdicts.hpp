/// Verdicts in motion for the adapters to autopilots: one of three chips made by hand, and any at random.
#pragma once

#include <rapidcheck/gtest.h>

#include <array>
#include <limits>

#include "plumb/motion/motion_monitor.hpp"

namespace example_test {

/// Three chips of three axes: sensors 0 to 2, 3 to 5 and 6 to 8.
inline constexpr std::array<plumb::SensorSet, 3> kChipAxes{plumb::SensorSet(0b111), plumb::SensorSet(0b111000),
                                                           plumb::SensorSet(0b111000000)};

/// All three in a bounded force: what is at fault in a test is set there.
inline plumb::MotionVerdict flying() {
  plumb::MotionVerdict v;
  v.sample.validity = plumb::ForceValidity::bounded;
  v.sample.time_s = 12.2495;
  v.sample.span_s = 0.001;
  v.sample.force_mps2 = {0.5, -0.25, -9.75};
  v.sample.bound_mps2 = 0.2;
  v.sample.used = plumb::SensorSet::first(9);
  return v;
}

/// A number as it comes, one in sixteen of them none at all.
inline double any_number(double low, double high) {
  constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(), 1e300};
  const int kind = *rc::gen::inRange(0, 64);
  if (kind < 4) return kBad[kind];
  return low + (high - low) * 1e-6 * *rc::gen::inRange(0, 1000001);
}

/// Sets of whole chips and of single axes, often empty.
inline plumb::SensorSet any_set() {
  const int kind = *rc::gen::inRange(0, 9);
  if (kind < 6) return plumb::SensorSet{};
  if (kind < 8) return kChipAxes[*rc::gen::inRange<std::size_t>(0, 3)];
  return plumb::SensorSet(*rc::gen::inRange(0U, 512U));
}

/// Any bit pattern of a verdict that an adapter reads, half of the time near a sensible one.
inline plumb::MotionVerdict any_verdict() {
  plumb::MotionVerdict v = flying();
  v.isolated = any_set();
  v.alarm = !v.isolated.empty() || *rc::gen::inRange(0, 4) == 0;
  v.excluded = any_set();
  v.suspects = any_set() | v.isolated;
  v.sample.used = v.sample.used - v.isolated - v.excluded;
  v.sample.time_s = any_number(-0.1, 20.0);
  for (double& x : v.sample.force_mps2) x = any_number(-20.0, 20.0);
  if (*rc::gen::inRange(0, 2) == 1) return v;
  v.sample.span_s = any_number(-0.01, 0.1);
  v.sample.bound_mps2 = any_number(0.0, 10.0);
  v.sample.used = any_set();
  v.sample.validity = static_cast<plumb::ForceValidity>(*rc::gen::inRange(0, 3));
  v.cause = static_cast<plumb::MotionCause>(*rc::gen::inRange(0, 7));
  return v;
}

}  // namespace example_test
