#include "plumb/scenario/noise.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

double quantised(double raw, double resolution) noexcept {
  if (!(resolution > 0.0) || !std::isfinite(raw)) return raw;
  return std::floor(raw / resolution + 0.5) * resolution;
}

double clipped(double raw, double full_scale) noexcept {
  if (!(full_scale > 0.0)) return raw;
  if (raw > full_scale) return full_scale;
  if (raw < -full_scale) return -full_scale;
  return raw;
}

double digitised(double raw, const DatasheetSensor& sensor, const NoiseLaw& law) noexcept {
  // Clipping comes last, so that full scale is delivered exactly even where it is not a whole step.
  const double stepped = law.quantise ? quantised(raw, sensor.resolution_raw) : raw;
  return law.clip ? clipped(stepped, sensor.full_scale_raw) : stepped;
}

Vec3 vibration(const Stream& stream, std::uint64_t row, double rms_mps2) noexcept {
  return {rms_mps2 * stream.normal(3 * row), rms_mps2 * stream.normal(3 * row + 1),
          rms_mps2 * stream.normal(3 * row + 2)};
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
