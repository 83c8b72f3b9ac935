/// Channels that say nothing in a whole log, or what another one says.
#pragma once

#include <vector>

#include "plumb/core/sample.hpp"
#include "plumb/io/log_reader.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// What a reader would have counted in these samples of `sensors` channels.
io::LogStatistics statistics_of(const std::vector<Sample>& samples, int sensors);

/// Whether a sensor said nothing in the whole log, or the same in every row.
bool dead_channel(const io::LogStatistics& log, int sensor);

/// Of so many sensors the one whose channel is a copy of this one's; -1 where none is.
int twin_channel(const std::vector<Station>& stations, int sensors, int sensor);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
