#include "plumb/verification/residual_trace.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

ResidualPoint larger_of(const ResidualPoint& a, const ResidualPoint& b) {
  ResidualPoint out = a;
  for (std::size_t i = 0; i < out.off_mps2.size(); ++i) {
    if (!(std::fabs(out.off_mps2[i]) >= std::fabs(b.off_mps2[i])) && std::isfinite(b.off_mps2[i]))
      out.off_mps2[i] = b.off_mps2[i];
  }
  return out;
}

}  // namespace

ResidualTrace::ResidualTrace(const SensorModel& model, const SensorArray& array, int window)
    : model_(model), array_(array), window_(static_cast<std::size_t>(std::max(1, window))) {}

Readings ResidualTrace::mean_of_window() const {
  const std::size_t filled = std::min(samples_, window_.size());
  Readings mean{};
  for (std::size_t k = 0; k < filled; ++k) {
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += window_[k][i] / static_cast<double>(filled);
  }
  return mean;
}

ResidualPoint ResidualTrace::point_of(const Verdict& verdict, double depth_m) const {
  ResidualPoint out;
  out.time_s = verdict.time_s;
  out.depth_m = depth_m;
  out.off_mps2.fill(std::numeric_limits<double>::quiet_NaN());
  Readings mean = mean_of_window();
  SensorSet in_service;
  for (int i = 0; i < array_.size(); ++i) {
    double& reading = mean[static_cast<std::size_t>(i)];
    if (verdict.in_service.has(i) && std::isfinite(reading)) in_service = in_service.with(i);
  }
  const LeastSquares fit = least_squares(array_, in_service);
  if (!fit.valid) return out;
  Readings used = mean;
  for (int i = 0; i < array_.size(); ++i) {
    if (!in_service.has(i)) used[static_cast<std::size_t>(i)] = 0.0;  // a NaN would go through a weight of zero
  }
  const Vec3 vector_mps2 = fit.estimate(used);
  for (int i = 0; i < array_.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    out.off_mps2[a] = mean[a] - dot(array_.axis(i), vector_mps2);
  }
  return out;
}

void ResidualTrace::halve() {
  for (std::size_t k = 0; k < points_.size() / 2; ++k) points_[k] = larger_of(points_[2 * k], points_[2 * k + 1]);
  points_.resize(points_.size() / 2);
  blocks_per_point_ *= 2;
}

void ResidualTrace::take(const Sample& sample, const Verdict& verdict, double depth_m) {
  Readings& slot = window_[samples_ % window_.size()];
  slot = model_.apply(sample.raw, sample.temperature_degc, sample.delivered);
  for (int i = 0; i < array_.size(); ++i) {
    if (!sample.delivered.has(i)) slot[static_cast<std::size_t>(i)] = std::numeric_limits<double>::quiet_NaN();
  }
  ++samples_;
  if (!verdict.tick) return;
  const ResidualPoint point = point_of(verdict, depth_m);
  if (!points_.empty() && in_last_ < blocks_per_point_) {
    points_.back() = larger_of(points_.back(), point);
    ++in_last_;
    return;
  }
  if (points_.size() == kMostPoints) halve();
  points_.push_back(point);
  in_last_ = 1;
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
