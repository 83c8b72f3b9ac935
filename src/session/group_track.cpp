#include "plumb/session/group_track.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

io::FileExpected<void> GroupTrack::take(const Sample& sample, const Verdict& verdict) {
  if (fill_ == 0 || verdict.block_fill == 1) begin_s_ = sample.time_s;
  fill_ = verdict.block_fill;
  if (fill_ > 0) return {};
  TrackPoint block;
  block.begin_s = begin_s_;
  block.end_s = sample.time_s;
  block.usable = verdict.validity >= Validity::degraded && verdict.protection_available && !verdict.alert &&
                 norm(verdict.gravity_mps2) > 0.0;
  block.vector = verdict.gravity_mps2;
  const Mat3& c = verdict.covariance;
  block.sigma = std::sqrt(std::fmax(c[0], std::fmax(c[4], c[8])));
  block.bound_rad = verdict.protection_level_housing_rad;
  io::FileExpected<void> done;
  for (TrackListener* listener : listeners_) {
    if (done) done = verdict.tick ? listener->rested(block) : listener->moved(block.end_s);
  }
  return done;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
