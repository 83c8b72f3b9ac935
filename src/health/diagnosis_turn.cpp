// What the host could do about doubt: which turn would validate the sensors, or tell the explanations apart.
#include <cmath>

#include "plumb/health/detail/diagnosis.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

/// The sensor whose prediction has moved least must be moved by what is missing.
RotationRequest Diagnosis::validating_turn(const Terms& terms) const noexcept {
  RotationRequest out;
  out.wanted = true;
  out.angle_rad = terms.settings.config.distinct_attitude_angle_rad;
  if (!terms.last.known) return out;
  const SensorArray& array = terms.in_force.array;
  double worst = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!terms.machine.sensors.in_service.has(i)) continue;
    const auto a = static_cast<size_t>(i);
    const double moved = have_predictions_ ? static_cast<double>(most_prediction_[a] - least_prediction_[a]) : 0.0;
    const double missing = proving_change_mps2(terms.in_force, i, terms.last.evidence.samples) - moved;
    if (missing <= worst) continue;
    worst = missing;
    out.along = times(terms.settings.frame, array.axis(i));
    out.change_mps2 = missing;
  }
  return out;
}

/// The pair of consistent explanations that is hardest to tell apart: sensor i at fault by f, sensor j suspected
/// instead. The rest without j answers f w too far, w being its column for i; its length gives it away elsewhere.
RotationRequest Diagnosis::resolving_turn(const Terms& terms) const noexcept {
  RotationRequest out;
  out.wanted = true;
  out.angle_rad = terms.settings.config.distinct_attitude_angle_rad;
  if (scan_.least != 1 || !terms.last.known) return out;
  const SensorArray& array = terms.in_force.array;
  const GravityReference& gravity = terms.in_force.gravity;
  const TestLimits& limits = terms.settings.limits;
  const BlockEvidence& evidence = terms.last.evidence;
  const SensorSet monitored = isolation_.monitored() & evidence.usable;
  const SensorSet suspected = scan_.suspects & monitored;
  for (int j = 0; j < array.size(); ++j) {
    if (!suspected.has(j)) continue;
    const SensorSet rest = monitored.without(j);
    const SetTest wrong = test_set(array, gravity, limits, evidence, rest);
    if (!wrong.tested) continue;
    const LeastSquares map = least_squares(array, rest);
    const double margin = 2.0 * wrong.norm_reject_limit(limits) * wrong.norm_sigma_mps2 / std::sqrt(evidence.samples);
    for (int i = 0; i < array.size(); ++i) {
      if (!suspected.has(i) || i == j) continue;
      const auto a = static_cast<size_t>(i);
      const LeastSquares others = least_squares(array, monitored.without(i));
      if (!others.valid) continue;
      const double fault = evidence.mean_mps2[a] - dot(array.axis(i), others.estimate(evidence.mean_mps2));
      const double reach = std::fabs(fault) * norm(map.column[a]);
      if (!(reach > 0.0)) continue;
      const double change = margin * gravity.g_mps2 / reach;
      if (change <= out.change_mps2) continue;
      out.change_mps2 = change;
      out.along = times(terms.settings.frame, scaled(map.column[a], 1.0 / norm(map.column[a])));
    }
  }
  return out;
}

RotationRequest Diagnosis::rotation_request(const Terms& terms) const noexcept {
  if (terms.machine.mode != Mode::suspect) return {};
  // No turn explains what nothing explains.
  if (episode_.open) return answer_.no_consistent_hypothesis ? RotationRequest{} : resolving_turn(terms);
  return terms.machine.not_yet_validated ? validating_turn(terms) : RotationRequest{};
}

}  // namespace PLUMB_ABI
}  // namespace plumb
