/// Which value of a fit no sensor can have.
#pragma once

#include <cstdint>

#include "plumb/calibration/calibration.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

struct WorstValue {
  enum class Of : std::uint8_t { nothing, scale, axis, bias };
  Of of = Of::nothing;
  int sensor = -1;
  double value = 0.0;  ///< scale: times that of the datasheet; axis: angle from the nominal one [rad]; bias [m/s^2]
  double bound = 0.0;  ///< scale: relative change; else as the value
};

/// The value that is farthest beyond its bound. One sensor that is far off turns the axes of all others a little, so
/// the first one beyond its bound need not be the faulty sensor.
WorstValue worst_value(const io::ArrayFile& array, const Calibration& fit, const FitOptions& bound);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
