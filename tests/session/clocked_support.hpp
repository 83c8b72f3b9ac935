/// Flights of the example with clocks of its chips, as rows that a host logs.
#pragma once

#include "motion_support.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/session/motion_watch.hpp"

namespace clocked_support {

inline std::string clocked_text() {
  return plumb_test::read_text(PLUMB_SOURCE_DIR "/examples/motion/drone_clocks.toml");
}

/// Hears every verdict.
class Heard final : public plumb::session::MotionSink {
 public:
  plumb::io::FileExpected<void> take(double time_s, const plumb::MotionVerdict& verdict,
                                     const std::vector<plumb::io::MotionEvent>& some) override {
    times_s.push_back(time_s);
    events.insert(events.end(), some.begin(), some.end());
    last = verdict;
    return {};
  }
  std::vector<double> times_s;
  std::vector<plumb::io::MotionEvent> events;
  plumb::MotionVerdict last;
};

}  // namespace clocked_support
