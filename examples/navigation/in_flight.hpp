// What a verdict in motion says of one chip: in one place for the adapters to autopilots. Nothing is called healthy
// because nothing speaks against it: what is not judged, and an alarm that names nobody, are `unknown` for every chip.
#pragma once

#include <cmath>
#include <cstdint>

#include "plumb/motion/motion_monitor.hpp"

namespace plumb_flight {

enum class Told : std::uint8_t {
  unknown,    // not judged, no force, under suspicion, or not in the force
  unchecked,  // in the force; if one more unit failed nothing would show it
  healthy,    // in the force, and its bound holds whichever one further unit fails
  faulty      // an axis of it is isolated or excluded
};

/// The instant in microseconds, rounded; 0 where the clock is broken, as nothing is stamped before the first one.
inline std::uint64_t microseconds(double time_s) {
  return time_s > 0.0 && time_s < 1e13 ? static_cast<std::uint64_t>(time_s * 1e6 + 0.5) : 0;
}

inline constexpr double kMost_mps2 = 1e4;  // no accelerometer reads more: beyond it a number is none

/// Whether there is a force with numbers and an instant. A host whose monitor judges from blocks of 32 samples on
/// (`MotionSetup::shortest_block`) puts `block` in the place of `sample` first.
inline bool has_force(const plumb::SpecificForce& f) {
  bool numbers = f.span_s > 0.0 && microseconds(f.time_s) != 0;
  for (const double x : f.force_mps2) numbers = numbers && std::fabs(x) < kMost_mps2;
  return numbers && f.validity != plumb::ForceValidity::none;
}

/// What is told of the force itself; never faulty.
inline Told told(const plumb::MotionVerdict& v) {
  const bool names_nobody = v.alarm && (v.isolated | v.excluded).empty();
  if (v.cause != plumb::MotionCause::none || names_nobody || !has_force(v.sample)) return Told::unknown;
  const bool bounded = v.sample.validity == plumb::ForceValidity::bounded && std::isfinite(v.sample.bound_mps2);
  return bounded ? Told::healthy : Told::unchecked;
}

/// What is told of the chip with these axes; it is as good as the worst of them.
inline Told told(const plumb::MotionVerdict& v, plumb::SensorSet axes) {
  if (!((v.isolated | v.excluded) & axes).empty()) return Told::faulty;
  const bool clear = !axes.empty() && (v.suspects & axes).empty() && v.sample.used.contains(axes);
  return clear ? told(v) : Told::unknown;
}

}  // namespace plumb_flight
