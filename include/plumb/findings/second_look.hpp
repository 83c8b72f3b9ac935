/// A refused fit tried again with one mistake of the array file mended at a time: columns exchanged, a sign reversed, a
/// triad turned, a roll group omitted, another roll axis. What then settles is named.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "plumb/calibration/temperature_fit.hpp"
#include "plumb/findings/turned_triad.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

struct SecondLook {
  /// Sensors that have each other's columns; both the same where it is the sign. The best fit first; to gravity some of
  /// these mistakes are the same.
  std::vector<std::pair<int, int>> exchanged;
  /// Triads that are mounted turned, the best fit first. Of two triads each is turned against the other: gravity does
  /// not tell which of them is as the array file says.
  std::vector<TurnedTriad> turned;
  std::vector<std::int64_t> groups;  ///< roll groups, as in the log, without any one of which it settles
  std::optional<Vec3> roll_axis;     ///< about which it settles
  bool without_groups = false;       ///< settles only with all roll groups omitted

  bool found() const { return !exchanged.empty() || !turned.empty() || !groups.empty() || roll_axis || without_groups; }
};

/// All signs and all exchanges of two columns: n (n + 1) / 2 fits; where none of these is it, and there are two triads
/// or more, 47 for each; and, where there are roll groups, at most kMaxRollGroups + 4. Fewer for many sensors over
/// temperature, where all would take minutes: first those that the axes of the refused fit, where there is one,
/// suggest.
SecondLook second_look(const io::ArrayFile& array, const std::vector<Station>& stations,
                       const TemperatureOptions& options, const SensorArray* refused);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
