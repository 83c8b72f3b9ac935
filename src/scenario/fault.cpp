#include "plumb/scenario/fault.hpp"

#include <algorithm>
#include <cmath>

#include "fault_kinds.hpp"
#include "plumb/scenario/noise.hpp"
#include "plumb/scenario/portable_math.hpp"

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

const char* to_string(BitPattern pattern) noexcept {
  static constexpr const char* kWords[kBitPatterns] = {"nan", "inf", "-inf", "huge", "denormal", "-0"};
  return kWords[static_cast<std::size_t>(pattern)];
}

double value_of(BitPattern pattern) noexcept {
  using Limits = std::numeric_limits<double>;
  switch (pattern) {
    case BitPattern::nan: return Limits::quiet_NaN();
    case BitPattern::inf: return Limits::infinity();
    case BitPattern::minus_inf: return -Limits::infinity();
    case BitPattern::huge: return 1e308;
    case BitPattern::denormal: return Limits::denorm_min();
    case BitPattern::minus_zero: break;
  }
  return -0.0;
}

tl::expected<void, std::string> check(const Fault& fault, int sensors) {
  const bool log = fault.sensor == kWholeLog;
  if (needs_whole_log(fault.kind) && !log) {
    return refuse("this kind of fault acts on the whole log. Remedy: write log in place of the sensor");
  }
  if (log && row_of(fault.kind).strikes == Strikes::channel) {
    return refuse("this kind of fault acts on one sensor. Remedy: write the sensor in place of log");
  }
  if (!log && (fault.sensor < 0 || fault.sensor >= sensors)) {
    return refuse("the fault names a sensor that the array does not have. Remedy: name a sensor of the array");
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
  const SizeRule& rule = row_of(fault.kind).rule;
  if (!rule.holds(fault, sensors)) return refuse(rule.otherwise);
  return {};
}

bool has_begun(const Fault& fault, const Moment& now) noexcept { return now_of(fault, now) >= fault.onset; }

bool in_effect(const Fault& fault, const Moment& now) noexcept {
  return has_begun(fault, now) && now_of(fault, now) < fault.onset + fault.duration;
}

double apply(const Fault& fault, const FaultMemory& memory, const Moment& now, double raw, const ChannelLaw& law,
             const Stream& stream) noexcept {
  const double since_s = now.time_s - memory.begun_s;
  switch (fault.kind) {
    case FaultKind::stuck_level: return fault.magnitude;
    case FaultKind::stuck_last: {
      const double held = memory.has_last ? memory.last_raw : raw;
      return fault.magnitude > 0.0 ? held + stream.uniform(now.row, -fault.magnitude, fault.magnitude) : held;
    }
    case FaultKind::random_range: return stream.uniform(now.row, fault.magnitude, fault.upper);
    case FaultKind::random_level: return stream.uniform(0, fault.magnitude, fault.upper);
    case FaultKind::bias_step: return raw + law.scale * fault.magnitude;
    case FaultKind::drift: return raw + law.scale * (fault.magnitude * since_s);
    case FaultKind::scale_change: return law.zero_raw + fault.magnitude * (raw - law.zero_raw);
    case FaultKind::noise: return raw + law.scale * (fault.magnitude * stream.normal(now.row));
    case FaultKind::spikes: {
      if (stream.uniform(now.row) >= fault.upper) return raw;
      const double sign = (stream.bits(now.row) & 1U) != 0 ? -1.0 : 1.0;
      return raw + law.scale * (sign * fault.magnitude);
    }
    case FaultKind::chatter: {
      const double half_turns = std::floor(since_s / fault.upper);
      return std::floor(half_turns * 0.5) * 2.0 == half_turns ? raw + law.scale * fault.magnitude : raw;
    }
    case FaultKind::warm_up: {
      const double constants = std::min(std::max(since_s / fault.upper, 0.0), 700.0);
      return raw + law.scale * (fault.magnitude * portable_exp(-constants));
    }
    case FaultKind::clip: return std::min(std::max(raw, fault.magnitude), fault.upper);
    case FaultKind::coarse: return quantised(raw, fault.magnitude);
    case FaultKind::bit_flip: {
      if (!(law.step_raw > 0.0) || !(std::abs(raw) < law.step_raw * kMaxCount)) return raw;
      const auto code = static_cast<std::int64_t>(std::floor(raw / law.step_raw + 0.5));
      const auto mask = std::int64_t{1} << static_cast<int>(fault.magnitude);
      return law.step_raw * static_cast<double>(code ^ mask);
    }
    case FaultKind::pattern: return value_of(static_cast<BitPattern>(static_cast<int>(fault.magnitude)));
    default: return raw;
  }
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
