/// A monitor in motion beside one at rest: what each tells the other between two samples.
///
///   motion.set_in_service(health.verdict().in_service);
///   health.set_motion(motion_finding(motion.step(fast_sample)));
///   if (settles_motion(health.step(sample))) motion.forget();
#pragma once

#include "plumb/health/motion_finding.hpp"
#include "plumb/health/verdict.hpp"
#include "plumb/motion/motion_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What of a verdict in motion the state machine hears.
inline MotionFinding motion_finding(const MotionVerdict& verdict) noexcept { return {verdict.alarm, verdict.excluded}; }

/// Whether rest, or the operator, has just confirmed or refuted what motion found: the monitor in motion forgets it and
/// judges anew. Sensors that rest leaves out of service stay out of motion by `set_in_service`.
inline bool settles_motion(const Verdict& verdict) noexcept {
  const TransitionRecord& t = verdict.transition;
  if (t.sequence == 0) return false;
  const bool passed = t.event == HealthEvent::passed_block && t.from != t.to;
  return passed || t.event == HealthEvent::exclusion || t.event == HealthEvent::probation_passed ||
         t.event == HealthEvent::reset || t.event == HealthEvent::fit_accepted;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
