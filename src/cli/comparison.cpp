#include "comparison.hpp"

#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

double inclination_or_nan(const Vec3& gravity_mps2, const Mat3& frame) {
  double inclination_deg = 0.0;
  return report::inclination_of(gravity_mps2, frame, inclination_deg) ? inclination_deg : std::nan("");
}

}  // namespace

ComparisonSink::ComparisonSink(const io::ArrayFile& array, const Calibration& calibration,
                               const std::vector<scenario::Truth>& truth)
    : array_(array),
      calibration_(calibration),
      truth_(truth),
      all_(least_squares(calibration.array, calibration.array.all())),
      window_(static_cast<std::size_t>(array.monitor.window)) {}

Readings ComparisonSink::mean_of_window() const {
  Readings mean{};
  for (const Readings& y : window_) {
    for (std::size_t i = 0; i < y.size(); ++i) mean[i] += y[i] / static_cast<double>(window_.size());
  }
  return mean;
}

io::FileExpected<void> ComparisonSink::take(const Sample& sample, const Verdict& verdict) {
  if (row_ == 0) {
    timeline_.begin_s = sample.time_s;
    timeline_.rows.push_back(report::power_on_row(sample.time_s, HealthState::suspect));
  }
  const scenario::Truth& truth = truth_[row_ < truth_.size() ? row_ : truth_.size() - 1];
  window_[row_ % window_.size()] = calibration_.model.apply(sample.raw, sample.temperature_degc, sample.delivered);
  ++row_;
  if (!truth.faulty.empty() && sample.time_s < fault_s_) fault_s_ = sample.time_s;
  timeline_.end_s = sample.time_s;
  if (verdict.transition.sequence != 0)
    timeline_.rows.push_back(report::row_of(verdict, calibration_.array, array_.output_frame));
  if (!verdict.tick) return {};
  report::TimelinePoint point;
  point.time_s = verdict.time_s;
  point.state = verdict.state;
  point.validity = verdict.validity;
  point.cause = verdict.cause;
  point.sensors_in_service = verdict.in_service.size();
  point.statistic = verdict.statistic;
  point.limit = verdict.limit;
  point.inclination_true_deg = inclination_or_nan(truth.gravity_mps2, array_.output_frame);
  point.inclination_plumb_deg = inclination_or_nan(verdict.gravity_mps2, array_.output_frame);
  point.inclination_plain_deg = inclination_or_nan(all_.estimate(mean_of_window()), array_.output_frame);
  point.protection_level_deg = verdict.protection_available ? deg_from_rad(verdict.protection_level_rad) : std::nan("");
  timeline_.points.push_back(point);
  return {};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
