/// What stands between the acceleration and the number in the log: white noise, the converter's range
/// and step, and vibration of the whole tool.
#pragma once

#include <cstdint>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/scenario/instability.hpp"
#include "plumb/scenario/random.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

struct NoiseLaw {
  double white = 1.0;    ///< times the datasheet's noise of one sample; 0 = none
  bool quantise = true;  ///< round to the datasheet's resolution, where it is known
  bool clip = true;      ///< limit to the datasheet's full scale, where it is known
  InstabilityLaw instability{};
};

/// Nearest multiple of `resolution` (raw unit); unchanged where resolution <= 0 or not finite.
double quantised(double raw, double resolution) noexcept;
/// Limited to +-full_scale (raw unit); unchanged where full_scale <= 0. NaN stays NaN.
double clipped(double raw, double full_scale) noexcept;
/// What the converter of this sensor delivers: quantised, then clipped.
double digitised(double raw, const DatasheetSensor& sensor, const NoiseLaw& law) noexcept;

/// Acceleration of the body at one row [m/s^2], white, `rms_mps2` per axis of the tool frame.
Vec3 vibration(const Stream& stream, std::uint64_t row, double rms_mps2) noexcept;

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
