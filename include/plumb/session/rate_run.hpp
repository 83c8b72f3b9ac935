/// A log through the monitor of redundant gyros.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plumb/io/array_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/motion/rate_monitor.hpp"
#include "plumb/session/group_track.hpp"
#include "plumb/session/log_spec.hpp"
#include "plumb/session/rate_group.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Something changed at this sample.
struct RateEvent {
  double time_s = 0.0;
  SensorSet suspects, excluded, off_at_rest;  ///< as they are from now on
  bool turned_at_rest = false;
  MotionCause cause = MotionCause::none;
};

inline constexpr double kSilent_s = 1.0;

struct RateRun {
  RateVerdict last;
  std::uint64_t samples = 0, samples_at_rest = 0, blocks = 0;
  SensorSet ever_excluded, ever_off_at_rest;
  SensorSet silent;                ///< no number from them for `kSilent_s` at the end
  double silent_s = 0.0;           ///< the shortest of these
  int turned_at_rest = 0;          ///< times that this was found anew
  double turned_at_rest_s = 0.0;   ///< when first
  double worst_bound_radps = 0.0;  ///< of the means of two blocks, where they were valid
  double bound_sum_radps = 0.0;
  std::uint64_t bounded_blocks = 0;
  std::vector<RateEvent> events;
  io::LogStatistics log;
  bool calibrated = false;
  double common = 0.0;  ///< `RateGroup::common`: in the bounds
  bool interrupted = false, stopped = false;
  io::FileError stop;
};

/// A row of a log as `RateMonitor` takes it, force and rest not known. `model`: that of the datasheet in `array`, or
/// of its calibration.
RateSample rate_sample(const io::ArrayFile& array, const SensorModel& model, const Sample& sample);

/// `rest`: when the tool stands still, by its accelerometers; null: not known. Readings, axes and bounds are those of
/// the calibration; null: of the datasheet in the array file, bias and scale as stated there. Errors: the log cannot be
/// opened; the monitor refuses the setup.
io::FileExpected<RateRun> run_rates(const io::ArrayFile& array, const LogSpec& log, RestTimes* rest,
                                    const io::GyroCalibration* calibration = nullptr);

/// One line of JSON, without a newline.
std::string rate_event_json(const RateEvent& event, const SensorArray& array);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
