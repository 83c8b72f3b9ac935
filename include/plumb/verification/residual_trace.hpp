/// What every sensor says beside the others at rest, over a run: for the charts of the health report.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "plumb/array/geometry.hpp"
#include "plumb/calibration/sensor_model.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

/// Some blocks at rest in a row. Of each sensor the reading less what the sensors in service say along its axis, in the
/// block of them in which that was largest; NaN where it had no reading, or too few sensors were in service.
struct ResidualPoint {
  double time_s = 0.0;
  double depth_m = std::numeric_limits<double>::quiet_NaN();  ///< last known
  Readings off_mps2{};
};

/// Keeps at most kMostPoints points however long the run is: each stands for more blocks then.
class ResidualTrace {
 public:
  static constexpr std::size_t kMostPoints = 512;

  /// `array`: the axes that the readings of `model` are along. A block is the mean of the last `window` samples.
  ResidualTrace(const SensorModel& model, const SensorArray& array, int window);

  void take(const Sample& sample, const Verdict& verdict, double depth_m);
  const std::vector<ResidualPoint>& points() const noexcept { return points_; }

 private:
  Readings mean_of_window() const;
  ResidualPoint point_of(const Verdict& verdict, double depth_m) const;
  void halve();

  SensorModel model_;
  SensorArray array_;
  std::vector<Readings> window_;
  std::size_t samples_ = 0;
  std::vector<ResidualPoint> points_;
  std::size_t blocks_per_point_ = 1;
  std::size_t in_last_ = 0;  ///< blocks in the last point
};

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
