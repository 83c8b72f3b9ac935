// What the health report holds of motion, in its data file.
#include <cmath>

#include "plumb/render/motion_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

io::Json finite(double value) { return std::isfinite(value) ? io::Json(value) : io::Json(); }

io::Json event_json(const io::MotionEvent& event, const SensorArray& array) {
  return io::object({{"t_s", event.time_s},
                     {"event", to_string(event.kind)},
                     {"sensors", io::ids_of(event.sensors, array)},
                     {"why", event_words(event)}});
}

io::Json point_json(const session::MotionPoint& point) {
  return io::object({{"t_s", point.time_s},
                     {"force_mps2", finite(point.force_mps2)},
                     {"bound_mps2", finite(point.bound_mps2)},
                     {"alarm", point.alarm},
                     {"sensors_used", point.used}});
}

}  // namespace

io::Json motion_report_json(const MotionTold& told, const session::MotionTrace& trace, const io::ArrayFile& array) {
  if (!told.any()) return io::Json();
  io::Json out = motion_json(told, array);
  if (told.run == nullptr) return out;
  out["events"] = io::Json::array();
  for (const io::MotionEvent& event : trace.events()) out["events"].push_back(event_json(event, array.array));
  out["trace"] = io::Json::array();
  for (const session::MotionPoint& point : trace.points()) out["trace"].push_back(point_json(point));
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
