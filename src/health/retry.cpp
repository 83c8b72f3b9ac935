#include "plumb/health/retry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

const char* to_string(RetryAction action) noexcept {
  switch (action) {
    case RetryAction::none: return "none";
    case RetryAction::pause_began: return "pause began";
    case RetryAction::asked: return "asked";
    case RetryAction::refused: return "refused";
    case RetryAction::too_few: return "too few";
    case RetryAction::given_up: return "given up";
  }
  return "?";
}

RetryRecord RetryAfterTimeout::ask(const Verdict& verdict, HealthMonitor& monitor) noexcept {
  RetryRecord out;
  out.time_s = verdict.time_s;
  out.sensors = verdict.in_service;
  phase_ = Phase::closed;
  if (retries_ >= policy_.most_retries) {
    out.action = RetryAction::given_up;
  } else {
    const Expected<void> served = monitor.reset(policy_.key, out.sensors);
    if (served) {
      ++retries_;
      phase_ = Phase::asked;
      out.action = RetryAction::asked;
    } else {
      key_refused_ = true;
      out.action = RetryAction::refused;
      out.error = served.error().code;
    }
  }
  out.retries = retries_;
  return out;
}

RetryRecord RetryAfterTimeout::offer(const Verdict& verdict, HealthMonitor& monitor) noexcept {
  RetryRecord out;
  out.retries = retries_;
  out.time_s = verdict.time_s;
  if (verdict.state != HealthState::failed) {
    phase_ = Phase::in_service;
    return out;
  }
  if (phase_ == Phase::closed || key_refused_) return out;
  // Too few may be left only since: channels fall silent in failed, too.
  const bool timed_out = (verdict.qualifiers & Qualifier::timed_out) != 0;
  if (!timed_out || rank_of(monitor.array(), verdict.in_service) < 3) {
    phase_ = Phase::closed;
    out.action = RetryAction::too_few;
    out.sensors = verdict.in_service;
    return out;
  }
  const double paused_s = verdict.time_s - since_s_;
  // Time that began anew, or was no number, says nothing of how long it has been.
  if (phase_ != Phase::pause || !(paused_s >= 0.0)) {
    out.action = phase_ == Phase::in_service ? RetryAction::pause_began : RetryAction::none;
    phase_ = Phase::pause;
    since_s_ = verdict.time_s;
    return out;
  }
  return paused_s >= policy_.pause_s ? ask(verdict, monitor) : out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
