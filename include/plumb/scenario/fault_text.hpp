/// Faults as short strings for the command line and scenario files, and as sentences for reports.
///
///   SENSOR:KIND[=SIZE]@ONSET[+DURATION]
///
///   a2:stuck=0V@12s           stands at 0 V from t = 12 s on; also 3V, -3V, FS, -FS, 12count, 1g0
///   a3:last@5s                stands at its last value; last=0.5LSB dithers by that much about it
///   a1:random=-3V..3V@20s     a new random value every row; held= draws one value and keeps it
///   a2:bias=50mg0@30s+10s     reads 50 mg0 too much for ten seconds
///   a1:drift=1mg0/s@10s       error grows; also per min, per h
///   a4:scale=1.1@10s          scale factor times 1.1
///
/// SENSOR is an id, or the number of a sensor counted from 1 where no id reads like it. ONSET is a time
/// (s, ms, us, min, h) on the log's own time axis, `#5` the fifth row, `station6` the sixth station;
/// DURATION the same way (+10s, +#100, +station2).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/config.hpp"
#include "plumb/scenario/fault.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// What the text of a fault is read against: ids, scale factors and ranges, and the unit of the log.
struct FaultContext {
  enum class Raw : std::uint8_t { voltage, count, acceleration };
  Datasheet datasheet;
  Raw raw = Raw::voltage;
  double base_per_raw = 1.0;   ///< V, count or m/s^2 per raw unit of the log
  std::string raw_unit = "V";  ///< its name
};

/// Errors are texts that say what was found and end in a remedy.
tl::expected<Fault, std::string> parse_fault(std::string_view text, const FaultContext& context);

/// The inverse: parses back to the identical value (the fault must pass `check`). Levels are given in
/// the unit of the log.
std::string to_text(const Fault& fault, const FaultContext& context);

/// "a2 stands at 0 V".
std::string describe_effect(const Fault& fault, const FaultContext& context);

/// "a2 stands at 0 V from t = 12 s on".
std::string describe(const Fault& fault, const FaultContext& context);

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
