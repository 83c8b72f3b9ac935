#include "comparison.hpp"

#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

double inclination_or_nan(const Vec3& gravity_mps2, const Mat3& frame) {
  double inclination_deg = 0.0;
  return render::inclination_of(gravity_mps2, frame, inclination_deg) ? inclination_deg : std::nan("");
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

void ComparisonSink::note_phase(const Sample& sample, const Verdict& verdict, SensorSet faulty) {
  render::TimelinePhase now;
  now.from_s = sample.time_s;
  now.state = verdict.state;
  now.validity = verdict.validity;
  now.cause = verdict.cause;
  now.moving = (verdict.qualifiers & Qualifier::moving) != 0;
  now.in_service = verdict.in_service;
  now.provisionally_excluded = verdict.provisionally_excluded;
  now.excluded = verdict.excluded;
  now.absent = verdict.absent;
  now.faulty = faulty;
  if (!timeline_.phases.empty()) {
    const render::TimelinePhase& last = timeline_.phases.back();
    const bool same = last.state == now.state && last.validity == now.validity && last.cause == now.cause &&
                      last.moving == now.moving && last.in_service == now.in_service &&
                      last.provisionally_excluded == now.provisionally_excluded && last.excluded == now.excluded &&
                      last.absent == now.absent && last.faulty == now.faulty;
    if (same) return;
  }
  timeline_.phases.push_back(now);
}

render::TimelinePoint ComparisonSink::point_of(const Verdict& verdict, const scenario::Truth& truth) const {
  const Vec3 plain_mps2 = all_.estimate(mean_of_window());
  render::TimelinePoint point;
  point.time_s = verdict.time_s;
  point.state = verdict.state;
  point.validity = verdict.validity;
  point.cause = verdict.cause;
  point.in_service = verdict.in_service;
  point.provisionally_excluded = verdict.provisionally_excluded;
  point.excluded = verdict.excluded;
  point.absent = verdict.absent;
  point.statistic = verdict.statistic;
  point.limit = verdict.limit;
  point.inclination_true_deg = inclination_or_nan(truth.gravity_mps2, array_.output_frame);
  point.inclination_plumb_deg = inclination_or_nan(verdict.gravity_mps2, array_.output_frame);
  point.inclination_plain_deg = inclination_or_nan(plain_mps2, array_.output_frame);
  point.norm_error_plumb_mps2 = verdict.norm_error_mps2;
  point.norm_error_plain_mps2 = norm(plain_mps2) - array_.gravity.g_mps2;
  point.protection_level_deg =
      verdict.protection_available ? deg_from_rad(verdict.protection_level_calibrated_axes_rad) : std::nan("");
  return point;
}

io::FileExpected<void> ComparisonSink::take(const Sample& sample, const Verdict& verdict) {
  if (row_ == 0) {
    timeline_.begin_s = sample.time_s;
    timeline_.rows.push_back(render::power_on_row(sample.time_s, HealthState::suspect));
    for (int i = 0; i < calibration_.array.size(); ++i) {
      timeline_.sensors.emplace_back(calibration_.array.row(i).id.data());
    }
  }
  const scenario::Truth& truth = truth_[row_ < truth_.size() ? row_ : truth_.size() - 1];
  window_[row_ % window_.size()] = calibration_.model.apply(sample.raw, sample.temperature_degc, sample.delivered);
  ++row_;
  timeline_.end_s = sample.time_s;
  note_phase(sample, verdict, truth.faulty);
  if (verdict.transition.sequence != 0)
    timeline_.rows.push_back(render::row_of(verdict, calibration_.array, array_.output_frame));
  if (verdict.tick) timeline_.points.push_back(point_of(verdict, truth));
  return {};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
