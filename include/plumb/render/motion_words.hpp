/// What `plumb monitor` says of motion: a line per event, the section of the summary, the object of --json.
#pragma once

#include <string>
#include <vector>

#include "plumb/io/json_fields.hpp"
#include "plumb/session/motion_trace.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// Of a run: what motion showed, or why it was not judged. Neither: the array file says nothing of motion.
struct MotionTold {
  const session::MotionRun* run = nullptr;
  const MotionSetup* setup = nullptr;  ///< where there is a run
  const io::FileError* refusal = nullptr;
  bool inclination = false;  ///< asked for

  bool any() const noexcept { return run != nullptr || refusal != nullptr; }
};

/// Something about clock or gyro that is not as the array file says.
struct MotionNote {
  const char* code;  ///< for programs
  std::string what, remedy;
};
std::vector<MotionNote> motion_notes(const session::MotionRun& run, const MotionSetup& setup);

/// What it means that nobody is isolated, or that nothing is judged.
const char* explain(MotionCause cause) noexcept;

/// An event in a sentence's part.
std::string event_words(const io::MotionEvent& event);
/// One line in the columns of `table_line`.
std::string motion_line(const io::MotionEvent& event, const SensorArray& array);
/// Lines of the summary; empty where nothing is told.
std::string motion_text(const MotionTold& told, const io::ArrayFile& array);
/// What is to be done about what motion showed.
std::vector<std::string> motion_actions(const MotionTold& told, const io::ArrayFile& array);
io::Json motion_json(const MotionTold& told, const io::ArrayFile& array);
/// The same with the events and how force and bound went, for the health report; null where nothing is told.
io::Json motion_report_json(const MotionTold& told, const session::MotionTrace& trace, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
