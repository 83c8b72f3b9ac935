/// A log in motion, read whole for a fit (private to this module).
#pragma once

#include <vector>

#include "plumb/io/log_reader.hpp"
#include "plumb/session/log_spec.hpp"
#include "plumb/session/motion_inputs.hpp"
#include "plumb/session/motion_plan.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

struct MotionFlight {
  std::vector<MotionSample> samples;
  MotionInputs inputs;
  io::LogStatistics log;
  SensorSet clipped;
};

/// Samples as a monitor of `plan` takes them. Errors: those of the log, and more rows than kMostCommissionRows.
io::FileExpected<MotionFlight> read_flight(const io::ArrayFile& array, const MotionPlan& plan, const LogSpec& log);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
