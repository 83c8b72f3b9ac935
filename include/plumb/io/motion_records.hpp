/// What a monitor of motion says, as text: one JSON line per event, one CSV row per sample.
#pragma once

#include <cstdint>
#include <string>

#include "plumb/io/array_file.hpp"
#include "plumb/motion/continuous_inclination.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// What changed in motion.
enum class MotionEventKind : std::uint8_t {
  alarm,           ///< readings contradict each other; `sensors`: in some of the smallest explanations
  isolated,        ///< `sensors` are in every explanation
  excluded,        ///< provisionally, after the dwell
  alarm_over,      ///< nothing that contradicts is on record any longer
  forgotten,       ///< the monitor at rest has judged: exclusions in motion are taken back
  gyros_disagree,  ///< one of the two gyros is faulty
};
const char* to_string(MotionEventKind kind) noexcept;

struct MotionEvent {
  MotionEventKind kind = MotionEventKind::alarm;
  double time_s = 0.0;
  SensorSet sensors;
  MotionCause cause = MotionCause::none;  ///< of an alarm that names nobody
  int least_faults = 0;
};

/// Without a newline at the end, into a string that the caller reuses.
void append_motion_event_json(std::string& out, const MotionEvent& event, const SensorArray& array);

/// The header of `append_inclination_row`, with a newline.
std::string inclination_csv_header();
/// One row with its newline; angles are empty where they are not known.
void append_inclination_row(std::string& out, const InclinationInterval& interval);

/// The header of `append_motion_row`, with a newline.
std::string motion_csv_header();
/// One row with its newline; cells of what is not known are empty. `frame` as in io/records.hpp.
void append_motion_row(std::string& out, double time_s, const MotionVerdict& verdict, const SensorArray& array,
                       const Mat3& frame);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
