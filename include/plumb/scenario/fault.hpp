/// Faults as values: what breaks, when, and by how much. The fault catalogue (catalogue.hpp) is made of them.
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
  stuck_level,   ///< the output stands at `magnitude` [raw unit]: 0 V, +-3 V, full scale
  stuck_last,    ///< the output stands at its last value; `magnitude` = dither +- [raw unit], mostly 0
  random_range,  ///< uniform in [`magnitude`, `upper`] [raw unit], a new value every row
  random_level,  ///< one value, drawn at onset, from [`magnitude`, `upper`] [raw unit]
  bias_step,     ///< the sensor reads `magnitude` [m/s^2] too much
  drift,         ///< the error grows by `magnitude` [m/s^2 per s] from onset on
  scale_change,  ///< the scale factor is multiplied by `magnitude` [1]; -1 is a reversed wire
  noise,         ///< white noise of `magnitude` rms [m/s^2] on top
  spikes,        ///< a row in `1/upper` is off by +-`magnitude` [m/s^2]; upper = chance per row, 0 .. 1
  chatter,       ///< a bias of `magnitude` [m/s^2] that is there for `upper` s, gone for `upper` s, and so on
  warm_up,       ///< an error of `magnitude` [m/s^2] at onset that fades away with the time constant `upper` [s]
  clip,          ///< the output is limited to [`magnitude`, `upper`] [raw unit]
  coarse,        ///< the output is rounded to multiples of `magnitude` [raw unit]: low bits are lost
  bit_flip,      ///< bit number `magnitude` of the code is inverted; without a known resolution nothing happens
  pattern,       ///< the output is a bit pattern that is no reading: number `magnitude` of `BitPattern`
  missing,       ///< nothing is delivered, in a share `magnitude` of the rows (1 = all)
  late,          ///< what is delivered is `magnitude` rows old; on the whole log: the row comes that much later
  slow,          ///< a new value every `magnitude` rows only, the last one in between
  exchange,      ///< the outputs of this sensor and of number `magnitude` have changed places
  cross_talk,    ///< a share `upper` of the acceleration that sensor number `magnitude` shows is added
  turned,        ///< the axis is turned by `magnitude` [rad], in the direction `upper` [rad] about itself
  ghost,         ///< as if gravity were turned by `magnitude` [rad] about the axis (cos upper, sin upper, 0)
  mirror,        ///< as if gravity were mirrored in the plane of the axes number `magnitude` and `upper`
  shake,         ///< whole log: white vibration of the body, `magnitude` rms per axis [m/s^2]
  gravity,       ///< whole log: gravity is longer by `magnitude` [m/s^2] than is stated to the monitor
  temperature,   ///< whole log: the temperature is reported wrong by `magnitude` [degC]
  drop,          ///< whole log: rows are lost, a share `magnitude` of them (1 = all)
  repeat,        ///< whole log: every row comes twice
  swap,          ///< whole log: rows come in pairs, the second of a pair first
  back,          ///< whole log: the time runs behind by `magnitude` [s] (below 0: ahead)
};
inline constexpr int kFaultKinds = static_cast<int>(FaultKind::back) + 1;

/// The sensor of a fault that is not one sensor's: of the tool, of its clock or of the link.
inline constexpr int kWholeLog = -1;

/// Bit patterns that no reading has, for `FaultKind::pattern`.
enum class BitPattern : std::uint8_t { nan, inf, minus_inf, huge, denormal, minus_zero };
inline constexpr int kBitPatterns = 6;
const char* to_string(BitPattern pattern) noexcept;
double value_of(BitPattern pattern) noexcept;

/// Largest number of rows that a late or slow channel looks back.
inline constexpr int kMostRowsLate = 100;

/// The word for a kind on the command line: stuck, last, random, held, bias, drift, scale, ...
const char* to_string(FaultKind kind) noexcept;

/// True for faults of the whole log (`sensor` = kWholeLog); `late` may be either.
bool needs_whole_log(FaultKind kind) noexcept;
/// True for faults that change which rows come, in which order and with which times: `Delivery` acts them out.
bool is_delivery(FaultKind kind, int sensor) noexcept;

/// What onset and duration are counted in.
enum class Clock : std::uint8_t {
  time,     ///< seconds, on the time axis of the log
  row,      ///< rows (samples) of the log, the first is number 1
  station,  ///< stations in order of appearance, the first is number 1; a log needs station tags for it
};

struct Fault {
  FaultKind kind = FaultKind::stuck_level;
  int sensor = 0;  ///< index in the array, or kWholeLog
  Clock clock = Clock::time;
  double onset = 0.0;  ///< s, or number of the row or station; the fault is there from it on
  double duration = std::numeric_limits<double>::infinity();  ///< in the same unit
  double magnitude = 0.0;                                     ///< unit by kind
  double upper = 0.0;                                         ///< second number, of the kinds that have one

  friend bool operator==(const Fault& a, const Fault& b) noexcept {
    return a.kind == b.kind && a.sensor == b.sensor && a.clock == b.clock && a.onset == b.onset &&
           a.duration == b.duration && a.magnitude == b.magnitude && a.upper == b.upper;
  }
  friend bool operator!=(const Fault& a, const Fault& b) noexcept { return !(a == b); }
};

/// Refuses, with a remedy, a fault that makes no sense for an array of `sensors` sensors: not finite
/// or beyond 1e12, unknown sensor, row or station below 1 or not whole, duration not positive, a size that the kind
/// cannot have (empty range, factor 1, chance above 1, bit 60, ...).
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
  double step_raw = 0.0;  ///< one code; 0 = unknown
};

/// Raw value of a channel in fault, from its value without this fault. The fault must be in effect. Kinds that need
/// more than the channel itself (other channels, older rows) leave it as it is: `Injector` acts them out.
/// `stream` belongs to the fault; draws go by row, so they do not depend on what was drawn before.
double apply(const Fault& fault, const FaultMemory& memory, const Moment& now, double raw, const ChannelLaw& law,
             const Stream& stream) noexcept;

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
