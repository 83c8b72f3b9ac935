/// Another try after a `failed` by isolation timeout. A host helper: nothing under `step()` knows of it, and `failed`
/// is left by the keyed reset alone (property S5), which the helper calls in the host's name. A timeout says that the
/// attitudes so far did not single out a fault: after a pause the same sensors may be given others. What is left of a
/// `failed` of any other kind, too few sensors or lost memory, is never tried again.
#pragma once

#include <cstdint>

#include "plumb/core/error.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct RetryPolicy {
  double pause_s = 600.0;  ///< in failed before each retry, by the time of the samples; no less than 0
  int most_retries = 3;    ///< in all, since the helper was made
  std::uint64_t key = 0;   ///< `MonitorConfig::reset_key`
};

/// What an offer led to. All but `none` are reported once each, and belong into the log.
enum class RetryAction : std::uint8_t {
  none,
  pause_began,  ///< failed by timeout: the pause has begun
  asked,        ///< the reset was called: the next step leaves failed, not yet validated
  refused,      ///< the reset was called and refused (`error`): it is not called again
  too_few,      ///< failed by too few sensors, or by another cause than a timeout: for a person
  given_up,     ///< the retries are used up: for a person
};
const char* to_string(RetryAction action) noexcept;

struct RetryRecord {
  RetryAction action = RetryAction::none;
  double time_s = 0.0;
  int retries = 0;    ///< asked for so far, this one included
  SensorSet sensors;  ///< those named in the reset
  Errc error = Errc::ok;
};

/// Offer it every verdict. It keeps no reference, allocates nothing and has no clock. What has been excluded, and who
/// is provisionally excluded, is not named in the reset and stays so.
class RetryAfterTimeout {
 public:
  explicit RetryAfterTimeout(const RetryPolicy& policy) noexcept : policy_(policy) {}

  RetryRecord offer(const Verdict& verdict, HealthMonitor& monitor) noexcept;
  int retries() const noexcept { return retries_; }

 private:
  enum class Phase : std::uint8_t { in_service, pause, asked, closed };

  RetryRecord ask(const Verdict& verdict, HealthMonitor& monitor) noexcept;

  RetryPolicy policy_;
  Phase phase_ = Phase::in_service;
  bool key_refused_ = false;
  double since_s_ = 0.0;
  int retries_ = 0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
