/// What one group of sensors measures while the tool stands still, block by block, for what is beside it.
#pragma once

#include <vector>

#include "plumb/session/monitor_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// A block at rest.
struct TrackPoint {
  double begin_s = 0.0, end_s = 0.0;  ///< of its first row and its last
  bool usable = false;                ///< the direction may be used, and its error has a bound
  Vec3 vector{};                      ///< tool frame, inside units
  double sigma = 0.0;                 ///< the largest of its components, noise and calibration
  double bound_rad = 0.0;             ///< of the direction in the housing (`Verdict::protection_level_housing_rad`)

  /// The tool stood in one attitude through both.
  bool meets(const TrackPoint& other) const noexcept { return begin_s <= other.end_s && other.begin_s <= end_s; }
};

class TrackListener {
 public:
  TrackListener() = default;
  TrackListener(const TrackListener&) = delete;
  TrackListener& operator=(const TrackListener&) = delete;
  virtual ~TrackListener() = default;
  virtual io::FileExpected<void> rested(const TrackPoint& block) = 0;
  /// The block that ended at this time was not at rest.
  virtual io::FileExpected<void> moved(double) { return {}; }
};

class GroupTrack final : public VerdictSink {
 public:
  void tell(TrackListener& listener) { listeners_.push_back(&listener); }
  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;

 private:
  std::vector<TrackListener*> listeners_;
  double begin_s_ = 0.0;
  int fill_ = 0;  ///< of the block so far
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
