/// Is a channel at the end of its range, or stuck?
#pragma once

#include <string>
#include <vector>

#include "plumb/survey/checks.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// One component that reads its largest value at several stations, exactly, all of which fail a check of its triad,
/// while the tool turned in between: the other two moved by more than 2 % of the triad's length.
struct SaturatedChannel {
  std::size_t component = 0;  ///< Gx, Gy, Gz, Bx, By, Bz
  double value = 0.0;         ///< [m/s^2] or [tesla], with its sign
  int stations = 0;           ///< that read it

  /// "bx reads 60000 nT at 4 stations, its largest, and all of them fail: it is saturated or stuck".
  std::string text() const;
};

/// `measured` are the readings, before anything is taken off; `judged` the same stations. Three equal readings at the
/// least: fewer meet by chance where readings are rounded, and those of a good station are never accused.
std::vector<SaturatedChannel> saturated_channels(const std::vector<Measurement>& measured,
                                                 const std::vector<SurveyStation>& judged);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
