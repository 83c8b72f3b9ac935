/// What reading and writing of faults share: which numbers stand behind the '=' of a kind (private to src/scenario).
#pragma once

#include <string>

#include "plumb/scenario/fault_text.hpp"
#include "quantity_text.hpp"

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
SizeForm form_of(FaultKind kind) noexcept;

std::string id_of(const FaultContext& context, int sensor);
TextUnits level_units(const FaultContext& context, int sensor);

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
