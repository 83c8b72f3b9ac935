/// What a host asks of a running monitor, at a given time: the part of a run that no log holds.
///
///   TIME reset SENSORS key KEY        60.5s reset a2,a4 key 0x706c756d62
///   TIME recalibrate                  36.5s recalibrate
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/array/sensor_array.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/error.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/health/state.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

struct HostRequest {
  enum class Kind : std::uint8_t { reset, recalibrate };
  double time_s = 0.0;  ///< made before the first sample that is not earlier
  Kind kind = Kind::reset;
  SensorSet sensors;      ///< of a reset: to return to service
  std::uint64_t key = 0;  ///< of a reset
};
const char* to_string(HostRequest::Kind kind) noexcept;

/// Errors are texts that say what was found and end in a remedy.
tl::expected<HostRequest, std::string> parse_host_request(std::string_view text, const SensorArray& array);
/// The inverse: parses back to the identical value.
std::string to_text(const HostRequest& request, const SensorArray& array);

/// "a reset that returns a2 to service", "a recalibration", for a sentence.
std::string describe(const HostRequest& request, const SensorArray& array);

/// Makes each request at its time and keeps the answers.
class Host {
 public:
  struct Answer {
    double time_s = 0.0;  ///< of the sample before which the request was made
    HostRequest request;
    Errc refusal = Errc::ok;
  };

  Host() = default;
  explicit Host(std::vector<HostRequest> requests);

  /// Call before the monitor steps over a sample of this time. A `Monitor` has `reset`, `request_recalibration` and
  /// `verdict`, as `HealthMonitor` has.
  template <class Monitor>
  void before(double time_s, Monitor& monitor);
  const std::vector<Answer>& answers() const noexcept { return answers_; }
  /// Requests whose time has not come.
  std::size_t waiting() const noexcept { return requests_.size() - answers_.size(); }

 private:
  std::vector<HostRequest> requests_;  ///< in order of time
  std::vector<Answer> answers_;
};

template <class Monitor>
void Host::before(double time_s, Monitor& monitor) {
  while (waiting() > 0 && requests_[answers_.size()].time_s <= time_s) {
    const HostRequest& request = requests_[answers_.size()];
    const bool reset = request.kind == HostRequest::Kind::reset;
    const Expected<void> done = reset ? monitor.reset(request.key, request.sensors) : monitor.request_recalibration();
    Errc refusal = done ? Errc::ok : done.error().code;
    // The monitor ignores such a reset without a word; whoever asked for it gets the reason.
    if (reset && done && monitor.verdict().state != HealthState::failed) refusal = Errc::wrong_state;
    answers_.push_back({time_s, request, refusal});
  }
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
