/// The kinds of faults as one table: word, whom a kind may strike, how its size is written, what the size must be, and
/// the sentence for reports (private to src/scenario). What a kind does to a reading is its effect: `apply` in
/// fault.cpp, or, where it needs other channels, older rows or the clock, `Injector` and `Delivery`.
#pragma once

#include <cstdint>

#include "plumb/scenario/fault.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// How the size of a kind is written.
enum class SizeForm : std::uint8_t {
  none,                ///< nothing
  level,               ///< "3V"
  dither,              ///< nothing, or "0.5LSB"
  step,                ///< "16LSB"
  range,               ///< "-3V..3V"
  acceleration,        ///< "50mg0"
  drift,               ///< "1mg0/s"
  factor,              ///< "1.1"
  share,               ///< nothing (all), or "30%"
  count,               ///< "5"
  pattern,             ///< "nan"
  sensor,              ///< "a3"
  temperature,         ///< "20degC"
  time,                ///< "2s"
  acceleration_share,  ///< "0.5g0*1%"
  acceleration_time,   ///< "50mg0*10s"
  sensor_share,        ///< "a3*1%"
  angle_angle,         ///< "2deg", or "2deg*90deg"
  sensor_sensor,       ///< "a1*a3"
};

/// Whom a kind strikes.
enum class Strikes : std::uint8_t {
  channel,          ///< one sensor
  tool,             ///< all of them: sensor = kWholeLog
  link,             ///< which rows come, in which order, with which times: kWholeLog
  channel_or_link,  ///< one sensor, or with kWholeLog the link
};

/// What the numbers of a fault must be, and what is said where they are not.
struct SizeRule {
  bool (*holds)(const Fault& fault, int sensors) noexcept;
  const char* otherwise;
};

struct FaultKindRow {
  FaultKind kind;
  const char* word;  ///< on the command line
  Strikes strikes;
  SizeForm form;
  SizeRule rule;
  /// What the channel, or the log, does, in words that follow its id. {} is the size as written, {1} and {2} its parts,
  /// {all} the share or "all", {rows} a count of rows. Text in [ ] is omitted where its size is empty.
  const char* sentence;
};

const FaultKindRow& row_of(FaultKind kind) noexcept;

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
