/// What a fit of gyros is held against: its residuals, what they are made of, and the monitor (private to this module).
#pragma once

#include "plumb/session/gyro_commissioning.hpp"
#include "plumb/session/rate_group.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Samples [begin, end).
commission::GyroLog part_of(const commission::GyroLog& log, std::size_t begin, std::size_t end);

GyroCheck check_of(const commission::GyroLog& log, const commission::GyroFit& fit, double rate_bound_radps);

GyroLimit limit_of(const commission::GyroLog& log, const commission::GyroFit& fit);

struct GyroReplay {
  bool alarm = false;
  double alarm_s = 0.0;  ///< the first, from the beginning of the log
  SensorSet axes;        ///< suspected, by all alarms
};
/// The log, readings by the datasheet, through `RateMonitor` with `group` of that calibration; of more axes than it
/// takes, the first and the last that it does.
GyroReplay replayed(const RateGroup& group, const io::GyroCalibration& calibration, const commission::GyroLog& log);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
