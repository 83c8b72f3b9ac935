#include "plumb/findings/dead_channel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

io::LogStatistics statistics_of(const std::vector<Sample>& samples, int sensors) {
  io::LogStatistics log;
  for (const Sample& sample : samples) {
    for (int i = 0; i < sensors; ++i) {
      const auto a = static_cast<std::size_t>(i);
      const double value = sample.raw[a];
      if (!sample.delivered.has(i)) {
        ++log.missing[a];
      } else if (!std::isfinite(value)) {
        ++log.not_finite[a];
      } else {
        if (log.missing[a] + log.not_finite[a] == log.rows) log.first_value[a] = value;
        if (value != log.first_value[a]) log.varied = log.varied.with(i);
      }
    }
    ++log.rows;
  }
  return log;
}

bool dead_channel(const io::LogStatistics& log, int sensor) {
  const auto a = static_cast<std::size_t>(sensor);
  const std::uint64_t told = log.rows - log.missing[a] - log.not_finite[a];
  return log.rows > 1 && (told == 0 || (told > 1 && !log.varied.has(sensor)));
}

int twin_channel(const std::vector<Station>& stations, int sensors, int sensor) {
  for (int i = 0; i < sensors && sensor >= 0 && !stations.empty(); ++i) {
    const auto differs = [i, sensor](const Station& s) {
      return s.mean[static_cast<std::size_t>(i)] != s.mean[static_cast<std::size_t>(sensor)];
    };
    if (i != sensor && std::none_of(stations.begin(), stations.end(), differs)) return i;
  }
  return -1;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
