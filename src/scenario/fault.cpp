#include "plumb/scenario/fault.hpp"

#include <algorithm>
#include <cmath>

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

/// What the numbers of a kind must be. Empty where they are.
const char* size_wrong(const Fault& fault, int sensors) noexcept {
  const auto index = [sensors](double value) { return value >= 0.0 && value < sensors && std::floor(value) == value; };
  const double first = fault.magnitude;
  const double second = fault.upper;
  switch (fault.kind) {
    case FaultKind::random_range:
    case FaultKind::random_level:
      return first < second ? ""
                            : "the range of the random value is empty. Remedy: give the lower end first, as in -3V..3V";
    case FaultKind::clip:
      return first < second ? "" : "nothing lies between the limits. Remedy: give the lower one first, as in -1V..4V";
    case FaultKind::stuck_last:
      return first >= 0.0 ? "" : "the dither is negative. Remedy: give its half width, or leave it out";
    case FaultKind::scale_change:
      return first != 1.0 ? "" : "a scale factor times 1 is no fault. Remedy: give another factor, as in scale=1.1";
    case FaultKind::noise:
    case FaultKind::shake:
    case FaultKind::coarse: return first > 0.0 ? "" : "the size is not above zero. Remedy: give one that is";
    case FaultKind::spikes:
      return second > 0.0 && second <= 1.0
                 ? ""
                 : "the chance of a spike is not above 0 and at most 100 %. Remedy: write spikes=0.5g0*1%";
    case FaultKind::chatter:
    case FaultKind::warm_up:
      return second > 0.0 ? "" : "the time is not above zero. Remedy: write chatter=50mg0*10s or warmup=2mg0*5min";
    case FaultKind::missing:
    case FaultKind::drop:
      return first > 0.0 && first <= 1.0
                 ? ""
                 : "the share is not above 0 and at most 100 %. Remedy: write 30%, or leave it out for all";
    case FaultKind::late:
    case FaultKind::slow:
      return whole(first) && first <= kMostRowsLate
                 ? ""
                 : "the number of rows is not from 1 to 100. Remedy: write it as in late=5";
    case FaultKind::bit_flip:
      return first >= 0.0 && first <= 40.0 && std::floor(first) == first
                 ? ""
                 : "no such bit. Remedy: give its number from 0, the lowest, to 40";
    case FaultKind::pattern:
      return first >= 0.0 && first < kBitPatterns && std::floor(first) == first
                 ? ""
                 : "no such pattern. Remedy: give nan, inf, -inf, huge, denormal or -0";
    case FaultKind::exchange:
    case FaultKind::cross_talk:
      return index(first) && static_cast<int>(first) != fault.sensor
                 ? ""
                 : "the other sensor is not another one of the array. Remedy: name one, as in exchange=a3";
    case FaultKind::mirror:
      return index(first) && index(second) && first != second
                 ? ""
                 : "the mirror needs two sensors. Remedy: name two of the array, as in mirror=a1*a3";
    default: return "";
  }
}

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

const char* to_string(FaultKind kind) noexcept {
  static constexpr const char* kWords[kFaultKinds] = {
      "stuck",  "last",  "random", "held",  "bias",    "drift",       "scale", "noise",  "spikes",   "chatter",
      "warmup", "clip",  "coarse", "bit",   "pattern", "missing",     "late",  "slow",   "exchange", "cross",
      "turned", "ghost", "mirror", "shake", "gravity", "temperature", "drop",  "repeat", "swap",     "back"};
  const auto k = static_cast<std::size_t>(kind);
  return k < kFaultKinds ? kWords[k] : "unknown";
}

bool needs_whole_log(FaultKind kind) noexcept { return kind >= FaultKind::shake; }

bool is_delivery(FaultKind kind, int sensor) noexcept {
  return kind >= FaultKind::drop || (kind == FaultKind::late && sensor == kWholeLog);
}

tl::expected<void, std::string> check(const Fault& fault, int sensors) {
  const bool log = fault.sensor == kWholeLog;
  if (needs_whole_log(fault.kind) && !log) {
    return refuse(
        "this kind of fault is of the whole log, not of one sensor. Remedy: write log in the place of the sensor");
  }
  if (log && !needs_whole_log(fault.kind) && fault.kind != FaultKind::late) {
    return refuse("this kind of fault is of one sensor. Remedy: name the sensor in the place of log");
  }
  if (!log && (fault.sensor < 0 || fault.sensor >= sensors)) {
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
  const char* wrong = size_wrong(fault, sensors);
  if (*wrong != '\0') return refuse(wrong);
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
