#include "plumb/motion/motion_force.hpp"

#include <cmath>

#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

constexpr double kNoiseTail_sigmas = 6.7;  // chi-square of three beyond its square: 1e-9

}  // namespace

const char* to_string(ForceTerm term) noexcept {
  switch (term) {
    case ForceTerm::noise: return "noise";
    case ForceTerm::lever_arm: return "lever arm";
    case ForceTerm::rotation: return "rotation";
    case ForceTerm::lag: return "lag";
    case ForceTerm::rectification: return "vibration rectification";
    case ForceTerm::scale: return "scale factor";
    case ForceTerm::axis: return "misalignment";
    case ForceTerm::bias: return "bias";
    case ForceTerm::fault: return "undetected fault";
  }
  return "?";
}

const char* to_string(ForceValidity validity) noexcept {
  switch (validity) {
    case ForceValidity::none: return "none";
    case ForceValidity::unchecked: return "unchecked";
    case ForceValidity::bounded: return "bounded";
  }
  return "?";
}

ForceEstimator::ForceEstimator(const SensorArray& array, SensorSet sensors) noexcept : all_(fit_of(array, sensors)) {
  const SensorUnits& units = array.units();
  for (int k = 0; k < units.size(); ++k) {
    const SensorSet rest = sensors - units.sensors_of(SensorSet::of(k));
    if (rest != sensors) without_[static_cast<std::size_t>(k)] = fit_of(array, rest);
  }
}

ForceEstimator::Fit ForceEstimator::fit_of(const SensorArray& array, SensorSet sensors) noexcept {
  Fit out;
  out.map = least_squares(array, sensors);
  for (std::size_t k = 0; k < out.gain.size(); ++k) out.gain[k] = norm(out.map.column[k]);
  const Mat3& covariance = out.map.covariance;
  out.noise_mps2 = kNoiseTail_sigmas * std::sqrt(covariance[0] + covariance[4] + covariance[8]);
  return out;
}

/// What noise and the errors of the healthy sensors of a fit may add to its estimate, on top of how far that is away.
/// Turned axes add by the true force, which is at most the estimate and that error: e <= b + t (|f| + e).
ForceEstimator::Explanation ForceEstimator::explain(const Fit& fit, const MotionSetup& setup,
                                                    const MotionReadings& readings, const SpecificForce& force,
                                                    double noise) noexcept {
  Explanation out{&fit, &readings};
  const Vec3 estimate = fit.map.estimate(readings.corrected_mps2);
  out.force_mps2 = norm(estimate);
  out.away_mps2 = norm(minus(estimate, force.force_mps2));
  double error = fit.noise_mps2 * noise, turn = 0.0;
  for (std::size_t k = 0; k < fit.gain.size(); ++k) {
    if (!fit.map.used.has(static_cast<int>(k))) continue;
    error += fit.gain[k] * readings.error_mps2[k];
    turn += fit.gain[k] * setup.errors[k].axis_rad;
  }
  out.reach_mps2 = turn < 1.0 ? out.away_mps2 + (error + turn * out.force_mps2) / (1.0 - turn)
                              : std::numeric_limits<double>::infinity();
  return out;
}

ForceTerm ForceEstimator::dominant_of(const Explanation& one, const MotionSetup& setup, double noise) noexcept {
  static_assert(kForceTerms == kErrorParts + 2 && static_cast<int>(ForceTerm::lever_arm) == 1);
  std::array<double, kForceTerms> terms{};
  terms[static_cast<std::size_t>(ForceTerm::noise)] = one.fit->noise_mps2 * noise;
  terms[static_cast<std::size_t>(ForceTerm::fault)] = one.away_mps2;
  for (std::size_t k = 0; k < one.fit->gain.size(); ++k) {
    if (!one.fit->map.used.has(static_cast<int>(k))) continue;
    const double gain = one.fit->gain[k];
    for (std::size_t t = 0; t < kErrorParts; ++t) terms[t + 1] += gain * one.readings->part_mps2[k][t];
    terms[static_cast<std::size_t>(ForceTerm::axis)] += gain * setup.errors[k].axis_rad * one.force_mps2;
  }
  std::size_t largest = 0;
  for (std::size_t t = 1; t < terms.size(); ++t) largest = terms[t] > terms[largest] ? t : largest;
  return static_cast<ForceTerm>(largest);
}

/// The bound is the largest reach, over no fault and over one unit at fault that explains what is on record. A unit
/// whose loss leaves no vector is not covered. There is no bound where it takes more than one unit to explain what is
/// on record, and where readings are so large that a sum overflows.
SpecificForce ForceEstimator::estimate(const MotionSetup& setup, const SensorUnits& units, const MotionMeans& means,
                                       const MotionReadings& readings, const ForceEvidence& evidence) const noexcept {
  SpecificForce out;
  out.time_s = means.time_s;
  out.span_s = means.span_s;
  out.used = all_.map.used;
  if (!all_.map.valid) return out;
  const double share = means.noise_share(), noise = std::sqrt(share);
  out.force_mps2 = all_.map.estimate(readings.corrected_mps2);
  for (std::size_t k = 0; k < 9; ++k) out.covariance_m2ps4[k] = share * all_.map.covariance[k];
  out.validity = ForceValidity::bounded;
  out.gyro_assumed = evidence.gyro_assumed;
  // Whether some explanation is among those that the bound covers.
  bool explained = evidence.rejected->explained_by(evidence.isolated) || evidence.without_gyro != nullptr;
  Explanation worst = explain(all_, setup, readings, out, noise);
  bool finite = std::isfinite(worst.reach_mps2);
  const auto consider = [&](const Explanation& one) {
    finite = finite && std::isfinite(one.reach_mps2);
    if (one.reach_mps2 > worst.reach_mps2) worst = one;
  };
  for (int k = 0; k < units.size(); ++k) {
    const SensorSet unit = units.sensors_of(SensorSet::of(k)) & out.used;
    if (unit.empty() || !evidence.rejected->explained_by(unit | evidence.isolated)) continue;
    explained = true;
    const Fit& fit = without_[static_cast<std::size_t>(k)];
    if (fit.map.valid) {
      consider(explain(fit, setup, readings, out, noise));
    } else {
      out.validity = ForceValidity::unchecked;
    }
  }
  if (evidence.without_gyro != nullptr) {
    const bool bounded = evidence.without_gyro->usable.contains(out.used);
    if (bounded) consider(explain(all_, setup, *evidence.without_gyro, out, noise));
    if (!bounded) out.validity = ForceValidity::unchecked;
  }
  out.bound_mps2 = worst.reach_mps2;
  out.dominant = dominant_of(worst, setup, noise);
  if (finite && explained) return out;
  out.validity = ForceValidity::none;
  out.bound_mps2 = std::numeric_limits<double>::infinity();
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
