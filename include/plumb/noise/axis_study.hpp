/// All that a log at rest says of the noise of one column.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "plumb/noise/allan.hpp"
#include "plumb/noise/fit.hpp"
#include "plumb/noise/spectrum.hpp"
#include "plumb/noise/still_log.hpp"
#include "plumb/noise/whiteness.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

struct AxisStudy {
  std::string name;
  Stretch stretch;  ///< without its readings; where it is refused, nothing below holds
  std::size_t readings = 0;
  double duration_s = 0.0;
  double mean = 0.0;  ///< of the readings
  std::vector<AllanPoint> allan;
  NoiseFit fit;
  Spectrum spectrum;
  Whiteness whiteness;
};

struct StudyOptions {
  std::size_t block = 32;  ///< samples that the monitor averages
  int per_octave = 4;      ///< averaging times of the Allan deviation
};

/// Readings in the unit in which the results are to be.
AxisStudy study_axis(const StillLog& log, std::size_t column, const StudyOptions& options);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
