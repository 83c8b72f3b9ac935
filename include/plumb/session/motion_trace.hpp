/// What a run shows in motion over time, for a picture and a table.
#pragma once

#include <vector>

#include "plumb/session/motion_watch.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Some blocks of 32 samples in a row, by the one of them with the largest bound.
struct MotionPoint {
  double time_s = 0.0;
  double force_mps2 = 0.0;  ///< length of the specific force; NaN where one of the blocks has none
  double bound_mps2 = 0.0;  ///< of its error; infinite where a block has none
  bool alarm = false;       ///< in some of their samples
  int used = 0;             ///< sensors in the force
};

/// Keeps every event, and at most kMostPoints points however long the run is: each stands for more blocks then.
class MotionTrace final : public MotionSink {
 public:
  static constexpr std::size_t kMostPoints = 1024;

  io::FileExpected<void> take(double time_s, const MotionVerdict& verdict,
                              const std::vector<io::MotionEvent>& events) override;
  const std::vector<MotionPoint>& points() const noexcept { return points_; }
  const std::vector<io::MotionEvent>& events() const noexcept { return events_; }

 private:
  void halve();

  std::vector<MotionPoint> points_;
  std::vector<io::MotionEvent> events_;
  std::size_t blocks_per_point_ = 1;
  std::size_t in_last_ = 0;  ///< blocks in the last point
  bool alarm_ = false;       ///< since the last block
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
