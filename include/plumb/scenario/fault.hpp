/// Faults F01 to F06 of the catalogue (domain note 7) as values: what breaks, when, and by how much.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <tl/expected.hpp>

#include "plumb/core/config.hpp"
#include "plumb/scenario/random.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

enum class FaultKind : std::uint8_t {
  stuck_level,   ///< F01: the output stands at `magnitude` [raw unit]: 0 V, +-3 V, full scale
  stuck_last,    ///< F02: the output stands at its last value; `magnitude` = dither +- [raw unit], mostly 0
  random_range,  ///< F03: uniform in [`magnitude`, `upper`] [raw unit], a new value every row
  random_level,  ///< F03: one value, drawn at onset, from [`magnitude`, `upper`] [raw unit]
  bias_step,     ///< F04: the sensor reads `magnitude` [m/s^2] too much
  drift,         ///< F05: the error grows by `magnitude` [m/s^2 per s] from onset on
  scale_change,  ///< F06: the scale factor is multiplied by `magnitude` [1]
};
inline constexpr int kFaultKinds = 7;

/// The word for a kind on the command line: stuck, last, random, held, bias, drift, scale.
const char* to_string(FaultKind kind) noexcept;

/// What onset and duration are counted in.
enum class Clock : std::uint8_t {
  time,     ///< seconds, on the time axis of the log
  row,      ///< rows (samples) of the log, the first is number 1
  station,  ///< stations in order of appearance, the first is number 1; a log needs station tags for it
};

struct Fault {
  FaultKind kind = FaultKind::stuck_level;
  int sensor = 0;  ///< index in the array
  Clock clock = Clock::time;
  double onset = 0.0;  ///< s, or number of the row or station; the fault is there from it on
  double duration = std::numeric_limits<double>::infinity();  ///< in the same unit
  double magnitude = 0.0;                                     ///< unit by kind
  double upper = 0.0;                                         ///< of the random kinds only

  friend bool operator==(const Fault& a, const Fault& b) noexcept {
    return a.kind == b.kind && a.sensor == b.sensor && a.clock == b.clock && a.onset == b.onset &&
           a.duration == b.duration && a.magnitude == b.magnitude && a.upper == b.upper;
  }
  friend bool operator!=(const Fault& a, const Fault& b) noexcept { return !(a == b); }
};

/// Refuses, with a remedy, a fault that makes no sense for an array of `sensors` sensors: not finite
/// or beyond 1e12, unknown sensor, row or station below 1 or not whole, duration not positive, empty range, scale 0.
tl::expected<void, std::string> check(const Fault& fault, int sensors);

/// Where in the log we are.
struct Moment {
  double time_s = 0.0;
  std::uint64_t row = 0;      ///< counted from 0 (a fault's row number is this plus 1)
  std::uint64_t station = 0;  ///< counted from 1; 0 = before the first
};

/// At or after onset.
bool has_begun(const Fault& fault, const Moment& now) noexcept;
/// At or after onset and before the end.
bool in_effect(const Fault& fault, const Moment& now) noexcept;

/// What a fault must remember of the past; filled by `Injector`.
struct FaultMemory {
  bool begun = false;
  bool effective = false;  ///< has changed a delivered value
  double begun_s = 0.0;    ///< onset [s] on the time axis; the first row's time where the onset lies before it
  bool has_last = false;
  double last_raw = 0.0;  ///< last value delivered before the onset
};

/// How the faulty channel turns acceleration into raw values, at the temperature of the row.
struct ChannelLaw {
  double scale = 1.0;     ///< raw unit per m/s^2, SF* of the sensor model
  double zero_raw = 0.0;  ///< raw value at zero acceleration, SF* B*
};

/// Raw value of a channel in fault, from its value without this fault. The fault must be in effect.
/// `stream` belongs to the fault; draws go by row, so they do not depend on what was drawn before.
double apply(const Fault& fault, const FaultMemory& memory, const Moment& now, double raw, const ChannelLaw& law,
             const Stream& stream) noexcept;

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
