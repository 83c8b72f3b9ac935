/// Are the axes of the two triads the same axes?
#pragma once

#include <array>
#include <string>
#include <vector>

#include "plumb/survey/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// Exchanging axes, or turning their signs, leaves the length of either vector as it is; the dip shows it. A change of
/// both triads alike leaves the dip too: which of the two is wired otherwise cannot be told.
struct WiringStudy {
  double rms_as_is_rad = 0.0;  ///< of dip minus reference, over the stations
  double rms_best_rad = 0.0;   ///< of the best of the 48 ways to name the axes of the magnetometers
  std::array<int, 3> axis{
      {0, 1, 2}};  ///< that way: component k is sign[k] times the magnetometer axis[k] of the readings
  std::array<int, 3> sign{{1, 1, 1}};
  bool swapped = false;  ///< the readings do not fit, that way does, and no other comes near

  /// "x and y of one triad are exchanged", or the assignment of all axes; empty where nothing is swapped.
  std::string text() const;
};

/// Says `swapped` where the dip is off by more than three times what noise, tool and reference allow (rms), another
/// naming brings it within, to a quarter at least, and the next best is twice as far off as that.
WiringStudy study_wiring(const std::vector<ReferencedStation>& stations, const ToolErrors& tool);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
