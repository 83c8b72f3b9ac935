/// Faults as short strings for the command line and scenario files, and as sentences for reports.
///
///   SENSOR:KIND[=SIZE]@ONSET[+DURATION]
///
///   a2:stuck=0V@12s           stands at 0 V from t = 12 s on; also 3V, -3V, FS, -FS, 12count, 1g0
///   a3:last@5s                stands at its last value; last=0.5LSB dithers by that much about it
///   a1:random=-3V..3V@20s     a new random value every row; held= draws one value and keeps it
///   a2:bias=50mg0@30s+10s     reads 50 mg0 too high for ten seconds
///   a1:drift=1mg0/s@10s       error grows; also per min, per h
///   a4:scale=1.1@10s          scale factor times 1.1; scale=-1 is a reversed wire
///   a2:noise=5mg0@10s         white noise on top
///   a2:spikes=0.5g0*1%@10s    one row in a hundred is off by so much
///   a2:chatter=50mg0*10s@60s  a bias that comes and goes every ten seconds
///   a2:warmup=2mg0*5min@0s    an error that fades away
///   a2:clip=-1V..4V@10s       limited, not alike on both sides
///   a2:coarse=16LSB@10s       low bits lost; bit=12 inverts bit 12; pattern=nan, inf, huge, denormal, -0
///   a2:missing=30%@10s        does not deliver; late=5 comes five rows late, slow=10 changes every tenth row only
///   a2:exchange=a3@10s        two channels have changed places; cross=a3*1% picks up some of a3
///   a2:turned=2deg*90deg@10s  axis turned; ghost=5deg shows a turned gravity, mirror=a1*a3 a mirrored one
///   log:shake=0.1g0@10s       the whole log: gravity=3mg0, temperature=20degC, drop=10%, repeat, swap, late=5, back=2s
///
/// In the place of KIND a name of the fault catalogue may stand (`a2:F04@12s`, `a2:off@12s`): see catalogue.hpp.
///
/// SENSOR is an id, or the number of a sensor counted from 1 where no id reads like it. ONSET is a time
/// (s, ms, us, min, h) on the log's own time axis, `#5` the fifth row, `station6` the sixth station;
/// DURATION the same way (+10s, +#100, +station2).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/config.hpp"
#include "plumb/scenario/fault.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// What the text of a fault is read against: ids, scale factors and ranges, and the unit of the log.
struct FaultContext {
  enum class Raw : std::uint8_t { voltage, count, acceleration };
  /// What the sensors measure. Of others than gravity "acceleration" is a magnetic field in units of 4 uT or a rate in
  /// rad/s (plumb/io/field.hpp).
  enum class Vector : std::uint8_t { gravity, magnetic, rate };
  Datasheet datasheet;
  Raw raw = Raw::voltage;
  Vector vector = Vector::gravity;
  double base_per_raw = 1.0;   ///< V, count or m/s^2 per raw unit of the log
  std::string raw_unit = "V";  ///< its name
};

/// Errors are texts that say what was found and end in a remedy.
tl::expected<Fault, std::string> parse_fault(std::string_view text, const FaultContext& context);

/// The same where a name of the fault catalogue may stand for several faults.
tl::expected<std::vector<Fault>, std::string> parse_faults(std::string_view text, const FaultContext& context);

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
