#include "plumb/scenario/fault.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// Rows and stations are whole numbers that a double holds exactly.
constexpr double kMaxCount = 9007199254740992.0;
/// Far above anything real, and no product with a scale, a factor or the time of a log overflows.
constexpr double kMaxSize = 1e12;

double now_of(const Fault& fault, const Moment& now) noexcept {
  switch (fault.clock) {
    case Clock::time: return now.time_s;
    case Clock::row: return static_cast<double>(now.row) + 1.0;
    case Clock::station: break;
  }
  return static_cast<double>(now.station);
}

bool whole(double value) noexcept { return value >= 1.0 && value <= kMaxCount && std::floor(value) == value; }

tl::unexpected<std::string> refuse(const char* why) { return tl::unexpected<std::string>(why); }

}  // namespace

const char* to_string(FaultKind kind) noexcept {
  switch (kind) {
    case FaultKind::stuck_level: return "stuck";
    case FaultKind::stuck_last: return "last";
    case FaultKind::random_range: return "random";
    case FaultKind::random_level: return "held";
    case FaultKind::bias_step: return "bias";
    case FaultKind::drift: return "drift";
    case FaultKind::scale_change: return "scale";
  }
  return "unknown";
}

tl::expected<void, std::string> check(const Fault& fault, int sensors) {
  if (fault.sensor < 0 || fault.sensor >= sensors) {
    return refuse("the fault names a sensor that the array does not have. Remedy: name one of the array");
  }
  if (!std::isfinite(fault.magnitude) || !std::isfinite(fault.upper)) {
    return refuse("the size of the fault is not a finite number. Remedy: give a finite number with its unit");
  }
  if (std::abs(fault.magnitude) > kMaxSize || std::abs(fault.upper) > kMaxSize) {
    return refuse(
        "the size of the fault is beyond 1e12 (levels in the log's unit, bias in m/s^2, drift in m/s^2 per "
        "s). Remedy: give a smaller size");
  }
  const bool counted = fault.clock != Clock::time;
  if (counted ? !whole(fault.onset) : !std::isfinite(fault.onset)) {
    return refuse(counted ? "the onset is not a row or station number. Remedy: give a whole number, the first is 1"
                          : "the onset is not a finite time. Remedy: give it with its unit, as in @12s");
  }
  const bool endless = std::isinf(fault.duration) && fault.duration > 0.0;
  if (!endless && (counted ? !whole(fault.duration) : !(fault.duration > 0.0))) {
    return refuse("the duration is not positive. Remedy: leave it out for a fault that lasts, or give it as in +10s");
  }
  const bool ranged = fault.kind == FaultKind::random_range || fault.kind == FaultKind::random_level;
  if (ranged && !(fault.magnitude < fault.upper)) {
    return refuse("the range of the random value is empty. Remedy: give the lower end first, as in -3V..3V");
  }
  if (fault.kind == FaultKind::stuck_last && fault.magnitude < 0.0) {
    return refuse("the dither is negative. Remedy: give its half width, or leave it out");
  }
  if (fault.kind == FaultKind::scale_change && fault.magnitude == 1.0) {
    return refuse("a scale factor times 1 is no fault. Remedy: give another factor, as in scale=1.1");
  }
  return {};
}

bool has_begun(const Fault& fault, const Moment& now) noexcept { return now_of(fault, now) >= fault.onset; }

bool in_effect(const Fault& fault, const Moment& now) noexcept {
  return has_begun(fault, now) && now_of(fault, now) < fault.onset + fault.duration;
}

double apply(const Fault& fault, const FaultMemory& memory, const Moment& now, double raw, const ChannelLaw& law,
             const Stream& stream) noexcept {
  switch (fault.kind) {
    case FaultKind::stuck_level: return fault.magnitude;
    case FaultKind::stuck_last: {
      const double held = memory.has_last ? memory.last_raw : raw;
      return fault.magnitude > 0.0 ? held + stream.uniform(now.row, -fault.magnitude, fault.magnitude) : held;
    }
    case FaultKind::random_range: return stream.uniform(now.row, fault.magnitude, fault.upper);
    case FaultKind::random_level: return stream.uniform(0, fault.magnitude, fault.upper);
    case FaultKind::bias_step: return raw + law.scale * fault.magnitude;
    case FaultKind::drift: return raw + law.scale * (fault.magnitude * (now.time_s - memory.begun_s));
    case FaultKind::scale_change: return law.zero_raw + fault.magnitude * (raw - law.zero_raw);
  }
  return raw;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
