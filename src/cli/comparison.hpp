/// Plumb's answer beside the plain one, block by block: what the pictures of the drills show.
#pragma once

#include <vector>

#include "plumb/render/timeline.hpp"
#include "plumb/scenario/scenario.hpp"
#include "plumb/session/monitor_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Records the timeline of a simulated run. "Plain" is least squares over all sensors with the same
/// calibration, on the same samples: what one would have without plumb.
class ComparisonSink : public session::VerdictSink {
 public:
  /// `truth` holds one entry per row of the log. All references must outlive the sink.
  ComparisonSink(const io::ArrayFile& array, const Calibration& calibration, const std::vector<scenario::Truth>& truth);

  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  const render::Timeline& timeline() const noexcept { return timeline_; }

 private:
  Readings mean_of_window() const;
  void note_phase(const Sample& sample, const Verdict& verdict, SensorSet faulty);
  render::TimelinePoint point_of(const Verdict& verdict, const scenario::Truth& truth) const;

  const io::ArrayFile& array_;
  const Calibration& calibration_;
  const std::vector<scenario::Truth>& truth_;
  LeastSquares all_;
  std::vector<Readings> window_;  ///< ring of the last block's readings
  std::size_t row_ = 0;
  render::Timeline timeline_;
};

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
