// What the host could do about doubt: which turn would tell the live explanations apart.
#include <cmath>

#include "block_view.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

/// Unproven: the sensor whose prediction has moved least must be moved by what is missing.
RotationRequest HealthMonitor::proving_turn() const noexcept {
  RotationRequest out;
  out.wanted = true;
  out.angle_rad = config_.excitation_angle_rad;
  if (!have_evidence_) return out;
  double worst = 0.0;
  for (int i = 0; i < array_.size(); ++i) {
    if (!in_service_.has(i)) continue;
    const auto a = static_cast<size_t>(i);
    const double moved = have_predictions_ ? static_cast<double>(most_prediction_[a] - least_prediction_[a]) : 0.0;
    const double missing = proving_change_mps2(i) - moved;
    if (missing <= worst) continue;
    worst = missing;
    out.along = times(frame_, array_.axis(i));
    out.change_mps2 = missing;
  }
  return out;
}

/// The pair of live explanations that is hardest to tell apart: sensor i at fault by f, sensor j accused instead. The
/// rest without j answers f w too far, w being its column for i; its length gives it away elsewhere.
RotationRequest HealthMonitor::resolving_turn() const noexcept {
  RotationRequest out;
  out.wanted = true;
  out.angle_rad = config_.excitation_angle_rad;
  if (scan_.least != 1 || !have_evidence_) return out;
  const SensorSet posed = isolation_.posed() & evidence_.usable;
  const SensorSet accused = scan_.suspects & posed;
  for (int j = 0; j < array_.size(); ++j) {
    if (!accused.has(j)) continue;
    const SensorSet rest = posed.without(j);
    const SetTest wrong = test_set(array_, gravity_, limits_, evidence_, rest);
    if (!wrong.tested) continue;
    const LeastSquares map = least_squares(array_, rest);
    const double margin = 2.0 * wrong.norm_reject_limit(limits_) * wrong.norm_sigma_mps2 / std::sqrt(evidence_.samples);
    for (int i = 0; i < array_.size(); ++i) {
      if (!accused.has(i) || i == j) continue;
      const auto a = static_cast<size_t>(i);
      const LeastSquares others = least_squares(array_, posed.without(i));
      if (!others.valid) continue;
      const double fault = evidence_.mean_mps2[a] - dot(array_.axis(i), others.estimate(evidence_.mean_mps2));
      const double reach = std::fabs(fault) * norm(map.column[a]);
      if (!(reach > 0.0)) continue;
      const double change = margin * gravity_.g_mps2 / reach;
      if (change <= out.change_mps2) continue;
      out.change_mps2 = change;
      out.along = times(frame_, scaled(map.column[a], 1.0 / norm(map.column[a])));
    }
  }
  return out;
}

RotationRequest HealthMonitor::rotation_request() const noexcept {
  if (mode_ == Mode::suspect && episode_.open) {
    return answer_.contradiction ? RotationRequest{} : resolving_turn();  // no turn explains what nothing explains
  }
  if (mode_ == Mode::suspect && unproven_) return proving_turn();
  return {};
}

}  // namespace PLUMB_ABI
}  // namespace plumb
