#include "plumb/session/motion_trace.hpp"

#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

MotionPoint point_of(const MotionVerdict& verdict) {
  const SpecificForce& block = verdict.block;
  MotionPoint out;
  out.time_s = block.time_s;
  const bool known = block.validity != ForceValidity::none;
  out.force_mps2 = known ? norm(block.force_mps2) : std::numeric_limits<double>::quiet_NaN();
  out.bound_mps2 = known ? block.bound_mps2 : std::numeric_limits<double>::infinity();
  out.used = known ? block.used.size() : 0;
  return out;
}

MotionPoint worse_of(const MotionPoint& a, const MotionPoint& b) {
  MotionPoint out = b.bound_mps2 > a.bound_mps2 ? b : a;
  out.alarm = a.alarm || b.alarm;
  return out;
}

}  // namespace

void MotionTrace::halve() {
  for (std::size_t k = 0; k < points_.size() / 2; ++k) points_[k] = worse_of(points_[2 * k], points_[2 * k + 1]);
  points_.resize(points_.size() / 2);
  blocks_per_point_ *= 2;
}

io::FileExpected<void> MotionTrace::take(double, const MotionVerdict& verdict,
                                         const std::vector<io::MotionEvent>& events) {
  events_.insert(events_.end(), events.begin(), events.end());
  alarm_ = alarm_ || verdict.alarm;  // one may begin and end between two blocks
  if (!verdict.block_ended) return {};
  MotionPoint point = point_of(verdict);
  point.alarm = alarm_;
  alarm_ = false;
  if (!points_.empty() && in_last_ < blocks_per_point_) {
    points_.back() = worse_of(points_.back(), point);
    ++in_last_;
    return {};
  }
  if (points_.size() == kMostPoints) halve();
  points_.push_back(point);
  in_last_ = 1;
  return {};
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
